// Algorithms in a robot: when they run, what happens to their outputs, and to algorithms that depend on them.
#include "runtime-m4/layers/algorithms.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/algorithms/other_module.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Robot;

namespace {

std::string pad_robot(const std::string& pad, const std::string& more = "") {
  return R"({"sensors": [)" + pad + R"(],
    "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}],
    "algorithms": [{"name": "skin", "module": "touch_levels", "input": "pad")" +
         more + "}]}";
}
const std::string kFedPad =
    R"({"name": "pad", "type": "VIRTUAL", "channels": {"FORCE": {"range": [0, 20]}}})";
const std::string kSampledPad =
    R"({"name": "pad", "type": "I2C", "address": "0x70", "device": "max34451",
        "channels": {"FORCE": {"range": [0, 20], "rate": "50Hz", "stale_after": "100ms"}}})";
const char* const kWhenFirm = "WHEN skin LEVEL IS firm\nDO MOVE a\nEND\n";

}  // namespace

TEST_CASE("where the input is fed, an algorithm runs at its own rate on what was fed last") {
  Robot robot(kWhenFirm, pad_robot(kFedPad, R"(, "rate": "25Hz")"));
  robot.feed(0, "FORCE", 0);
  robot.feed(90, "FORCE", 6);   // seen at 120
  robot.feed(125, "FORCE", 0);  // … and forgotten at 160
  robot.feed(165, "FORCE", 9);
  robot.feed(190, "FORCE", 0);  // the 9 was never seen
  robot.run(1000);
  CHECK(robot.only("input fire") ==
        "0 #1 input FORCE 0\n"
        "0 #2 input LEVEL 0\n"
        "90 #3 input FORCE 6\n"
        "120 #4 input LEVEL 2\n"
        "120 #4 fire r0 DO\n"
        "125 #5 input FORCE 0\n"
        "160 #6 input LEVEL 0\n"
        "165 #7 input FORCE 9\n"
        "190 #8 input FORCE 0\n");
}

TEST_CASE("where the input is sampled, an algorithm runs with it, and grows stale with it") {
  Robot robot(kWhenFirm, pad_robot(kSampledPad));
  robot.feed(0, "FORCE", 0);
  robot.feed(100, "FORCE", 6);
  robot.feed_raw(300, "FORCE", vm::kUnknown);
  robot.feed(600, "FORCE", 6);
  robot.run(700);
  CHECK(robot.only("input stale") ==
        "0 #1 input FORCE 0\n"
        "0 #2 input LEVEL 0\n"
        "100 #3 input FORCE 6\n"
        "100 #4 input LEVEL 2\n"
        "381 #5 stale FORCE\n"
        "381 #5 stale LEVEL\n"
        "600 #6 input FORCE 6\n"
        "600 #7 input LEVEL 2\n");
}

TEST_CASE("what an algorithm says is as old as the reading that it was made of") {
  Robot robot(kWhenFirm, pad_robot(R"({"name": "pad", "type": "VIRTUAL",
                  "channels": {"FORCE": {"range": [0, 20], "stale_after": "100ms"}}})",
                                   R"(, "rate": "25Hz")"));
  robot.feed(0, "FORCE", 0);
  robot.feed(90, "FORCE", 6);  // seen at 120
  robot.run(400);
  CHECK(robot.only("input stale") ==
        "0 #1 input FORCE 0\n"
        "0 #2 input LEVEL 0\n"
        "90 #3 input FORCE 6\n"
        "101 #4 stale LEVEL\n"  // computed from the 0, at 80 as well
        "120 #5 input LEVEL 2\n"
        "191 #6 stale FORCE\n"
        "191 #6 stale LEVEL\n");
}

TEST_CASE("a module begins anew when its input comes back") {
  Robot robot("WHEN skin TOUCH IS stroke\nDO MOVE a\nEND\n", pad_robot(kSampledPad));
  robot.feed(0, "FORCE", 2);
  robot.feed_raw(500, "FORCE", vm::kUnknown);
  robot.feed(640, "FORCE", 2);  // touched for 500 ms before; 700 make a stroke
  robot.run(1400);
  CHECK(robot.only("fire") == "1340 #6 fire r0 DO\n");
}

TEST_CASE("what nobody reads of an algorithm is not in the image, nor what nobody else needs") {
  const Robot without("WHEN pad FORCE > 1\nDO MOVE a\nEND\n", pad_robot(kFedPad));
  CHECK(without.image().sensors.size() == 1);
  CHECK(without.image().channels.size() == 1);
  const Robot one(kWhenFirm, pad_robot(kFedPad));
  CHECK(one.image().channels.size() == 2);
  CHECK_FALSE(one.has("TOUCH"));
}

TEST_CASE("CHECK and SAFETY read an algorithm like any sensor") {
  Robot robot(
      "SAFETY skin WHEN skin LEVEL IS firm\nDO STOP ALL\nEND\nCHECK touch OF pad FORCE\nlow BELOW "
      "5\nhigh OTHERWISE\nEND\n"
      "WHEN skin TOUCH IS tap FOR 50ms\nDO MOVE a FOR 2s\nEND\n",
      pad_robot(kSampledPad));
  robot.feed(0, "FORCE", 0);
  robot.feed(100, "FORCE", 2);
  robot.feed(200, "FORCE", 0);
  robot.feed(400, "FORCE", 6);
  robot.run(500);
  CHECK(robot.only("trip halt fire command") ==
        "250 #6 fire r1 DO\n"
        "250 #6 command a MOVE for_=2\n"
        "400 #7 trip r0\n"
        "400 #7 halt a\n");
}

TEST_CASE("SAFETY that reads an algorithm begins when that has given its first reading") {
  for (const std::string& pad : {kSampledPad, kFedPad}) {
    Robot known("SAFETY skin WHEN skin LEVEL IS firm\nDO STOP ALL\nEND\nEVERY 1s\nDO MOVE a\nEND\n",
                pad_robot(pad));
    known.feed(0, "FORCE", 0);
    known.run(50);
    CHECK(known.only("trip").empty());
    Robot unknown(
        "SAFETY skin WHEN skin LEVEL IS firm\nDO STOP ALL\nEND\nEVERY 1s\nDO MOVE a\nEND\n",
        pad_robot(pad));
    unknown.run(50);
    CHECK(unknown.only("trip") == "0 #0 trip r0\n");
  }
}

TEST_CASE("an algorithm cannot be fed") {
  Robot robot(kWhenFirm, pad_robot(kFedPad));
  robot.feed(0, "FORCE", 0);
  robot.feed(100, "LEVEL", 2);
  robot.run(300);
  CHECK(robot.only("fire").empty());
}

TEST_CASE("what a module puts out is cut off at the range of its channel") {
  robosync_module wild = *algorithms::find_module(0);
  wild.process = [](void*, void*, const robosync_block* block) {
    block->outputs[0] = block->inputs[0] > 1000 ? INT32_MAX : INT32_MIN + 1;
    return 0u;  // its report of no changes is not trusted either
  };
  const test::OtherModule other(wild);
  Robot robot(kWhenFirm, pad_robot(kFedPad));
  robot.feed(0, "FORCE", 0);
  robot.feed(100, "FORCE", 6);
  robot.run(300);
  CHECK(robot.only("input") ==
        "0 #1 input FORCE 0\n"
        "0 #2 input LEVEL 0\n"
        "100 #3 input FORCE 6\n"
        "100 #4 input LEVEL 2\n");
}

TEST_CASE("a module finds its memory aligned, its scratch behind its state, and its period") {
  static std::uintptr_t state_at, scratch_at;
  static std::uint32_t period;
  robosync_module curious = *algorithms::find_module(0);
  curious.state_bytes = [](const std::int32_t*) { return 13u; };
  curious.scratch_bytes = [](const std::int32_t*) { return 80u; };
  curious.init = [](void* state, const std::int32_t*, std::uint32_t period_ms) {
    period = period_ms;
    state_at = reinterpret_cast<std::uintptr_t>(state);
  };
  curious.process = [](void* state, void* scratch, const robosync_block*) {
    CHECK(state_at == reinterpret_cast<std::uintptr_t>(state));
    scratch_at = reinterpret_cast<std::uintptr_t>(scratch);
    return 0u;
  };
  const test::OtherModule other(curious);
  Robot robot(kWhenFirm, pad_robot(kFedPad, R"(, "rate": "25Hz")"));
  robot.feed(0, "FORCE", 0);
  robot.run(100);
  CHECK(period == 40);
  CHECK(state_at % 8 == 0);
  CHECK(scratch_at == state_at + 16);
  CHECK(robot.only("input") ==
        "0 #1 input FORCE 0\n");  // an output that is left unknown is not a reading
}

TEST_CASE("a module begins before its first sample, and again when program time does") {
  static std::string calls;
  calls.clear();
  robosync_module noted = *algorithms::find_module(0);
  noted.init = [](void*, const std::int32_t*, std::uint32_t) { calls += 'i'; };
  noted.process = [](void*, void*, const robosync_block* block) {
    block->outputs[0] = 0;
    calls += 'p';
    return 1u;
  };
  const test::OtherModule other(noted);
  for (const std::string& pad : {kSampledPad, kFedPad}) {
    // SAFETY makes it run before program time, to get a first reading.
    Robot robot("SAFETY skin WHEN skin LEVEL IS firm\nDO STOP ALL\nEND\nEVERY 1s\nDO MOVE a\nEND\n",
                pad_robot(pad));
    robot.feed(0, "FORCE", 0);
    robot.run(50);
    CHECK(calls.starts_with("ipip"));
    CHECK(std::ranges::count(calls, 'i') == 2);
    calls.clear();
  }
}
