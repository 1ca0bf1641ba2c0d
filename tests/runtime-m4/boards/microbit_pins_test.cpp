// The shipped code for the pins of the micro:bit V2, against the model of the chip's PWM modules: the output of each pin,
// whenever a module reads its values, and however late its interrupt is served.
#include <map>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "compiler/config/boards.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"

using namespace robosync;
using tests::Nrf52833;
namespace edge = boards::microbit::pins;

namespace {

// tech.microbit.org, "Edge Connector & micro:bit pinout", V2: the chip's pin at each pin of the edge connector.
const std::map<std::uint16_t, Nrf52833::Pin> kEdge{
    {0, {0, 2}},   {1, {0, 3}},   {2, {0, 4}},   {3, {0, 31}},  {4, {0, 28}},
    {5, {0, 14}},  {6, {1, 5}},   {7, {0, 11}},  {8, {0, 10}},  {9, {0, 9}},
    {10, {0, 30}}, {11, {0, 23}}, {12, {0, 12}}, {13, {0, 17}}, {14, {0, 1}},
    {15, {0, 13}}, {16, {1, 2}},  {19, {0, 26}}, {20, {1, 0}}};
constexpr std::uint16_t kEnable = 16;  // of a chip: high is off
constexpr unsigned kEdgeFrame = 20'000;
constexpr unsigned kNewest = 2 * kEdgeFrame;  // until a written value is in effect
constexpr unsigned kBackAgain = 3 * kEdgeFrame;

std::vector<std::uint16_t> edge_outputs() {
  std::vector<std::uint16_t> found;
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_names()[i] == "microbit-v2")
      for (const compiler::Board::Pins& pins : compiler::board_at(i).outputs)
        for (std::uint16_t pin = pins.first; pin <= pins.last; ++pin)
          found.push_back(pin);
  return found;
}

// The chip, started as the board starts it. No pin may be high during the start.
struct EdgeChip : Nrf52833 {
  explicit EdgeChip(Nrf52833::Fetch fetch = Nrf52833::Fetch::late) : Nrf52833(fetch) {
    edge::start();
    starting = false;
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    Nrf52833::write(address, value);
    for (const auto& [number, pin] : kEdge)
      if (starting)
        CHECK(level(pin) != (number == kEnable ? Nrf52833::Level::low : Nrf52833::Level::high));
  }
  Nrf52833::Level at(std::uint16_t pin) const { return level(kEdge.at(pin)); }
  void pass(unsigned us) {
    for (; us > 0; --us) {
      pass_microsecond();
      waits = pwm_interrupt() ? waits + 1 : 0;
      if (waits <= latency) continue;
      edge::on_period_end();
      ++served;
    }
  }
  // How long the pin is high in the next `us` microseconds.
  unsigned high_time(std::uint16_t pin, unsigned us = kEdgeFrame) {
    unsigned time = 0;
    for (; us > 0; --us) {
      time += at(pin) == Nrf52833::Level::high ? 1U : 0U;
      pass(1);
    }
    return time;
  }
  // The same for each pin except the enable pin.
  std::map<std::uint16_t, unsigned> high_times(unsigned us = kEdgeFrame) {
    std::map<std::uint16_t, unsigned> times;
    for (; us > 0; --us) {
      for (const auto& [number, pin] : kEdge)
        if (number != kEnable) times[number] += level(pin) == Nrf52833::Level::high ? 1U : 0U;
      pass(1);
    }
    return times;
  }
  unsigned latency = 0, waits = 0;  // of the interrupt, in microseconds
  unsigned served = 0;
  bool starting = true;
};

}  // namespace

TEST_CASE(
    "micro:bit: each pin that the profile lets programs drive gives its pulse, no other does") {
  REQUIRE(edge_outputs().size() == 6);
  for (const std::uint16_t pin : edge_outputs()) {
    EdgeChip chip;
    edge::write(pin, 1500);
    chip.pass(kNewest);
    for (const auto& [number, time] : chip.high_times()) {
      CAPTURE(pin, number);
      CHECK(time == (number == pin ? 1500 : 0));
    }
    CHECK(edge::read(pin) == 1500);
  }
}

TEST_CASE("micro:bit: from reset on the pins are low, those that give no pulses are not driven") {
  EdgeChip chip;
  const auto driven = edge_outputs();
  for (const auto& [number, pin] : kEdge) {
    if (number == kEnable) continue;
    const bool is_output = std::ranges::find(driven, number) != driven.end();
    CAPTURE(number);
    CHECK(chip.at(number) == (is_output ? Nrf52833::Level::low : Nrf52833::Level::floating));
    if (!is_output) {
      edge::write(number, 1500);
      CHECK(edge::read(number) == 0);
    }
  }
  for (const auto& [number, time] : chip.high_times(2 * kEdgeFrame))
    CHECK(time == 0);
  CHECK_FALSE(chip.pwm_interrupt());
}

TEST_CASE("micro:bit: all pins at once, each with its own pulse; off and always on are levels") {
  for (const Nrf52833::Fetch fetch : {Nrf52833::Fetch::early, Nrf52833::Fetch::late}) {
    EdgeChip chip(fetch);
    std::uint32_t pulse = 500;
    std::map<std::uint16_t, unsigned> wanted;
    for (const std::uint16_t pin : edge_outputs())
      edge::write(pin, wanted[pin] = pulse += 100);
    edge::write(12, wanted[12] = kEdgeFrame);
    edge::write(14, wanted[14] = 0);
    edge::write(0, wanted[0] = 1);
    edge::write(13, wanted[13] = kEdgeFrame - 1);
    chip.pass(kNewest);
    const auto times = chip.high_times();
    for (const auto& [pin, time] : wanted)
      CHECK(times.at(pin) == time);
  }
}

TEST_CASE(
    "micro:bit: whenever the pulse changes, no frame has anything but the old or the new one") {
  std::mt19937 random(833);
  for (const Nrf52833::Fetch fetch : {Nrf52833::Fetch::early, Nrf52833::Fetch::late}) {
    EdgeChip chip(fetch);
    edge::write(13, 1000);
    chip.pass(kNewest);
    unsigned old = 1000;
    for (unsigned round = 0; round < 10; ++round) {
      const unsigned fresh = 500 + static_cast<unsigned>(random() % 2000);
      const unsigned at = static_cast<unsigned>(random() % kEdgeFrame);
      unsigned time = chip.high_time(13, at);
      edge::write(13, fresh);
      time += chip.high_time(13, kEdgeFrame - at);
      CHECK(time == old);
      const unsigned next = chip.high_time(13);
      CHECK((next == fresh || next == old));
      CHECK(chip.high_time(13) == fresh);
      old = fresh;
    }
  }
}

TEST_CASE("micro:bit: off is at once, and only that pin; on again comes with whole pulses") {
  for (const Nrf52833::Fetch fetch : {Nrf52833::Fetch::early, Nrf52833::Fetch::late}) {
    for (unsigned at = 0; at < 1800; at += 197) {
      EdgeChip chip(fetch);
      edge::write(0, 2000);  // both of PWM0
      edge::write(12, 2000);
      chip.pass(kNewest + at);
      REQUIRE(chip.at(0) == Nrf52833::Level::high);
      edge::write(0, 0);
      CHECK(chip.at(0) == Nrf52833::Level::low);
      CHECK(chip.at(12) == Nrf52833::Level::high);
      edge::write(0, 700);
      CHECK(edge::read(0) == 700);
      CHECK(chip.high_time(0, kEdgeFrame - at) == 0);
      CHECK(chip.high_time(12) == 2000);
      chip.pass(kBackAgain);
      CHECK(chip.high_time(0) == 700);
      const unsigned served = chip.served;  // interrupts come while a pin waits for a period
      chip.pass(kEdgeFrame);
      CHECK(chip.served == served);
    }
  }
}

// A pulse must begin with a frame, and end when that was requested, or after a length that was requested since the pin was
// off.
TEST_CASE(
    "micro:bit: whatever is written when, and however late interrupts are, pulses are whole") {
  std::mt19937 random(52833);
  for (unsigned run = 0; run < 6; ++run) {
    EdgeChip chip(run % 2 == 0 ? Nrf52833::Fetch::early : Nrf52833::Fetch::late);
    chip.latency = run / 2 * 16'000;
    std::map<unsigned, unsigned> asked;  // pulse, and when at last
    unsigned high_since = 0, seen = 0;
    bool was_high = false, cut = false;
    for (unsigned now = 0; now < 30 * kEdgeFrame; ++now) {
      if (random() % 15'000 == 0) {
        const unsigned pulse = random() % 3 == 0 ? 0 : 500 + static_cast<unsigned>(random() % 2000);
        cut = pulse == 0;
        if (cut) asked.clear();
        asked[pulse] = now;
        edge::write(2, pulse);
        if (pulse == 0) CHECK(chip.at(2) == Nrf52833::Level::low);
      }
      const bool is_high = chip.at(2) == Nrf52833::Level::high;
      if (is_high && !was_high) {
        CHECK(now % kEdgeFrame == 0);
        high_since = now;
        ++seen;
      }
      if (!is_high && was_high && !cut) {
        CAPTURE(run, now, now - high_since);
        CHECK(asked.contains(now - high_since));
      }
      if (!is_high) cut = false;
      was_high = is_high;
      chip.pass(1);
    }
    CHECK(seen > (chip.latency == 0 ? 4 : 0));
  }
}

TEST_CASE("micro:bit: all off is at once, and before the start it does nothing") {
  EdgeChip chip;
  for (const std::uint16_t pin : edge_outputs())
    edge::write(pin, kEdgeFrame);
  chip.pass(kNewest);
  REQUIRE(chip.at(14) == Nrf52833::Level::high);
  edge::switch_off();
  for (const auto& [number, time] : chip.high_times(2 * kEdgeFrame))
    CHECK(time == 0);
  CHECK(chip.served == 0);  // no further period interrupts
  edge::write(14, kEdgeFrame);
  CHECK(chip.high_time(14, 2 * kEdgeFrame) == 0);
  Nrf52833 fresh;
  edge::switch_off();
  CHECK(fresh.level({0, 2}) == Nrf52833::Level::floating);
}

TEST_CASE(
    "micro:bit: the pin at a chip's enable input is high from the start on, and whenever all is "
    "off") {
  EdgeChip chip;
  CHECK(chip.at(kEnable) == Nrf52833::Level::high);
  edge::write(kEnable, 1500);  // gives no pulses, and does not go low
  edge::let_go(kEnable, boards::Reads::level);
  edge::take_back(kEnable);
  chip.pass(kNewest);
  CHECK(chip.at(kEnable) == Nrf52833::Level::high);
  for (const std::uint16_t pin : edge_outputs())
    edge::enable(pin, true);
  CHECK(chip.at(kEnable) == Nrf52833::Level::high);
  edge::enable(kEnable, true);
  CHECK(chip.at(kEnable) == Nrf52833::Level::low);
  edge::enable(kEnable, false);
  CHECK(chip.at(kEnable) == Nrf52833::Level::high);
  edge::enable(kEnable, true);
  edge::switch_off();
  CHECK(chip.at(kEnable) == Nrf52833::Level::high);
}
