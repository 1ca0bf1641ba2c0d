// Devices that do not answer: when and how often that is reported, and what the runtime says about them.
#include "runtime-m4/layers/contact.hpp"

#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using layers::Contact;
using News = Contact::News;
using test::Rig;

namespace {

constexpr unsigned kRoundMs = 20;

struct Measured {
  Measured() {
    rig.board.answers.assign(10'000, std::byte{0});
    REQUIRE(rig.activate(test::compile("WHEN touch LEVEL > 1 OR near X > 1\nDO MOVE a\nEND\n", R"({
      "sensors": [
        {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
        {"name": "touch", "type": "I2C", "address": "0x70", "device": "max34451",
         "channels": {"LEVEL": {"range": [0, 10], "rate": "50Hz", "stale_after": "100ms"}}}],
      "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]})"))
                .ok());
  }
  void rounds(unsigned count) { rig.run(now_ms_ += kRoundMs * count); }
  link::Devices devices() const {
    link::Devices said{};
    rig.runtime.fill_devices(said);
    return said;
  }
  std::size_t told(std::string_view events) const {
    std::size_t found = 0;
    for (const std::string& line : rig.lines)
      found += test::select({line}, events).empty() ? 0U : 1U;
    return found;
  }

  unsigned touch() const { return rig.runtime.image().sensors[0].period_ms == 0 ? 1 : 0; }

  Rig rig;

private:
  std::uint64_t now_ms_ = kRoundMs / 2;
};

}  // namespace

TEST_CASE(
    "a device that never answered is silent at once; one that did, with the third round in a row") {
  Contact absent;
  CHECK_FALSE(absent.asked());
  CHECK(absent.note(2) == News::silent);
  CHECK((absent.asked() && absent.silent() && absent.failed() == 2));
  CHECK(absent.note(2) == News::none);

  Contact there;
  CHECK(there.note(0) == News::none);
  for (int i = 0; i < 10; ++i) {  // single failures do not make it silent
    CHECK(there.note(1) == News::none);
    CHECK(there.note(1) == News::none);
    CHECK(there.note(0) == News::none);
  }
  CHECK(there.failed() == 20);
  CHECK(there.note(1) == News::none);
  CHECK(there.note(1) == News::none);
  CHECK(there.note(1) == News::silent);
  for (int i = 0; i < 10; ++i) {  // single answers do not count as answering again
    CHECK(there.note(0) == News::none);
    CHECK(there.note(0) == News::none);
    CHECK(there.note(1) == News::none);
  }
  CHECK(there.note(0) == News::none);
  CHECK(there.note(0) == News::none);
  CHECK(there.note(0) == News::answers);
  CHECK_FALSE(there.silent());
}

TEST_CASE("failed transfers are counted up to what the count holds") {
  Contact contact;
  for (int i = 0; i < 5000; ++i)
    (void)contact.note(16);
  CHECK(contact.failed() == UINT16_MAX);
}

TEST_CASE("a device that falls silent and comes back is told of once each") {
  Measured robot;
  robot.rounds(5);
  const unsigned touch = robot.touch();
  CHECK(robot.devices().asked == 1U << touch);  // the other one is fed
  CHECK(robot.devices().silent == 0);
  CHECK(robot.told("silent answers") == 0);

  robot.rig.board.acknowledges = false;
  robot.rounds(50);
  CHECK(robot.told("silent") == 1);
  CHECK(robot.told("stale") == 1);
  CHECK(robot.devices().silent == 1U << touch);
  CHECK(robot.devices().failed.at(touch) == 50);

  robot.rig.board.acknowledges = true;
  robot.rounds(50);
  CHECK(robot.told("silent") == 1);
  CHECK(robot.told("answers") == 1);
  CHECK(robot.devices().silent == 0);
  CHECK(robot.devices().failed.at(touch) == 50);
}

TEST_CASE("what is known of devices belongs to the program that runs; the buses are the board's") {
  Measured robot;
  robot.rig.board.acknowledges = false;
  robot.rig.board.bus_state = {.clears = 7, .held = 1};
  robot.rounds(3);
  CHECK(robot.told("silent") == 1);  // in the first round
  CHECK(robot.devices().silent != 0);
  CHECK((robot.devices().bus_clears == 7 && robot.devices().held == 1));
  robot.rig.runtime.clear();
  CHECK((robot.devices().asked == 0 && robot.devices().silent == 0));
  CHECK(robot.devices().bus_clears == 7);
}
