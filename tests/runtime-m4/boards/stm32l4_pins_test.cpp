// The shipped code for the pins of a board with this chip, against the model of the chip's timers: the output of each pin.
// ROBOSYNC_TEST_WIRES selects the board: this program is built for each of them.
#include <map>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "compiler/config/boards.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/registers.hpp"
#include ROBOSYNC_TEST_WIRES

using namespace robosync;
using tests::Stm32Timers;
using Level = Stm32Timers::Level;
namespace pins = boards::stm32l4::pins;
using namespace tests::wired;

namespace {

constexpr unsigned kFrame = 20'000;

std::vector<std::uint16_t> outputs() {
  std::vector<std::uint16_t> found;
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_names()[i] == kName)
      for (const compiler::Board::Pins& pins : compiler::board_at(i).outputs)
        for (std::uint16_t pin = pins.first; pin <= pins.last; ++pin)
          found.push_back(pin);
  return found;
}

// The chip, started as the board starts it. No pin may be high during the start.
struct Chip : Stm32Timers {
  Chip() {
    boards::stm32l4::rcc::kAhb2.set(boards::stm32l4::rcc::kPortsAToD);
    pins::start();
    starting = false;
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    Stm32Timers::write(address, value);
    for (const auto& [number, pin] : kHeader)
      if (starting) CHECK(level(pin) != Level::high);
    CHECK((!starting || level(kA5) != Level::low));  // a servo chip is never on by accident
    for (const Stm32Timers::Pin& pin : kAwake)
      CHECK((!starting || level(pin) != Level::low));
  }
  Level at(std::uint16_t pin) const { return level(kHeader.at(pin)); }
  void pass(unsigned us) {
    while (us-- > 0)
      pass_microsecond();
  }
  // How long the pin is high in the next `us` microseconds.
  unsigned high_time(std::uint16_t pin, unsigned us = kFrame) {
    const Stm32Timers::Pin asked = kHeader.at(pin);
    unsigned time = 0;
    while (us-- > 0) {
      time += level(asked) == Level::high ? 1U : 0U;
      pass_microsecond();
    }
    return time;
  }
  // The same for each pin.
  std::map<std::uint16_t, unsigned> high_times(unsigned us = kFrame) {
    std::map<std::uint16_t, unsigned> times;
    while (us-- > 0) {
      for (const auto& [number, pin] : kHeader)
        times[number] += level(pin) == Level::high ? 1U : 0U;
      pass_microsecond();
    }
    return times;
  }
  bool starting = true;
};

}  // namespace

TEST_CASE("each pin that the profile lets programs drive gives its pulse, and no other pin does") {
  REQUIRE(outputs().size() == kOutputs);
  for (const std::uint16_t pin : outputs()) {
    Chip chip;
    pins::write(pin, 1500);
    chip.pass(kFrame);
    for (const auto& [number, time] : chip.high_times()) {
      CAPTURE(pin, number);
      CHECK(time == (number == pin ? 1500 : 0));
    }
    CHECK(pins::read(pin) == 1500);
  }
}

TEST_CASE("from reset on the pins are low, those that give no pulses are not driven") {
  Chip chip;
  const auto driven = outputs();
  for (const auto& [number, pin] : kHeader) {
    const bool is_output = std::ranges::find(driven, number) != driven.end();
    CAPTURE(number);
    CHECK(chip.at(number) == (is_output ? Level::low : Level::floating));
    if (!is_output) {
      pins::write(number, 1500);
      CHECK(pins::read(number) == 0);
    }
  }
  for (const auto& [number, time] : chip.high_times(2 * kFrame))
    CHECK(time == 0);
}

TEST_CASE("all pins at once, each with its own pulse; off and always on are levels") {
  Chip chip;
  std::uint32_t pulse = 500;
  std::map<std::uint16_t, unsigned> wanted;
  for (const std::uint16_t pin : outputs())
    pins::write(pin, wanted[pin] = pulse += 100);
  pins::write(kThese[0], wanted[kThese[0]] = kFrame);
  pins::write(kThese[1], wanted[kThese[1]] = 0);
  chip.pass(kFrame);
  const auto times = chip.high_times();
  for (const auto& [pin, time] : wanted)
    CHECK(times.at(pin) == time);
}

TEST_CASE("whenever the pulse changes, no frame has anything but the old or the new one") {
  std::mt19937 random(475);
  Chip chip;
  pins::write(5, 1000);
  chip.pass(kFrame);
  unsigned old = 1000;
  for (unsigned round = 0; round < 40; ++round) {
    const unsigned fresh = 500 + static_cast<unsigned>(random() % 2000);
    const unsigned at = static_cast<unsigned>(random() % kFrame);
    unsigned time = chip.high_time(5, at);
    pins::write(5, fresh);
    time += chip.high_time(5, kFrame - at);
    CHECK(time == old);
    CHECK(chip.high_time(5) == fresh);
    old = fresh;
  }
}

TEST_CASE("off is at once, and only that pin") {
  const auto [one, other] = std::pair(kThese[0], kThese[1]);
  for (unsigned at = 0; at < 1800; at += 97) {
    Chip chip;
    pins::write(one, 2000);
    pins::write(other, 2000);
    chip.pass(kFrame + at);
    REQUIRE(chip.at(one) == Level::high);
    pins::write(one, 0);
    CHECK(chip.at(one) == Level::low);
    CHECK(chip.at(other) == Level::high);
    CHECK(chip.high_time(one, 2 * kFrame) == 0);
    pins::write(one, 700);  // and on again from the next frame
    chip.pass(kFrame - at);
    CHECK(chip.high_time(one) == 700);
  }
}

TEST_CASE("all off is at once, and before the start it does nothing") {
  Chip chip;
  for (const std::uint16_t pin : outputs())
    pins::write(pin, kFrame);
  chip.pass(kFrame);
  REQUIRE(chip.at(13) == Level::high);
  pins::switch_off();
  for (const auto& [number, time] : chip.high_times(2 * kFrame))
    CHECK(time == 0);
  Stm32Timers fresh;
  pins::switch_off();
  CHECK(fresh.level({'B', 0}) == Level::floating);
}

TEST_CASE(
    "STM32L4: the pin at a chip's enable input is high from the start on, and whenever all is "
    "off") {
  constexpr std::uint16_t kEnable = 45;
  Chip chip;
  CHECK(chip.level(kA5) == Level::high);
  for (std::uint16_t pin = 0; pin < kEnable; ++pin)
    pins::enable(pin, true);
  pins::write(kEnable, 1500);
  chip.pass(2 * kFrame);
  CHECK(chip.level(kA5) == Level::high);
  pins::enable(kEnable, true);
  CHECK(chip.level(kA5) == Level::low);
  pins::enable(kEnable, false);
  CHECK(chip.level(kA5) == Level::high);
  pins::enable(kEnable, true);
  pins::switch_off();
  CHECK(chip.level(kA5) == Level::high);
}

TEST_CASE("STM32L4: what must be awake is so from the start on, whatever is off") {
  Chip chip;
  const auto all_awake = [&] {
    return std::ranges::all_of(kAwake,
                               [&](const auto& pin) { return chip.level(pin) == Level::high; });
  };
  CHECK(all_awake());
  for (std::uint16_t pin = 0; pin < 64; ++pin) {
    pins::write(pin, 0);
    pins::enable(pin, true);
  }
  CHECK(all_awake());
  pins::switch_off();
  chip.pass(2 * kFrame);
  CHECK(all_awake());
}
