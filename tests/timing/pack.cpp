// Compiles programs into a block for the board (firmware/block.hpp), and prints what
// `rsc check --timing --format json` says of each: one JSON array on stdout. A program with errors
// is not in the block, and only its errors are printed.
//
// usage: timing_pack BLOCK STEPS [--config FILE] PROGRAM[:SCENARIO]…
#include <algorithm>
#include <charconv>
#include <iostream>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "rsc/failure.hpp"
#include "rsc/output.hpp"
#include "rsc/program.hpp"
#include "rsc/timing.hpp"
#include "tests/timing/script.hpp"
#include "vm/opcode.hpp"

namespace robosync::timing {
namespace {

struct Arguments {
  std::string block, config;
  std::uint32_t steps = 0;
  std::vector<std::string> programs;
};

Arguments read(std::span<const char* const> words) {
  Arguments arguments;
  if (words.size() < 3) throw tool::Failure(tool::Exit::usage, "usage: see pack.cpp");
  arguments.block = words[0];
  const std::string_view steps = words[1];
  std::from_chars(steps.data(), steps.data() + steps.size(), arguments.steps);
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (std::string_view(words[i]) == "--config" && i + 1 < words.size())
      arguments.config = words[++i];
    else
      arguments.programs.emplace_back(words[i]);
  }
  return arguments;
}

// The codes of what is wrong with a program.
nlohmann::ordered_json errors_of(const compiler::Diagnostics& diagnostics) {
  auto codes = nlohmann::ordered_json::array();
  for (const compiler::Diagnostic& diagnostic : diagnostics.all())
    if (diagnostic.level == compiler::Level::error)
      codes.push_back(compiler::code_name(diagnostic.code));
  return codes;
}

class Block {
public:
  void add(std::uint32_t word) { add(std::as_bytes(std::span(&word, 1))); }
  void add(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

private:
  std::vector<std::byte> bytes_;
};

// The names of the opcodes in the program's code.
nlohmann::ordered_json opcodes_of(const vm::Image& image) {
  std::set<std::string_view> names;
  for (const vm::Word word : image.code)
    names.insert(vm::kOpcodes[static_cast<std::size_t>(vm::opcode_of(word))].name);
  return names;
}

// Puts the program into the block, and gives its timing.
nlohmann::ordered_json add(Block& block, const tool::Program& program, const std::string& file,
                           const std::string& scenario) {
  std::vector<std::uint32_t> script;
  if (!scenario.empty()) script = script_of(program, scenario);
  block.add(static_cast<std::uint32_t>(program.bytes().size()));
  block.add(program.bytes());
  block.add(static_cast<std::uint32_t>(script.size()));
  block.add(std::as_bytes(std::span(script)));
  auto timing = tool::timing_json(tool::timing_of(program.image()), file);
  timing["opcodes"] = opcodes_of(program.image());
  return timing;
}

void pack(const Arguments& arguments) {
  auto report = nlohmann::ordered_json::array();
  Block block;
  block.add(arguments.steps);
  for (const std::string& argument : arguments.programs) {
    const std::size_t colon = std::min(argument.find(':'), argument.size());
    const std::string file = argument.substr(0, colon);
    compiler::Result result = tool::compile_file(file, {.config = arguments.config, .lints = {}});
    if (result.diagnostics.errors() > 0) {
      report.push_back({{"file", file}, {"errors", errors_of(result.diagnostics)}});
      continue;
    }
    tool::Origin origin = tool::origin_of(result);
    const tool::Program program(std::move(result.image), file, tool::board_memory(),
                                std::move(origin));
    report.push_back(
        add(block, program, file, argument.substr(std::min(colon + 1, argument.size()))));
  }
  block.add(0);
  tool::write_output(arguments.block, block.bytes());
  std::cout << report.dump() << '\n';
}

}  // namespace
}  // namespace robosync::timing

int main(int count, const char* const* words) {
  try {
    robosync::timing::pack(
        robosync::timing::read(std::span(words, static_cast<std::size_t>(count)).subspan(1)));
    return 0;
  } catch (const robosync::tool::Failure& failure) {
    std::cerr << "timing_pack: " << failure.what() << '\n';
    return static_cast<int>(failure.exit());
  }
}
