// Costs on the board, from the lists that declare them: the runtime (costs.def), the board
// (board_costs.def and boards/NAME/costs.def), the drivers (vm/drivers.def). All are executed
// Cortex-M4 instructions, except for microseconds (_us). A cost that is not declared does not compile.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime-m4/policy/threads.hpp"
#include "vm/drive.hpp"
#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

namespace costs {
#define COST(name, instructions, doc) inline constexpr std::uint32_t name = instructions;
#include "runtime-m4/policy/costs.def"
#undef COST
}  // namespace costs

// A number that must be declared: it has no default.
class Declared {
public:
  constexpr Declared(std::uint32_t value) : value_(value) {}  // NOLINT(google-explicit-constructor)
  constexpr operator std::uint32_t() const {
    return value_;
  }  // NOLINT(google-explicit-constructor)

private:
  std::uint32_t value_;
};

struct BoardCosts {
#define BOARD_COST(name, doc) Declared name;
#include "runtime-m4/policy/board_costs.def"
#undef BOARD_COST

  [[nodiscard]] constexpr std::uint32_t instructions_per_ms() const {
    return clock_hz / cycles_per_1000_instructions;
  }
};

// The costs of an actuator driver's calls.
struct ActuatorCosts {
  std::uint32_t start, advance, release;
  bool at_once;  // a command may end as soon as it has begun
};

// The cost of one sample of one channel, of what a microphone hears besides the spectrum; 0 for an actuator's driver.
constexpr std::uint32_t sample_cost(vm::DriverId driver, const BoardCosts& board) {
  const auto fed = [] { return std::uint32_t{0}; };
  const auto computed = [] { return std::uint32_t{0}; };
  const auto i2c = [&](std::uint32_t transfers, std::uint32_t bytes) {
    return transfers * board.i2c_transfer + bytes * board.i2c_byte;
  };
  const auto i2c_once = i2c;
  const auto spi = [&](std::uint32_t bytes) { return board.spi_transfer + bytes * board.spi_byte; };
  const auto pin = [&] { return std::uint32_t{board.input}; };
  const auto echo = [&] { return std::uint32_t{board.echo}; };
  const auto adc = [&] { return std::uint32_t{board.analog}; };
  const auto sound = [&] { return std::uint32_t{board.sound}; };
  const auto part = [&] { return std::uint32_t{board.part}; };
  const auto edges = [&] { return std::uint32_t{board.encoder}; };
  switch (driver) {
#define SENSOR_DRIVER(name, sample, doc) \
  case vm::DriverId::name:               \
    return sample;
#define ACTUATOR_DRIVER(name, ...) \
  case vm::DriverId::name:         \
    return 0;
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
    case vm::DriverId::count_:
      break;
  }
  return 0;
}

// … and of all its channels.
inline std::uint32_t sample_cost(const vm::Image& image, const vm::Sensor& sensor,
                                 const BoardCosts& board) {
  if (!vm::is_microphone(sensor.driver))
    return sample_cost(sensor.driver, board) * sensor.channel_count;
  const auto channels = image.channels.subspan(sensor.first_channel, sensor.channel_count);
  const auto is_of_spectrum = [](const vm::Channel& channel) {
    return channel.input >= vm::kFirstOfSpectrum;
  };
  return (std::ranges::all_of(channels, is_of_spectrum) ? 0U : sample_cost(sensor.driver, board)) +
         (std::ranges::any_of(channels, is_of_spectrum) ? std::uint32_t{board.spectrum} : 0U);
}

// The cost of requesting the transfers of one sample ahead.
constexpr std::uint32_t ask_cost(vm::DriverId driver, const BoardCosts& board) {
  BoardCosts asking = board;
  asking.i2c_transfer = board.i2c_ask;
  asking.spi_transfer = board.spi_ask;
  asking.i2c_byte = board.i2c_ask_byte;
  asking.spi_byte = 0;
  return vm::is_on_i2c(driver) || vm::is_on_spi(driver) ? sample_cost(driver, asking) : 0;
}

// How long the transfers of one sample occupy their bus, in microseconds, if the bus works on its own; else 0. For a served
// device it is one transfer: the next one is requested when that is over.
constexpr std::uint32_t bus_us(const vm::Sensor& sensor, const BoardCosts& board) {
  if (!vm::is_on_i2c(sensor.driver) && !vm::is_on_spi(sensor.driver)) return 0;
  BoardCosts times = board;
  times.i2c_transfer = board.i2c_transfer_us;
  times.i2c_byte = board.i2c_byte_us;
  times.spi_transfer = board.spi_transfer_us;
  times.spi_byte = board.spi_byte_us;
  const bool once = vm::is_asked_once(sensor.driver) || vm::is_served(sensor.driver);
  return sample_cost(sensor.driver, times) * (once ? 1 : sensor.channel_count);
}

// The cost of a servo chip's frame. Its sample cost is that of its longest transfer. In a frame the chip's state is read, and the
// pulse of each of its `servos` is written; setting the chip up is rarer.
constexpr std::uint32_t frame_cost(std::uint32_t servos, const BoardCosts& board) {
  constexpr std::uint32_t kAsked = 4;  // bytes, with two addresses
  const std::uint32_t waits = board.i2c_ask == 0 ? 0 : (1 + servos) * board.wake_by_timer;
  return board.i2c_transfer + board.i2c_ask + kAsked * (board.i2c_byte + board.i2c_ask_byte) +
         waits +
         servos *
             (sample_cost(vm::DriverId::pca9685, board) + ask_cost(vm::DriverId::pca9685, board));
}

// The cost of a display's frame, which has at most kDisplayPortions transfers. Its sample cost is that of the longest one.
inline constexpr std::uint32_t kDisplayPortions = 8;
constexpr std::uint32_t display_frame_cost(const BoardCosts& board) {
  const std::uint32_t wait = board.i2c_ask == 0 ? 0U : std::uint32_t{board.wake_by_timer};
  return kDisplayPortions * (sample_cost(vm::DriverId::ssd1306, board) +
                             ask_cost(vm::DriverId::ssd1306, board) + wait);
}

constexpr ActuatorCosts actuator_costs(vm::DriverId driver) {
  constexpr bool at_once = true;
  constexpr bool later = false;
  switch (driver) {
#define SENSOR_DRIVER(name, ...) \
  case vm::DriverId::name:       \
    return {};
#define ACTUATOR_DRIVER(name, start, advance, release, ends, output, doc) \
  case vm::DriverId::name:                                                \
    return {start, advance, release, ends};
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
    case vm::DriverId::count_:
      break;
  }
  return {};
}

// … of an actuator of `image`, with its limit of acceleration or its encoders if it has them.
constexpr ActuatorCosts actuator_costs(const vm::Image& image, std::size_t actuator) {
  ActuatorCosts costs = actuator_costs(image.actuators[actuator].driver);
  if (vm::is_servo(image.actuators[actuator].driver)) {  // it looks for its pulses among the traits
    const auto look = static_cast<std::uint32_t>(costs::kTraitSeen * image.traits.size());
    costs.start += look;
    costs.advance += look;
    costs.release += look;
  }
  if (vm::is_counted_drive(image, actuator)) {
    costs.start += costs::kWheelsBegin;
    costs.advance += costs::kWheelsSeen;
  }
  if (image.acceleration_of(actuator) == 0) return costs;
  costs.start += costs::kRampBegins;
  costs.advance += costs::kRampBegins;
  costs.release += costs::kOnRamp;
  return costs;
}

// A sensor's driver is either not sampled (threads.hpp: is_fed(), is_algorithm()), or has a cost.
inline constexpr BoardCosts kOneEach = {
#define BOARD_COST(name, doc) .name = 1,
#include "runtime-m4/policy/board_costs.def"
#undef BOARD_COST
};
#define SENSOR_DRIVER(name, ...)                                 \
  static_assert(vm::DriverId::name == kFedDriver ||              \
                vm::DriverId::name == vm::DriverId::algorithm || \
                sample_cost(vm::DriverId::name, kOneEach) > 0);
#define ACTUATOR_DRIVER(name, ...)
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER

}  // namespace robosync::policy
