// Two programs for uploads, compiled from source: they differ in their threshold.
#pragma once

#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "compiler/diagnostics/render.hpp"
#include "link/messages.hpp"
#include "rsc/program.hpp"

namespace robosync::test {

inline constexpr const char* kConfiguration = R"({
  "sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
  "actuators": [
    {"name": "left_arm", "type": "PWM", "pin": 10, "device": "servo", "range": ["0deg", "120deg"],
     "speeds": {"SLOWLY": "30deg/s", "QUICKLY": "180deg/s"}},
    {"name": "right_arm", "type": "PWM", "pin": 11, "device": "servo", "range": ["0deg", "120deg"],
     "speeds": {"SLOWLY": "30deg/s", "QUICKLY": "180deg/s"}}
  ]
})";

inline std::string program_text(int threshold) {
  return "BEHAVIOR react PRIORITY 50\n"
         "WHEN touch LEVEL < " +
         std::to_string(threshold) +
         " DO\n"
         "  MOVE left_arm SLOWLY TO 90deg\n"
         "ELSE\n"
         "  MOVE right_arm QUICKLY TO 30deg\n"
         "END\n"
         "END\n";
}

inline tool::Program compile(const std::string& text) {
  compiler::Result result = compiler::compile({"robot.rsl", text}, {"robot.json", kConfiguration});
  INFO(compiler::render_human(result.diagnostics, result.sources, false));
  REQUIRE(!result.image.empty());
  return {std::move(result.image), "robot.rsl"};
}

inline tool::Program program(int threshold) {
  return compile(program_text(threshold));
}

inline link::ProgramHash name_of(const tool::Program& program) {
  return program.image().header->program_hash;
}

// One that needs many data frames.
inline std::string long_program_text() {
  std::string text = "BEHAVIOR count PRIORITY 40\n";
  for (int i = 0; i < 30; ++i) {
    text += "WHEN touch LEVEL = " + std::to_string(i % 10) + "." + std::to_string(i) +
            " DO\n  MOVE left_arm QUICKLY TO " + std::to_string(i) + "deg\nEND\n";
  }
  return text + "END\n";
}

inline tool::Program long_program() {
  return compile(long_program_text());
}

}  // namespace robosync::test
