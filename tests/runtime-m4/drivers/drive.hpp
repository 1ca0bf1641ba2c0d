// An actuator's driver with the guard and a board that records, without a kernel: for the tests of drivers.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <utility>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/rig.hpp"

namespace robosync::test {

using Params = std::initializer_list<std::pair<vm::Param, vm::Value>>;

inline drivers::Order order(vm::Action action, Params params = {}) {
  drivers::Order result;
  result.action = action;
  for (const auto& [param, value] : params) {
    result.given = static_cast<std::uint8_t>(result.given | 1U << static_cast<unsigned>(param));
    result.params[static_cast<std::size_t>(param)] = value;
  }
  return result;
}

// Time advances to the driver's next call.
struct Drive {
  explicit Drive(vm::DriverId id, vm::Value min, vm::Value max,
                 vm::Value speed_limit = vm::kValueMax)
      : driver(drivers::driver(id)) {
    wiring.driver = id;
    wiring.pin = 7;
    wiring.bus = 8;  // the second pin, for actuators with two
    wiring.min = min;
    wiring.max = max;
    wiring.speed_limit = speed_limit;
    vm::Image image;
    image.actuators = std::span(&wiring, 1);
    outputs.own(image);
  }

  drivers::Device device() { return {outputs, wiring, state}; }
  void begin(const drivers::Order& what) { wake = driver.start(device(), what, now); }
  // Until the command is done, or `until`.
  void run(kernel::Time until = kernel::kForever) {
    while (wake != drivers::kDone && wake <= until) {
      REQUIRE(wake > now);  // otherwise it would never end
      now = wake;
      wake = driver.advance(device(), now);
    }
  }
  std::uint32_t pulse() const { return board.pwm_read(7); }
  // For actuators with two pins: negative on the second one.
  int power() const { return static_cast<int>(pulse()) - static_cast<int>(board.pwm_read(8)); }
  std::size_t setpoints() const {
    const auto found = board.pulses.find(7);
    return found == board.pulses.end() ? 0 : found->second.size();
  }

  const drivers::Driver& driver;
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs{kernel, board};
  vm::Actuator wiring{};
  drivers::ActuatorState state;
  kernel::Time now = 1'000'000;
  kernel::Time wake = 0;
};

}  // namespace robosync::test
