// The pins that a program's sensors use: see output_guard.hpp.
#include <bit>
#include <cstdint>

#include "runtime-m4/guard/output_guard.hpp"
#include "vm/drivers.hpp"

namespace robosync::guard {

// The image must be verified.
OutputGuard::ReadPins OutputGuard::read_by(const vm::Image& image) const {
  const policy::BoardPins& board = board_.pins();
  ReadPins pins;
  const auto is_shared = [&](std::uint16_t pin) {
    return pin < policy::kMostShared && policy::limit_of(board, pin) != nullptr;
  };
  for (const vm::Sensor& sensor : image.sensors) {
    const std::uint16_t pin = sensor.address;
    if (vm::has_second_input(sensor) && is_shared(sensor.bus) &&
        policy::is_input(board, sensor.bus))
      pins.levels |= Pins{1} << sensor.bus;
    if (!is_shared(pin)) continue;
    if (vm::is_analog(sensor.driver) && policy::is_analog(board, pin))
      pins.voltages |= Pins{1} << pin;
    if (vm::is_on_pin(sensor.driver) && policy::is_input(board, pin)) pins.levels |= Pins{1} << pin;
  }
  return pins;
}

void OutputGuard::take_back_all_but(const ReadPins& read) {
  for (Pins left = let_go_.all() & ~read.all(); left != 0; left &= left - 1)
    board_.take_back(static_cast<std::uint16_t>(std::countr_zero(left)));
  let_go_ = {let_go_.voltages & read.all(), let_go_.levels & read.all()};
}

// A pin of which the next program reads something else is not driven in between, either.
void OutputGuard::let_go_of(const ReadPins& read) {
  let_go_of(read.voltages & ~let_go_.voltages, boards::Reads::voltage);
  let_go_of(read.levels & ~let_go_.levels, boards::Reads::level);
  let_go_ = read;
}

void OutputGuard::let_go_of(Pins pins, boards::Reads what) {
  for (; pins != 0; pins &= pins - 1)
    board_.let_go(static_cast<std::uint16_t>(std::countr_zero(pins)), what);
}

// The image fits the board.
void OutputGuard::open_spi(const vm::Image& image) {
  for (const vm::Sensor& sensor : image.sensors)
    if (vm::is_on_spi(sensor.driver)) board_.spi_open(sensor.bus, sensor.address);
}

// Their pins are unused afterwards.
void OutputGuard::end_measurements() {
  const auto lock = kernel_.lock();
  for (const vm::Sensor& sensor : sensors_)
    if (vm::is_by_echo(sensor.driver)) static_cast<void>(board_.take_echo(sensor.address));
  for (unsigned number = 0; number < vm::kMaxEncoders; ++number)
    board_.end_edges(number);
  sensors_ = {};
}

void OutputGuard::ping(unsigned sensor) {
  const auto lock = kernel_.lock();
  if (sensor >= sensors_.size()) return;
  const vm::Sensor& wiring = sensors_[sensor];
  const policy::BoardPins& pins = board_.pins();
  if (vm::is_by_echo(wiring.driver) && policy::judge(wiring, pins) == vm::Refusal::none)
    board_.ping(wiring.bus, wiring.address);
}

}  // namespace robosync::guard
