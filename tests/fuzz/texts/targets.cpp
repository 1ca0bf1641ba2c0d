// See targets.hpp.
#include "tests/fuzz/texts/targets.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <unistd.h>

#include "compiler/compiler.hpp"
#include "compiler/syntax/format.hpp"
#include "compiler/syntax/parser.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/failure.hpp"
#include "rsc/lsp/framing.hpp"
#include "rsc/lsp/server.hpp"
#include "rsc/program.hpp"
#include "rsc/trace/scenario.hpp"
#include "tests/fuzz/texts/require.hpp"
#include "tests/support/without_lines.hpp"
#include "vm/verifier.hpp"

namespace robosync::fuzz {
namespace {

// A robot with something of each kind, and a program that uses it.
constexpr std::string_view kRobot = R"({
  "sensors": [{"name": "touch", "type": "I2C", "address": "0x48", "device": "max34451"},
              {"name": "near", "type": "VIRTUAL",
               "channels": {"DISTANCE": {"unit": "cm", "range": ["0cm", "400cm"]}, "LIGHT": {"range": [0, 100]}}},
              {"name": "button", "type": "GPIO", "pin": 40, "device": "button"}],
  "actuators": [{"name": "left_arm", "type": "PWM", "pin": "0x03", "device": "servo"},
                {"name": "right_arm", "type": "PWM", "pin": "0x04", "device": "servo"},
                {"name": "sound", "type": "UART", "device": "dfplayer", "sounds": ["greeting.wav", "ouch.wav"]}],
  "groups": {"arms": ["left_arm", "right_arm"]}
})";
constexpr std::string_view kProgram =
    "WHEN near DISTANCE < 30cm FOR 1s DO\n  MOVE left_arm TO 40deg\n  PLAY sound "
    "\"greeting.wav\"\nEND\n";

// What the compiler says is whole, and what it makes is what the board accepts.
void check(const compiler::Result& result) {
  for (const compiler::Diagnostic& diagnostic : result.diagnostics.all())
    require(!diagnostic.message.empty(), "a message says nothing");
  if (result.image.empty()) return;
  vm::Image image;
  require(vm::verify(result.image, vm::Limits{}, image).ok(),
          "the verifier refuses what was compiled");
}

compiler::Result compile(std::string_view program, std::string_view robot) {
  const compiler::Options options{.source_lines = false, .algorithms = tool::algorithm_modules()};
  return compiler::compile({"fuzz.rsl", std::string(program)}, {"robot.json", std::string(robot)},
                           options);
}

// Where nobody else writes, for what is read from a file.
std::string scratch_file() {
  return (std::filesystem::temp_directory_path() /
          ("robosync-fuzz-" + std::to_string(getpid()) + ".json"))
      .string();
}

// The program's text, formatted.
std::optional<std::string> formatted(const compiler::Result& result) {
  compiler::Diagnostics ignored;
  const compiler::ast::Tree tree = compiler::parse(result.sources, compiler::kProgramFile, ignored);
  return compiler::formatted(result.sources, compiler::kProgramFile, tree);
}

}  // namespace

// What is formatted means the same, and is not changed when it is formatted again.
void rsl(std::string_view input) {
  const compiler::Result result = compile(input, kRobot);
  check(result);
  if (result.diagnostics.errors() != 0) return;
  const std::optional<std::string> text = formatted(result);
  if (!text) return;
  const compiler::Result again = compile(*text, kRobot);
  require(test::without_lines(again.image) == test::without_lines(result.image),
          "what is formatted is another program");
  require(formatted(again) == text, "formatted twice is something else");
}

void robot(std::string_view input) {
  check(compile(kProgram, input));
}

void scenario(std::string_view input) {
  static const tool::Program program(compile(kProgram, kRobot).image, "fuzz.rsl");
  const std::string file = scratch_file();
  std::ofstream(file, std::ios::binary) << input;
  try {
    std::uint64_t before = 0;
    for (const tool::Stimulus& stimulus : tool::read_scenario(file, program).stimuli) {
      require(stimulus.channel < program.image().channels.size(), "a reading of no channel");
      require(stimulus.at_us >= before, "readings out of order");
      before = stimulus.at_us;
    }
  } catch (const tool::Failure& failure) {
    require(*failure.what() != '\0', "a failure says nothing");
  }
  std::filesystem::remove(file);
}

void lsp(std::string_view input) {
  std::size_t sent = 0;
  tool::lsp::Server server([&](const std::string& message) { sent += message.size(); });
  tool::lsp::FrameReader reader;
  reader.feed(input);
  for (tool::lsp::Frame frame = reader.next(); frame.what == tool::lsp::Frame::What::message;
       frame = reader.next())
    server.receive(frame.body);
  while (!server.exit_code() && server.step())
    continue;
  if (server.is_dirty()) server.idle();
}

}  // namespace robosync::fuzz
