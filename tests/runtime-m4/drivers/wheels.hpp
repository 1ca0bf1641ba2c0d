// What the tests of drives share: the pulses of their pins, and programs that do something at 20 ms.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

namespace robosync::test {

// Of left forward, left backward, right forward, right backward: the pins 3 to 6.
using Pulses = std::array<std::uint32_t, 4>;
inline constexpr Pulses kOff{};

inline Pulses pulses_of(const NotingBoard& board) {
  return {board.pulse(3), board.pulse(4), board.pulse(5), board.pulse(6)};
}

// Runs a program that does `body` at 20 ms, on a robot of stops_when_far() with a drive.
inline void do_at_20_ms(Rig& rig, const std::string& body, const std::string& robot) {
  REQUIRE(rig.activate(compile(stops_when_far(body), robot)).ok());
  rig.feed(0, 6);
  rig.run(20);
  rig.feed(0, 20, 20);
}

inline Pulses pulses_at(Rig& rig, unsigned milliseconds) {
  rig.run(milliseconds);
  return pulses_of(rig.board);
}

}  // namespace robosync::test
