// The micro:bit's logo and the temperature of its chip against models: of a pin that a resistor charges, with GPIOTE, PPI and
// TIMER0, and of TEMP. The models were written from Nordic's nRF52833 Product Specification, by the author of the drivers.
#include <algorithm>
#include <array>
#include <map>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/logo.hpp"
#include "runtime-m4/boards/microbit-v2/thermometer.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"

using namespace robosync;
namespace logo = boards::microbit::logo;
namespace thermometer = boards::microbit::thermometer;

namespace {

constexpr std::uint64_t kCyclesOfUs = 16, kCyclesOfMs = 1000 * kCyclesOfUs;  // cycles of 16 MHz
constexpr std::uint64_t kWithout = 45 * kCyclesOfUs, kWithFinger = 2500 * kCyclesOfUs;
constexpr unsigned kMostOfSample = 12;

// Each access takes a cycle.
struct ModelOfLogo : tests::Nrf52833 {
  static constexpr Pin kPin{1, 4};
  static constexpr std::uintptr_t kGpiote = 0x4000'6000, kPpi = 0x4001'F000, kTimer = 0x4000'8000;
  // The first channels are those of echoes and of the microphone, the first two of the timer those of the clock.
  static constexpr unsigned kFirstEdge = 6, kFirstJoin = 9, kFirstCapture = 2;

  ModelOfLogo() { logo::start(); }

  std::uint32_t read(std::uintptr_t address) override {
    pass(1);
    if (address >= kGpiote + 0x100 && address < kGpiote + 0x120)
      return edges.at((address - kGpiote - 0x100) / 4);
    if (address >= kGpiote + 0x510 && address < kGpiote + 0x530)
      return configured.at((address - kGpiote - 0x510) / 4);
    if (address >= kTimer + 0x540 && address < kTimer + 0x550)
      return values.at((address - kTimer - 0x540) / 4);
    return Nrf52833::read(address);
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    pass(1);
    if (address >= kGpiote + 0x100 && address < kGpiote + 0x120) {
      tests::demand(value == 0, "an event can only be cleared");
      edges.at((address - kGpiote - 0x100) / 4) = 0;
    } else if (address >= kGpiote + 0x510 && address < kGpiote + 0x530) {
      configure((address - kGpiote - 0x510) / 4, value);
    } else if (address == kPpi + 0x504) {
      tests::demand((value & ((1U << kFirstJoin) - 1)) == 0, "the channel is another's");
      joined |= value;
    } else if (address >= kPpi + 0x510 && address < kPpi + 0x5B0) {
      const auto place = (address - kPpi - 0x510) / 4;
      (place % 2 == 0 ? events : tasks).at(place / 2) = value;
    } else if (address >= kTimer + 0x040 && address < kTimer + 0x050) {
      values.at((address - kTimer - 0x040) / 4) = static_cast<std::uint32_t>(now);
    } else {
      Nrf52833::write(address, value);
    }
    follow();
  }
  // Setting up a channel may cause an event.
  void configure(std::size_t channel, std::uint32_t value) {
    tests::demand(channel >= kFirstEdge, "the channel is another's");
    tests::demand(value == 0 || value == (1U | 0x24U << 8 | 1U << 16), "a rising edge of P1.04");
    configured.at(channel) = value;
    if (value != 0) happens(channel);
  }
  void happens(std::size_t channel) {
    edges.at(channel) = 1;
    for (std::size_t i = 0; i < events.size(); ++i) {
      if ((joined >> i & 1) == 0 || events[i] != kGpiote + 0x100 + 4 * channel) continue;
      const std::uintptr_t capture = (tasks[i] - kTimer - 0x040) / 4;
      tests::demand(capture >= kFirstCapture && capture < 4, "a capture, and not the clock's");
      values.at(capture) = static_cast<std::uint32_t>(now);
    }
  }
  bool watched() const {
    for (const std::uint32_t one : configured)
      if (one != 0) return true;
    return false;
  }
  // The pin is empty while it is driven. A channel that watches it makes it an input, whatever its port says.
  void follow() {
    const bool driven = (configuration_of(kPin) & 1) != 0 && !watched();
    tests::demand(!driven || !is_set(kPin), "the logo is driven high");
    const std::uint32_t configuration = configuration_of(kPin);
    tests::demand((configuration & 0b1100) == 0, "another current than that of the resistor");
    tests::demand(!watched() || configuration == 0, "the port and the channel differ");
    if (driven) empty_at = now;
    if (driven || now - empty_at < charging) is_high = false;
  }
  void pass(std::uint64_t cycles) {
    const std::uint64_t end = now + cycles;
    const bool driven = (configuration_of(kPin) & 1) != 0 && !watched();
    if (driven) {
      empty_at = end;
    } else if (!is_high && empty_at + charging <= end) {
      now = std::max(now + 1, empty_at + charging);
      is_high = true;
      for (std::size_t channel = 0; channel < configured.size(); ++channel)
        if (configured[channel] != 0) happens(channel);
    }
    now = end;
  }
  // A sample, and the time until the next one.
  int sample(std::uint64_t period = 10 * kCyclesOfMs) {
    const std::uint64_t before = now;
    std::int32_t raw = -1;
    const bool known = logo::measure(raw);
    CHECK(now - before <= kMostOfSample);
    pass(period);
    return known ? raw : -1;
  }
  int sample_twice(std::uint64_t time, std::uint64_t period = 10 * kCyclesOfMs) {
    charging = time;
    sample(period);
    return sample(period);
  }

  std::array<std::uint32_t, 8> edges{}, configured{};
  std::array<std::uint32_t, 4> values{};
  std::array<std::uintptr_t, 20> events{}, tasks{};
  std::uint32_t joined = 0;
  std::uint64_t now = 0xFFFF'8000;  // the counter will overflow
  std::uint64_t empty_at = now, charging = kWithout;
  bool is_high = false;
};

}  // namespace

TEST_CASE("logo: it is touched while a finger is there, and each measurement is given twice") {
  ModelOfLogo chip;
  CHECK(chip.sample() == -1);
  CHECK(chip.sample() == 0);
  for (unsigned turn = 0; turn < 3; ++turn) {
    chip.charging = kWithFinger;
    CHECK(chip.sample() == 0);
    CHECK(chip.sample() == 1);
    chip.charging = kWithout;
    CHECK(chip.sample() == 1);
    CHECK(chip.sample() == 0);
  }
}

TEST_CASE("logo: a light finger counts, a little more than nobody does not") {
  ModelOfLogo chip;
  chip.sample_twice(kWithout);
  CHECK(chip.sample_twice(kWithout * 3 / 2) == 0);
  CHECK(chip.sample_twice(kWithout * 2) == 0);
  CHECK(chip.sample_twice(kWithout * 3) == 1);
  CHECK(chip.sample_twice(kWithout * 2) == 1);  // it was touched, so it takes less to stay so
  CHECK(chip.sample_twice(kWithout) == 0);
}

TEST_CASE(
    "logo: a pin that stays low, or is looked at early, is touched, once the usual is known") {
  ModelOfLogo chip;
  for (unsigned turn = 0; turn < 5; ++turn)
    CHECK(chip.sample_twice(1000 * kCyclesOfMs) == -1);
  CHECK(chip.sample_twice(kWithout) == 0);
  CHECK(chip.sample_twice(1000 * kCyclesOfMs) == 1);
  CHECK(chip.sample_twice(kWithFinger, kCyclesOfMs) == 1);
  CHECK(chip.sample_twice(kWithout, kCyclesOfMs) == 0);
}

TEST_CASE("logo: a finger that was there from the start is noticed when it comes back") {
  ModelOfLogo chip;
  for (unsigned turn = 0; turn < 20; ++turn)
    CHECK(chip.sample_twice(kWithFinger) == 0);
  for (unsigned turn = 0; turn < 15; ++turn)
    CHECK(chip.sample_twice(kWithout) == 0);
  CHECK(chip.sample_twice(kWithFinger) == 1);
}

TEST_CASE("logo: the usual time follows slowly, and one short time does not spoil it") {
  ModelOfLogo chip;
  for (std::uint64_t time = kWithout; time < 4 * kWithout; time += kCyclesOfUs / 4)
    if (chip.sample_twice(time) != 0) FAIL(time);
  CHECK(chip.sample_twice(16 * kWithout) == 1);
  CHECK(chip.sample_twice(4 * kWithout) == 0);
  CHECK(chip.sample_twice(kCyclesOfUs) == 0);  // noise
  CHECK(chip.sample_twice(4 * kWithout) == 0);
  for (unsigned turn = 0; turn < 10'000; ++turn)
    if (chip.sample_twice(kWithFinger) != 1) FAIL("a long touch becomes the usual");
}

namespace {

struct TemperatureChip : tests::RegisterModel {
  std::int32_t quarters = 0;
  bool broken = false, ready = false, measures = false;
  unsigned accesses = 0;

  std::uint32_t read(std::uintptr_t address) override {
    ++accesses;
    if (address == 0x4000'C100) return ready ? 1 : 0;
    if (address == 0x4000'C508) return static_cast<std::uint32_t>(quarters);
    tests::no_register(address);
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    ++accesses;
    if (address == 0x4000'C000) {
      measures = value == 1;
    } else if (address == 0x4000'C004) {
      measures = false;
    } else if (address == 0x4000'C100) {
      tests::demand(value == 0, "an event can only be cleared");
      ready = false;
    } else {
      tests::no_register(address);
    }
  }
  void pass() { ready = ready || (measures && !broken); }
};

}  // namespace

TEST_CASE("thermometer: each result once, below zero, too; none if there is none") {
  TemperatureChip chip;
  std::int32_t raw = 12345;
  CHECK_FALSE(thermometer::measure(raw));
  for (const std::int32_t quarters : {95, -17, 0, 420, -160}) {
    chip.quarters = quarters;
    chip.pass();
    REQUIRE(thermometer::measure(raw));
    CHECK(raw == quarters);
    CHECK_FALSE(thermometer::measure(raw));  // too early
  }
  chip.broken = true;
  for (unsigned turn = 0; turn < 3; ++turn) {
    chip.accesses = 0;
    chip.pass();
    CHECK_FALSE(thermometer::measure(raw));
    CHECK(chip.accesses <= 6);
  }
  chip.broken = false;
  chip.pass();
  CHECK(thermometer::measure(raw));
}
