// A small program for tests that need names to refer to: as an image, and in a folder.
#pragma once

#include <string>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "compiler/diagnostics/render.hpp"
#include "rsc/program.hpp"
#include "tests/rsc/process.hpp"

namespace robosync::test {

inline constexpr const char* kRobot = R"({
  "sensors": [
    {"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}},
    {"name": "proximity", "type": "VIRTUAL",
     "channels": {"DISTANCE": {"unit": "cm", "range": [2, 400]}, "NOISE": {"unit": "dB", "range": [0, 100]}}}
  ],
  "actuators": [
    {"name": "left_arm", "type": "PWM", "pin": 10, "device": "servo", "range": ["0deg", "120deg"],
     "speeds": {"SLOWLY": "30deg/s", "QUICKLY": "180deg/s"}}
  ]
})";

inline constexpr const char* kProgram = R"(WHEN touch LEVEL < 3 DO
  MOVE left_arm SLOWLY TO 90deg
END
BEHAVIOR shy PRIORITY 60
WHEN proximity DISTANCE < 20cm AND proximity NOISE > 60dB DO
  MOVE left_arm QUICKLY TO 0deg
END
END
)";

// It lies there as robot.rsl and robot.json.
struct RobotFolder : Folder {
  RobotFolder() {
    write("robot.rsl", kProgram);
    write("robot.json", kRobot);
  }
  std::string program = path("robot.rsl");
};

inline tool::Program compile(const std::string& text = kProgram) {
  compiler::Result result = compiler::compile({"robot.rsl", text}, {"robot.json", kRobot});
  INFO(compiler::render_human(result.diagnostics, result.sources, false));
  REQUIRE(!result.image.empty());
  tool::Origin origin = tool::origin_of(result);
  return {std::move(result.image), "robot.rsl", tool::board_memory(), std::move(origin)};
}

}  // namespace robosync::test
