// Instructions as text. May assume verified code: blocks nest, jumps go to the ends of blocks.
#include <vector>

#include <fmt/format.h>

#include "rsc/dump_parts.hpp"
#include "vm/disassembler.hpp"
#include "vm/opcode.hpp"

namespace robosync::tool {
namespace {

constexpr std::size_t kIndent = 2;
constexpr std::size_t kColumn = 44;  // where the source line stands
constexpr unsigned kWideShift = 16;  // operands B and C together

// How deep an instruction stands in the blocks of its response.
class Nesting {
public:
  // Before the instruction at `at` is printed.
  void arrive(std::size_t at, vm::Opcode op) {
    while (!ends_.empty() && ends_.back() == at)
      ends_.pop_back();
    if (closes(op) && loops_ > 0) --loops_;
  }
  // After it was printed.
  void leave(vm::Opcode op, std::size_t target) {
    if (op == vm::Opcode::unless || op == vm::Opcode::unless_known) ends_.push_back(target);
    if (op == vm::Opcode::jump) {
      if (!ends_.empty()) ends_.pop_back();  // it is the last word of the block before ELSE
      ends_.push_back(target);
    }
    if (opens(op)) ++loops_;
  }
  std::size_t depth() const { return ends_.size() + loops_; }

private:
  static bool opens(vm::Opcode op) {
    return op == vm::Opcode::times || op == vm::Opcode::times_v || op == vm::Opcode::loop ||
           op == vm::Opcode::poll;
  }
  static bool closes(vm::Opcode op) {
    return op == vm::Opcode::again || op == vm::Opcode::around || op == vm::Opcode::around_always ||
           op == vm::Opcode::until;
  }

  std::vector<std::size_t> ends_;  // of IF blocks, outermost first
  std::size_t loops_ = 0;
};

enum class Jump : std::uint8_t { none, ahead, back };

Jump jump_of(vm::Opcode op) {
  switch (op) {
    case vm::Opcode::jump:
    case vm::Opcode::unless:
    case vm::Opcode::unless_known:
      return Jump::ahead;
    case vm::Opcode::again:
    case vm::Opcode::around:
    case vm::Opcode::around_always:
    case vm::Opcode::until:
      return Jump::back;
    default:
      return Jump::none;
  }
}

std::size_t target_of(std::size_t at, vm::Word word, Jump jump) {
  const std::size_t distance = word >> kWideShift;
  return jump == Jump::ahead ? at + 1 + distance : at + 1 - distance;
}

}  // namespace

std::string dump_code(const vm::Image& image, std::size_t start, std::size_t length) {
  std::string text;
  std::size_t next = 0;
  std::uint16_t line = 0;
  Nesting nesting;
  for (std::size_t at = start; at < start + length; ++at) {
    while (next < image.source_lines.size() && image.source_lines[next].word <= at)
      line = image.source_lines[next++].line;
    std::array<char, 120> buffer{};
    const std::size_t count = vm::disassemble(image, image.code[at], buffer);
    const auto op = static_cast<vm::Opcode>(image.code[at] & 0xFF);
    const Jump jump = jump_of(op);
    const std::size_t target = target_of(at, image.code[at], jump);
    nesting.arrive(at, op);
    const std::string shown = fmt::format("{:{}}{}{}", "", nesting.depth() * kIndent,
                                          std::string_view(buffer.data(), count),
                                          jump == Jump::none ? "" : fmt::format("  -> {}", target));
    text += fmt::format("    {:>4}  {:08x}  {:<{}}{}\n", at, image.code[at], shown, kColumn,
                        line == 0 ? "" : fmt::format("  line {}", line));
    nesting.leave(op, target);
  }
  return text;
}

}  // namespace robosync::tool
