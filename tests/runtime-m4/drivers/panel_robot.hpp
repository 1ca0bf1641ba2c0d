// A robot with a panel or a strip of lights: what the board is told to show.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/policy/panel.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

namespace robosync::test {

// Within this time, in milliseconds, the safety monitor tells a panel what it shall show.
inline constexpr unsigned kPanelTold = policy::kPanelGapMs + policy::kSafetyPeriodMs;

struct PanelRobot {
  // Its sensor `near` triggers `body`; above 90 a SAFETY rule stops it (stops_when_far()).
  PanelRobot(const std::string& body, const std::string& robot) {
    REQUIRE(rig.activate(compile(stops_when_far(body), robot)).ok());
    rig.feed(0, 6);
    rig.run(at);
    rig.feed(0, 20);
    pass(policy::kLeastPauseMs + kPanelTold);  // `body` may have a THEN
  }
  void pass(unsigned milliseconds) { rig.run(at += milliseconds); }
  const std::vector<std::uint32_t>& told() const { return rig.board.noting_panel.pictures; }
  std::uint32_t now() const { return told().back(); }

  Rig rig;
  unsigned at = 20;
};

}  // namespace robosync::test
