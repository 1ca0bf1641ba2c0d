// Instructions as text. May assume verified code: blocks nest, jumps go to the ends of blocks.
#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "rsc/dump/parts.hpp"
#include "vm/disassembler.hpp"
#include "vm/opcode.hpp"

namespace robosync::tool {
namespace {

constexpr std::size_t kIndent = 2;
constexpr std::size_t kColumn = 44;  // of the source line

// The nesting depth of an instruction in its response.
class Nesting {
public:
  // Call before the instruction at `at` is printed.
  void arrive(std::size_t at, vm::Flow flow) {
    while (!ends_.empty() && ends_.back() == at)
      ends_.pop_back();
    if (vm::ends_loop(flow) && loops_ > 0) --loops_;
  }
  // Call after it was printed.
  void leave(vm::Flow flow, std::size_t target) {
    if (flow == vm::Flow::if_else && !ends_.empty()) ends_.pop_back();  // the block before ELSE
    if (flow == vm::Flow::if_begin || flow == vm::Flow::if_else) ends_.push_back(target);
    if (vm::begins_loop(flow)) ++loops_;
  }
  std::size_t depth() const { return ends_.size() + loops_; }

private:
  std::vector<std::size_t> ends_;  // of IF blocks, outermost first
  std::size_t loops_ = 0;
};

// The target of the instruction at `at`, if it is a jump.
std::optional<std::size_t> target_of(std::size_t at, vm::Word word) {
  const auto& operands = vm::info_of(vm::opcode_of(word)).operands;
  if (operands[1] == vm::Operand::ahead) return at + 1 + vm::operand_wide(word);
  if (operands[1] == vm::Operand::back) return at + 1 - vm::operand_wide(word);
  if (operands[2] == vm::Operand::ahead8) return at + 1 + vm::operand_c(word);
  return std::nullopt;
}

// Prints the number of a source line next to an instruction, or its text above.
class Lines {
public:
  Lines(const vm::Image& image, const SourceLines& source) : image_(image), source_(source) {}

  // Before the instruction at `at` is printed: is it the first of a new source line?
  bool arrive(std::size_t at) {
    const std::uint16_t before = line_;
    while (next_ < image_.source_lines.size() && image_.source_lines[next_].word <= at)
      line_ = image_.source_lines[next_++].line;
    return line_ != before;
  }
  std::string above() const {
    if (line_ == 0 || line_ > source_.size()) return {};
    const std::string& text = source_[line_ - 1U];
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    return fmt::format("  line {}: {}\n", line_, text.substr(begin));
  }
  std::string beside() const {
    return line_ == 0 || !source_.empty() ? std::string() : fmt::format("  line {}", line_);
  }

private:
  const vm::Image& image_;
  const SourceLines& source_;
  std::size_t next_ = 0;
  std::uint16_t line_ = 0;
};

}  // namespace

std::string dump_code(const vm::Image& image, const SourceLines& source, std::size_t start,
                      std::size_t length) {
  std::string text;
  Lines lines(image, source);
  Nesting nesting;
  for (std::size_t at = start; at < start + length; ++at) {
    if (lines.arrive(at)) text += lines.above();
    std::array<char, 120> buffer{};
    const std::size_t count = vm::disassemble(image, image.code[at], buffer);
    const vm::Flow flow = vm::info_of(vm::opcode_of(image.code[at])).flow;
    const std::optional<std::size_t> target = target_of(at, image.code[at]);
    nesting.arrive(at, flow);
    const std::string shown = fmt::format("{:{}}{}{}", "", nesting.depth() * kIndent,
                                          std::string_view(buffer.data(), count),
                                          target ? fmt::format("  -> {}", *target) : "");
    const std::string beside = lines.beside();
    text += fmt::format("    {:>4}  {:08x}  {:<{}}{}\n", at, image.code[at], shown,
                        beside.empty() ? 0 : kColumn, beside);
    nesting.leave(flow, target.value_or(0));
  }
  return text;
}

}  // namespace robosync::tool
