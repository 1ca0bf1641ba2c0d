// The verifier's checks of what few images have: the traits, and the pictures of robot.json.
#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"
#include "vm/drivers.hpp"
#include "vm/pictures.hpp"
#include "vm/verifier.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
namespace robot = robosync::vm::test::companion;

namespace {

// A function that checks that a robot with some traits is refused, and where.
template <class RobotWith>
auto refused_of(RobotWith robot_with) {
  return [robot_with](std::vector<Trait> traits, Refusal why, std::uint16_t place) {
    check_refused([&](auto& image) { image = robot_with(traits); }, {why, Section::traits, place});
  };
}

}  // namespace

TEST_CASE("words: an item below 0 is a picture, and has no more lights than there are") {
  constexpr std::size_t kItem = 2;
  const auto with = [](Value item) {
    return [item](auto& image) { image.words[kItem].value = item; };
  };
  ImageBuilder all = robot::make();
  REQUIRE(all.words[kItem].param == Param::item);
  with(item_of_picture(kAllLights))(all);
  check_accepted(all);
  check_refused(with(item_of_picture(kAllLights) - 1), {Refusal::bad_value, Section::words, kItem});
}

TEST_CASE("traits: the robot's name first, which is none or one") {
  const auto with = [](std::vector<Trait> traits) {
    return [traits](auto& image) { image.traits = traits; };
  };
  const auto called = [](std::size_t length) {
    ImageBuilder image = robot::make();
    image.traits = {{image.name(std::string(length, 'x')), 0, TraitKind::name}};
    return image;
  };
  check_accepted(called(1));
  check_accepted(called(kMaxRobotName));
  check_refused([&](auto& image) { image = called(kMaxRobotName + 1); },
                {Refusal::bad_value, Section::traits, 0});
  check_refused(with({{0, 0, TraitKind::name}, {0, 0, TraitKind::name}}),
                {Refusal::bad_value, Section::traits, 1});
  check_refused(with({{0, 1, TraitKind::name}}), {Refusal::bad_value, Section::traits, 0});
  check_refused(with({{0x7FFF, 0, TraitKind::name}}), {Refusal::bad_string, Section::traits, 0});
  check_refused(with({{1, 0, TraitKind::count_}}), {Refusal::bad_value, Section::traits, 0});
}

TEST_CASE("traits: the accelerations of actuators that move at a speed, in their order") {
  const auto robot_with = [](std::vector<Trait> traits) {
    ImageBuilder image = robot::make();
    image.actuators[0].driver = DriverId::servo;
    image.actuators[1].driver = DriverId::virtual_motion;
    image.actuators[1].pin = 90;
    image.traits = std::move(traits);
    return image;
  };
  const auto limit = [](std::uint8_t actuator, std::uint16_t value = 400) {
    return Trait{value, actuator, TraitKind::acceleration};
  };
  const auto refused = refused_of(robot_with);
  check_accepted(robot_with({limit(0)}));
  check_accepted(robot_with({{0, 0, TraitKind::name}, limit(0, 1), limit(1, UINT16_MAX)}));
  refused({limit(0), {0, 0, TraitKind::name}}, Refusal::bad_value, 1);
  refused({limit(0), limit(0)}, Refusal::bad_value, 1);
  refused({limit(1), limit(0)}, Refusal::bad_value, 1);
  refused({limit(0, 0)}, Refusal::bad_value, 0);
  refused({limit(2)}, Refusal::bad_value, 0);  // it has no speed
  refused({limit(31)}, Refusal::bad_index, 0);
  const auto slow = [&](auto& image) {
    image = robot_with({limit(0), limit(1)});
    image.actuators[1].pin = 0;  // a command takes as long as it says
  };
  check_refused(slow, {Refusal::bad_value, Section::traits, 1});
}

TEST_CASE("traits: the pulses of servos, in the order of their kinds, within those of any servo") {
  const auto robot_with = [](std::vector<Trait> traits) {
    ImageBuilder image = robot::make();
    image.actuators[0].driver = DriverId::servo;
    image.actuators[1].driver = DriverId::servo;
    image.actuators[1].pin = 9;
    image.traits = std::move(traits);
    return image;
  };
  const auto at_min = [](std::uint8_t actuator, std::uint16_t pulse = 600) {
    return Trait{pulse, actuator, TraitKind::pulse_at_min};
  };
  const auto at_max = [](std::uint8_t actuator, std::uint16_t pulse = 2400) {
    return Trait{pulse, actuator, TraitKind::pulse_at_max};
  };
  const auto refused = refused_of(robot_with);
  check_accepted(robot_with({{400, 0, TraitKind::acceleration}, at_min(0), at_min(1), at_max(0)}));
  check_accepted(robot_with({at_min(0, 2500), at_max(0, 500)}));  // the other way round
  refused({at_max(0), at_min(1)}, Refusal::bad_value, 1);
  refused({at_min(1), at_min(0)}, Refusal::bad_value, 1);
  refused({at_min(0), at_min(0)}, Refusal::bad_value, 1);
  refused({at_min(0), {400, 1, TraitKind::acceleration}}, Refusal::bad_value, 1);
  refused({at_min(0, 499)}, Refusal::bad_value, 0);
  refused({at_max(0, 2501)}, Refusal::bad_value, 0);
  refused({at_min(2)}, Refusal::bad_value, 0);  // no servo
  refused({at_min(31)}, Refusal::bad_index, 0);
}
