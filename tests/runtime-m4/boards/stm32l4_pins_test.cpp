// The pins of the B-L475E-IOT01A, as they are shipped, against the model of the chip's timers: what comes out of each.
#include <map>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "compiler/config/boards.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/registers.hpp"
#include "tests/runtime-m4/boards/stm32_timers.hpp"

using namespace robosync;
using tests::Stm32Timers;
using Level = Stm32Timers::Level;
namespace pins = boards::stm32l4::pins;

namespace {

// UM2153, table 4: which pin of the chip stands at which of the header.
const std::map<std::uint16_t, Stm32Timers::Pin> kHeader{
    {0, {'A', 1}},  {1, {'A', 0}},  {2, {'D', 14}}, {3, {'B', 0}}, {4, {'A', 3}},
    {5, {'B', 4}},  {6, {'B', 1}},  {7, {'A', 4}},  {8, {'B', 2}}, {9, {'A', 15}},
    {10, {'A', 2}}, {11, {'A', 7}}, {12, {'A', 6}}, {13, {'A', 5}}};
constexpr Stm32Timers::Pin kA5{'C', 0};
constexpr Stm32Timers::Pin kDistanceSensor{'C', 6};  // UM2153: its XSHUT
constexpr unsigned kFrame = 20'000;

std::vector<std::uint16_t> outputs() {
  std::vector<std::uint16_t> found;
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_names()[i] == "b-l475e-iot01a")
      for (const auto& [first, last, power] : compiler::board_at(i).outputs)
        for (std::uint16_t pin = first; pin <= last; ++pin)
          found.push_back(pin);
  return found;
}

// The chip, started as the board starts it, and never with a pin high on the way.
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
    CHECK((!starting || level(kA5) != Level::low));  // a servo chip is never on by chance
    CHECK((!starting || level(kDistanceSensor) != Level::low));
  }
  Level at(std::uint16_t pin) const { return level(kHeader.at(pin)); }
  void pass(unsigned us) {
    while (us-- > 0)
      pass_microsecond();
  }
  // How long the pin is high in the next so many microseconds.
  unsigned high_time(std::uint16_t pin, unsigned us = kFrame) {
    const Stm32Timers::Pin asked = kHeader.at(pin);
    unsigned time = 0;
    while (us-- > 0) {
      time += level(asked) == Level::high ? 1U : 0U;
      pass_microsecond();
    }
    return time;
  }
  // The same of each pin.
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
  REQUIRE(outputs().size() == 9);
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
  pins::write(3, wanted[3] = kFrame);
  pins::write(4, wanted[4] = 0);
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
  for (unsigned at = 0; at < 1800; at += 97) {
    Chip chip;
    pins::write(3, 2000);  // both on timer 3
    pins::write(11, 2000);
    chip.pass(kFrame + at);
    REQUIRE(chip.at(3) == Level::high);
    pins::write(3, 0);
    CHECK(chip.at(3) == Level::low);
    CHECK(chip.at(11) == Level::high);
    CHECK(chip.high_time(3, 2 * kFrame) == 0);
    pins::write(3, 700);  // and on again from the next frame
    chip.pass(kFrame - at);
    CHECK(chip.high_time(3) == 700);
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
    "B-L475E: the pin at a chip's enable input is high from the start on, and whenever all is "
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

TEST_CASE("B-L475E: the distance sensor on the board is awake from the start on, whatever is off") {
  Chip chip;
  CHECK(chip.level(kDistanceSensor) == Level::high);
  for (std::uint16_t pin = 0; pin < 64; ++pin) {
    pins::write(pin, 0);
    pins::enable(pin, true);
  }
  CHECK(chip.level(kDistanceSensor) == Level::high);
  pins::switch_off();
  chip.pass(2 * kFrame);
  CHECK(chip.level(kDistanceSensor) == Level::high);
}
