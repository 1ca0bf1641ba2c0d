// What the firmware refuses in an image's algorithms, one error at a time.
#include "runtime-m4/algorithms/judge.hpp"

#include <catch2/catch.hpp>

#include "tests/runtime-m4/algorithms/other_module.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using vm::Refusal;

namespace {

const char* const kSkinRobot = R"({
  "sensors": [{"name": "pad", "type": "VIRTUAL", "channels": {"FORCE": {"range": [0, 20]}}}],
  "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}],
  "algorithms": [{"name": "skin", "module": "touch_levels", "input": "pad"}]})";

// A view of an image that can be modified.
struct Judged {
  Judged() : bytes(test::compile("WHEN skin TOUCH IS tap\nDO MOVE a\nEND\n", kSkinRobot)) {
    REQUIRE(vm::view_image(bytes, image));
  }
  vm::Sensor& skin() { return const_cast<vm::Sensor&>(image.sensors[1]); }
  vm::Value& parameter(std::size_t place) {
    return const_cast<vm::Value&>(image.constants[skin().address + place]);
  }
  template <class Wrong>
  Refusal refusal(Wrong wrong) {
    wrong(*this);
    const vm::Verdict verdict = algorithms::judge(image);
    if (!verdict.ok()) CHECK((verdict.section == vm::Section::sensors && verdict.index == 1));
    return verdict.refusal;
  }

  std::vector<std::byte> bytes;
  vm::Image image;
};

template <class Wrong>
Refusal refusal_of(Wrong wrong) {
  return Judged().refusal(wrong);
}

}  // namespace

TEST_CASE("an algorithm needs a module, inputs, parameters, a period and outputs that fit") {
  CHECK(refusal_of([](auto&) {}) == Refusal::none);
  CHECK(refusal_of([](auto& i) { i.skin().bus = 1 + 200; }) == Refusal::no_module);
  CHECK(refusal_of([](auto& i) { i.skin().first_input = 1; }) == Refusal::wrong_input);  // itself
  CHECK(refusal_of([](auto& i) {
          const_cast<vm::Sensor&>(i.image.sensors[0]).channel_count = 0;
        }) == Refusal::wrong_input);
  CHECK(refusal_of([](auto& i) { i.skin().address = 60'000; }) == Refusal::bad_index);
  CHECK(refusal_of([](auto& i) { ++i.skin().address; }) == Refusal::bad_index);  // the last ones
  CHECK(refusal_of([](auto& i) { i.parameter(0) = 0; }) == Refusal::bad_value);
  CHECK(refusal_of([](auto& i) { i.parameter(0) = 1; }) == Refusal::none);
  CHECK(refusal_of([](auto& i) { i.parameter(5) = 60'000; }) == Refusal::none);
  CHECK(refusal_of([](auto& i) { i.parameter(5) = 60'001; }) == Refusal::bad_value);
  CHECK(refusal_of([](auto& i) { i.skin().period_ms = 2; }) == Refusal::none);
  CHECK(refusal_of([](auto& i) { i.skin().period_ms = 100; }) == Refusal::none);
  CHECK(refusal_of([](auto& i) { i.skin().period_ms = 1; }) == Refusal::bad_value);
  CHECK(refusal_of([](auto& i) { i.skin().period_ms = 101; }) == Refusal::bad_value);
  CHECK(refusal_of([](auto& i) { const_cast<vm::Channel&>(i.image.channels[1]).input = 2; }) ==
        Refusal::bad_value);
}

TEST_CASE("a module that wants more memory than it may have is refused, with these parameters") {
  // Its first two parameters are the memory that it wants.
  robosync_module greedy = *algorithms::find_module(0);
  greedy.state_bytes = [](const std::int32_t* config) { return std::uint32_t(config[0]); };
  greedy.scratch_bytes = [](const std::int32_t* config) { return std::uint32_t(config[1]); };
  const test::OtherModule other(greedy);
  const auto wants = [](std::int32_t state, std::int32_t scratch) {
    return [=](auto& i) {
      i.parameter(0) = state;
      i.parameter(1) = scratch;
    };
  };
  CHECK(refusal_of(wants(ROBOSYNC_MOST_BYTES - 8, 8)) == Refusal::none);
  CHECK(refusal_of(wants(ROBOSYNC_MOST_BYTES - 8, 9)) == Refusal::no_room);
  CHECK(refusal_of(wants(ROBOSYNC_MOST_BYTES - 9, 8)) == Refusal::none);
  CHECK(refusal_of(wants(ROBOSYNC_MOST_BYTES - 7, 1)) == Refusal::no_room);  // a multiple of 8
  CHECK(refusal_of(wants(ROBOSYNC_MOST_BYTES + 1, 1)) == Refusal::no_room);
  CHECK(refusal_of(wants(1'000'000'000, 1)) == Refusal::no_room);
  CHECK(refusal_of(wants(1, 1'000'000'000)) == Refusal::no_room);
  const auto with_room = [&](std::int32_t state, std::uint8_t room) {
    return [=](auto& i) {
      wants(state, 8)(i);
      i.skin().room = room;
    };
  };
  constexpr std::int32_t kFits = ROBOSYNC_MOST_BYTES + 3 * ROBOSYNC_ROOM - 8;
  CHECK(refusal_of(with_room(kFits, 3)) == Refusal::none);
  CHECK(refusal_of(with_room(kFits + 1, 3)) == Refusal::no_room);
  CHECK(refusal_of(with_room(kFits, 2)) == Refusal::no_room);
}

TEST_CASE("what a module was taught must be there, and not be too much") {
  robosync_module learner = *algorithms::find_module(0);
  learner.learns = 1;
  const test::OtherModule other(learner);
  const auto refused = [&](std::size_t after, std::int32_t count) {
    Judged judged;
    std::vector<vm::Value> constants(judged.image.constants.begin(), judged.image.constants.end());
    constants.resize(judged.skin().address + std::size_t{learner.parameters});
    constants.push_back(count);
    constants.resize(constants.size() + after);
    judged.image.constants = constants;
    return judged.refusal([](auto&) {});
  };
  CHECK(refused(0, 0) == Refusal::none);
  CHECK(refused(20, 20) == Refusal::none);
  CHECK(refused(20, 21) == Refusal::bad_index);
  CHECK(refused(20, -1) == Refusal::bad_index);
  CHECK(refused(ROBOSYNC_MOST_CONSTANTS + 1, ROBOSYNC_MOST_CONSTANTS) == Refusal::none);
  CHECK(refused(ROBOSYNC_MOST_CONSTANTS + 1, ROBOSYNC_MOST_CONSTANTS + 1) == Refusal::no_room);
  CHECK(refusal_of([&](auto& i) {
          i.image.constants =
              i.image.constants.first(i.skin().address + std::size_t{learner.parameters});
        }) == Refusal::bad_index);
}

TEST_CASE("every module keeps to the interface's limits") {
  for (std::size_t m = 0; const robosync_module* module = algorithms::find_module(m); ++m) {
    const robosync_description* const names = algorithms::find_description(m);
    REQUIRE(names != nullptr);
    INFO(names->name);
    CHECK(names->module == module);
    CHECK((module->inputs >= 1 && module->inputs <= ROBOSYNC_MOST_INPUTS));
    CHECK((module->outputs >= 1 && module->outputs <= ROBOSYNC_MOST_OUTPUTS));
    CHECK(module->parameters <= ROBOSYNC_MOST_PARAMETERS);
    CHECK((0 < module->shortest_period_ms && module->shortest_period_ms <= names->usual_period_ms &&
           names->usual_period_ms <= module->longest_period_ms));
    std::vector<std::int32_t> usual;
    for (std::size_t p = 0; p < module->parameters; ++p) {
      const robosync_range& range = module->ranges[p];
      CHECK((range.least <= range.usual && range.usual <= range.most));
      usual.push_back(range.usual);
    }
    const std::uint32_t most =
        ROBOSYNC_MOST_BYTES + (module->learns != 0 ? 9U : 0U) * ROBOSYNC_ROOM;
    CHECK(module->state_bytes(usual.data()) + module->scratch_bytes(usual.data()) <= most);
  }
}
