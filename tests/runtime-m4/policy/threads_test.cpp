// The threads of a program, and the behaviours that need each of them.
#include "runtime-m4/policy/threads.hpp"

#include <array>

#include <catch2/catch.hpp>

using namespace robosync;

namespace {

struct Robot {
  Robot() {
    sensors[0].driver = vm::DriverId::i2c_register;
    sensors[0].period_ms = 20;
    sensors[1].driver = vm::DriverId::virtual_sensor;
    sensors[1].period_ms = 20;
    sensors[2].driver = vm::DriverId::max34451;
    sensors[2].period_ms = 0;
    behaviors[0].priority = vm::kSafetyPriority;
    behaviors[0].actuators = 0b11;
    behaviors[1].priority = 40;
    behaviors[1].actuators = 0b01;
    behaviors[2].priority = -7;
    image.sensors = sensors;
    image.behaviors = behaviors;
  }
  std::array<vm::Sensor, 3> sensors{};
  std::array<vm::Behavior, 3> behaviors{};
  vm::Image image;
};

}  // namespace

TEST_CASE("fed: a virtual sensor, and one without a period; all of them have one thread") {
  Robot robot;
  CHECK_FALSE(policy::is_fed(robot.sensors[0]));
  CHECK(policy::is_fed(robot.sensors[1]));
  CHECK(policy::is_fed(robot.sensors[2]));
  CHECK(policy::has_fed_sensors(robot.image));
  CHECK(policy::thread_of(robot.image, 0) == 0);
  CHECK(policy::thread_of(robot.image, 1) == policy::kFedSensors);
  CHECK(policy::thread_of(robot.image, 2) == policy::kFedSensors);
  robot.image.sensors = std::span(robot.sensors).first(1);
  CHECK_FALSE(policy::has_fed_sensors(robot.image));
}

TEST_CASE("below all behaviours is what nobody needs") {
  Robot robot;
  CHECK(policy::idle_priority(robot.image) == -8);
  CHECK(policy::idle_priority(vm::Image{}) == 0);
  CHECK(policy::first_behavior(robot.image) == 1);
  robot.image.behaviors = std::span(robot.behaviors).subspan(1);
  CHECK(policy::first_behavior(robot.image) == 0);
}

TEST_CASE("who needs a thread") {
  const Robot robot;
  const auto needs = [&](unsigned behavior, policy::Category category, unsigned index,
                         bool reads = false) {
    return policy::needs(robot.image, behavior, category, index, reads);
  };
  using policy::Category;
  CHECK(needs(0, Category::sensor, 0, true));  // SAFETY's inputs are sampled at its priority
  CHECK_FALSE(needs(1, Category::sensor, 0, false));
  CHECK(needs(2, Category::behavior, 2));
  CHECK_FALSE(needs(1, Category::behavior, 2));
  CHECK_FALSE(needs(0, Category::control, 0));  // the monitor halts it without its thread
  CHECK(needs(1, Category::control, 0));
  CHECK_FALSE(needs(1, Category::control, 1));
  for (unsigned behavior = 0; behavior < 3; ++behavior)
    CHECK(needs(behavior, Category::processing, 0));
  CHECK_FALSE(needs(1, Category::system, 1, true));
}
