// The boards' analog inputs against models of the converters: which pin is measured, how accurately, the order of the start-up,
// and a converter that does not answer. The models were written from RM0351 and from Nordic's Product Specification, by the
// author of the drivers. Each register access takes the least possible time.
#include "runtime-m4/boards/stm32l4/analog.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <catch2/catch.hpp>

#include "compiler/config/boards.hpp"
#include "runtime-m4/boards/microbit-v2/analog.hpp"
#include "runtime-m4/boards/microbit-v2/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/stm32l4/inputs.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"
#include "tests/runtime-m4/boards/stm32_timers.hpp"

using namespace robosync;

namespace {

constexpr double kSupply = 3.3;
// The sampling time that voltage dividers of 50 kΩ need: DS10969's table for 39 kΩ, times 50 / 39, gives 10.3 us; Nordic says
// 10 us up to 100 kΩ.
constexpr double kLongEnoughUs = 10;

enum class Breaks { nothing, everything, calibration, ends, stops, late };

// A converter's time: microseconds since its chip runs, and when the present operation ends.
struct Doing {
  std::optional<double> until;
  void begin(double now, double us) { until = now + us; }
  bool over(double now) {
    const bool is = until && now >= *until;
    if (is) until.reset();
    return is;
  }
};

// SAADC, its one channel; each access takes a cycle of 16 MHz.
struct ConverterOfMicrobit : tests::Nrf52833 {
  static constexpr const char* kName = "microbit-v2";
  static constexpr std::uintptr_t kSaadc = 0x4000'7000;
  // The chip's analog inputs at the edge connector: {pin, chip's pin}.
  const std::map<std::uint16_t, Pin> pins{{0, {0, 2}}, {1, {0, 3}}, {2, {0, 4}}};
  const std::map<std::uint32_t, Pin> inputs{{1, {0, 2}}, {2, {0, 3}}, {3, {0, 4}}, {4, {0, 5}}};

  explicit ConverterOfMicrobit(Breaks breaks = Breaks::nothing) : broken(breaks) {
    boards::microbit::pins::start();
    boards::microbit::inputs::start();
    boards::microbit::analog::start();
    for (const auto& [number, pin] : pins)
      boards::microbit::pins::let_go(number, boards::Reads::voltage);
  }
  static bool measure(std::uint16_t pin, std::uint16_t& voltage) {
    return boards::microbit::analog::read(pin, voltage);
  }

  std::uint32_t read(std::uintptr_t address) override {
    if (!is_mine(address)) return Nrf52833::read(address);
    pass();
    const std::uintptr_t offset = address - kSaadc;
    if (offset < 0x100 || offset > 0x114) tests::no_register(address);
    return events.at((offset - 0x100) / 4);
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (!is_mine(address)) return Nrf52833::write(address, value);
    pass();
    const std::uintptr_t offset = address - kSaadc;
    if (offset < 0x100) {
      if (value == 1) begin(offset);
    } else if (offset <= 0x114) {
      tests::demand(value == 0, "an event can only be cleared");
      events.at((offset - 0x100) / 4) = 0;
    } else {
      configure(offset, value);
    }
  }
  static bool is_mine(std::uintptr_t address) {
    return address >= kSaadc && address < kSaadc + 0x1000;
  }
  void configure(std::uintptr_t offset, std::uint32_t value) {
    tests::demand(offset == 0x510 || !started, "it is configured while it measures");
    switch (offset) {
      case 0x500:
        enabled = value == 1;
        return;
      case 0x510:
        selected = value;
        return;
      case 0x518:
        configuration = value;
        return;
      case 0x5F0:
        resolution = value;
        return;
      case 0x5F4:
        tests::demand(value == 0, "a result is one conversion");
        return;
      case 0x62C:
        to = value;
        return;
      case 0x630:
        count = value;
        return;
      default:
        tests::no_register(kSaadc + offset);
    }
  }
  void begin(std::uintptr_t task) {
    tests::demand(enabled, "a task of what is off");
    if (broken == Breaks::everything) return;
    switch (task) {
      case 0x000:
        tests::demand(!started && !stopping.until, "it is started twice");
        starting.begin(now, 1);
        return;
      case 0x004:
        tests::demand(started, "a voltage is asked for before it is started");
        begin_sample();
        return;
      case 0x008:
        started = false;
        sampling.until.reset();
        if (broken != Breaks::stops) stopping.begin(now, 1);
        return;
      case 0x00C:
        tests::demand(!started, "calibrated while it measures");
        if (broken != Breaks::calibration) calibrating.begin(now, 100);
        return;
      default:
        tests::no_register(kSaadc + task);
    }
  }
  void begin_sample() {
    static constexpr std::array kTimes{3, 5, 10, 15, 20, 40};
    const unsigned taken_for = configuration >> 16 & 7;
    tests::demand(taken_for < kTimes.size() && (configuration >> 20) == 0, "its channel is set up");
    tests::demand(inputs.contains(selected), "an input is chosen");
    const Pin pin = inputs.at(selected);
    tests::demand(configuration_of(pin) == 0b10, "the pin is another's, too");
    tests::demand(count == 1, "one result");
    sampled_us = kTimes.at(taken_for);
    if (broken != Breaks::ends) sampling.begin(now, sampled_us + 2);
  }
  void pass() {
    now += 1.0 / 16;
    ++accesses;
    if (starting.over(now)) {
      started = true;
      events[0] = 1;
    }
    if (calibrating.over(now)) {
      offset_of_chip = 0;
      events[4] = 1;
    }
    if (stopping.over(now)) events[5] = 1;
    if (!sampling.over(now)) return;
    static constexpr std::array kGains{1.0 / 6, 1.0 / 5, 1.0 / 4, 1.0 / 3, 1.0 / 2, 1.0, 2.0, 4.0};
    static constexpr std::array kBits{8, 10, 12, 14};
    const double reference = (configuration >> 12 & 1) != 0 ? kSupply / 4 : 0.6;
    const int full = 1 << kBits.at(resolution);
    const double result =
        volts[inputs.at(selected)] * kGains.at(configuration >> 8 & 7) / reference * full +
        offset_of_chip;
    *static_cast<volatile std::int16_t*>(const_cast<volatile void*>(tests::memory_at(to))) =
        static_cast<std::int16_t>(std::clamp(std::lround(result), -8L, full - 1L));
    events[1] = 1;
  }
  void apply(std::uint16_t pin, double voltage) { volts[pins.at(pin)] = voltage; }

  Breaks broken;
  bool enabled = false, started = false;
  std::uint32_t selected = 0, configuration = 0x0002'0000, resolution = 1, to = 0, count = 0;
  std::array<std::uint32_t, 6> events{};
  Doing starting, calibrating, stopping, sampling;
  std::map<Pin, double> volts;
  double now = 0, offset_of_chip = 30, sampled_us = 0;
  unsigned accesses = 0;
};

// ADC1; each access takes four cycles of the core's 80 MHz: a load, a test and a branch.
struct ConverterOfL475 : tests::Stm32Timers {
  static constexpr const char* kName = "b-l475e-iot01a";
  static constexpr std::uintptr_t kAdc = 0x5004'0000, kSwitches = 0x4800'082C;
  // UM2153, table 4: A0 to A4.
  const std::map<std::uint16_t, Pin> pins{
      {40, {'C', 5}}, {41, {'C', 4}}, {42, {'C', 3}}, {43, {'C', 2}}, {44, {'C', 1}}};
  // DS10969, table 16: ADC123_IN1 to IN4, ADC12_IN13, IN14.
  const std::map<unsigned, Pin> channels{{1, {'C', 0}}, {2, {'C', 1}},  {3, {'C', 2}},
                                         {4, {'C', 3}}, {13, {'C', 4}}, {14, {'C', 5}}};

  explicit ConverterOfL475(Breaks breaks = Breaks::nothing) : broken(breaks) {
    Stm32Timers::write(0x4002'104C, 0b1111);
    boards::stm32l4::pins::start();
    boards::stm32l4::inputs::start();
    boards::stm32l4::analog::start();
  }
  static bool measure(std::uint16_t pin, std::uint16_t& voltage) {
    return boards::stm32l4::analog::read(pin, voltage);
  }

  bool is_mine(std::uintptr_t address) const { return address >= kAdc && address < kAdc + 0x400; }
  bool has_clock() { return (Stm32Timers::read(0x4002'104C) >> 13 & 1) != 0; }
  std::uint32_t read(std::uintptr_t address) override {
    if (address == 0x4002'1088) return sources;
    if (address == kSwitches) return switches;
    if (!is_mine(address)) return Stm32Timers::read(address);
    pass();
    if (!has_clock()) return 0;
    switch (address - kAdc) {
      case 0x00:
        return state;
      case 0x08:
        return control;
      case 0x0C:
        return configuration;
      case 0x14:
      case 0x18:
        return samples.at((address - kAdc - 0x14) / 4);
      case 0x40:
        state &= ~(1U << 2);
        return data;
      default:
        tests::no_register(address);
    }
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (address == 0x4002'1088) {
      sources = value;
    } else if (address == kSwitches) {
      switches = value;
    } else if (!is_mine(address)) {
      Stm32Timers::write(address, value);
    } else {
      pass();
      if (has_clock()) write_adc(address - kAdc, value);
    }
  }
  void write_adc(std::uintptr_t offset, std::uint32_t value) {
    if (offset == 0x00) {
      state &= ~value;
      return;
    }
    if (offset == 0x08) return order(value);
    tests::demand((control & 1U << 2) == 0, "it is configured while it measures");
    if (offset == 0x0C) {
      configuration = value;
    } else if (offset == 0x14 || offset == 0x18) {
      samples.at((offset - 0x14) / 4) = value;
    } else if (offset == 0x30) {
      sequence = value;
    } else if (offset == 0x308) {
      tests::demand((control & (1U | 1U << 31)) == 0, "its clock is changed while it is on");
      common = value;
    } else {
      tests::no_register(kAdc + offset);
    }
  }
  double adc_mhz() const {
    static constexpr std::array kBy{1, 2, 4, 6, 8, 10, 12, 16, 32, 64, 128, 256};
    tests::demand((sources >> 28 & 3) == 3 && (common & 3U << 16) == 0, "it has no clock");
    return 80.0 / kBy.at(common >> 18 & 15);
  }
  // Bits that only software may set and only the chip clears; and the deep power-down and the regulator.
  void order(std::uint32_t value) {
    constexpr std::uint32_t kPower = 1U << 28 | 1U << 29;
    tests::demand((value & ~(kPower | 1U << 31 | 0b10101U)) == 0,
                  "an order the model does not know");
    const std::uint32_t before = control;
    if ((value & 1U << 28) != 0 && (before & 1U << 28) == 0) {
      tests::demand((before & 1U << 29) == 0, "no regulator in deep power-down");
      regulated_at = now + 20;
    }
    control = (control & ~kPower) | (value & kPower);
    if ((value & 1U << 31) != 0 && (before & 1U << 31) == 0) calibrate();
    if ((value & 1U) != 0 && (before & 1U) == 0) switch_on();
    if ((value & 1U << 2) != 0 && (before & 1U << 2) == 0) begin_sequence();
    if ((value & 1U << 4) != 0 && (control & 1U << 2) != 0 && broken != Breaks::stops) {
      if (broken == Breaks::late) state |= 1U << 2 | 1U << 3;
      sampling.until.reset();
      control &= ~(1U << 2);
    }
  }
  void demand_power() const {
    tests::demand((control & 1U << 28) != 0 && now >= regulated_at, "its regulator is not up yet");
  }
  void calibrate() {
    demand_power();
    tests::demand((control & 1U) == 0, "calibrated while it is on");
    control |= 1U << 31;
    if (broken != Breaks::calibration) calibrating.begin(now, 116 / adc_mhz());
  }
  void switch_on() {
    demand_power();
    tests::demand((control & 1U << 31) == 0, "switched on while it is calibrated");
    if (now < calibrated_at + 4 / adc_mhz() || broken == Breaks::everything) return;
    control |= 1U;
    starting.begin(now, 1);
  }
  // SQR1: how many conversions, less one, and the channels of the first four.
  unsigned channel_of(unsigned conversion) const { return sequence >> 6 * (conversion + 1) & 31; }
  void begin_sequence() {
    tests::demand((control & 1U) != 0 && is_ready, "it measures before it is ready");
    tests::demand((sequence & 0xF) < 4 && (configuration >> 3 & 3) == 0, "a few voltages, 12 bits");
    tests::demand((sequence & 0xF) == 0 || (configuration & 1U << 12) != 0,
                  "a value that nobody has read stops the sequence");
    control |= 1U << 2;
    done = 0;
    begin_sample();
  }
  void begin_sample() {
    static constexpr std::array kCycles{2.5, 6.5, 12.5, 24.5, 47.5, 92.5, 247.5, 640.5};
    const unsigned channel = channel_of(done);
    const double cycles = kCycles.at(samples.at(channel / 10) >> 3 * (channel % 10) & 7);
    sampled_us = cycles / adc_mhz();
    if (channel != 0) demand_pin(channel);  // 0 is the chip's own reference
    measured = channel != 0 ? channels.at(channel) : Pin{};
    // ES0250: more than a millisecond after the last conversion, or after the calibration, the result may be wrong.
    is_late = now - last_end > 1000;
    if (broken == Breaks::nothing || broken == Breaks::calibration)
      sampling.begin(now, (cycles + 12.5) / adc_mhz());
  }
  void demand_pin(unsigned channel) {
    tests::demand(channels.contains(channel), "a channel that the header has");
    const auto [port, bit] = channels.at(channel);
    const std::uint32_t modes = Stm32Timers::read(0x4800'0800),
                        pulls = Stm32Timers::read(0x4800'080C);
    tests::demand((modes >> 2 * bit & 3) == 3 && (pulls >> 2 * bit & 3) == 0, "an analog pin");
    tests::demand((switches >> bit & 1) != 0, "the pin's switch is closed");
  }
  void pass() {
    now += 4.0 / 80;
    ++accesses;
    if (calibrating.over(now)) {
      control &= ~(1U << 31);
      calibrated_at = last_end = now;
      offset_of_chip = 0;
    }
    if (starting.over(now)) {
      is_ready = true;
      state |= 1;
    }
    if (!sampling.over(now)) return;
    const long counts =
        std::lround(volts[measured] / kSupply * 4096 + offset_of_chip + (is_late ? 300 : 0));
    data = static_cast<std::uint32_t>(std::clamp(counts, 0L, 4095L));
    last_end = now;
    state |= 1U << 2;
    if (done++ < (sequence & 0xF)) return begin_sample();
    state |= 1U << 3;
    control &= ~(1U << 2);
  }
  void apply(std::uint16_t pin, double voltage) { volts[pins.at(pin)] = voltage; }

  Breaks broken;
  std::uint32_t sources = 0, switches = 0, state = 0, control = 1U << 29, common = 0,
                configuration = 1U << 31, sequence = 0, data = 0;
  std::array<std::uint32_t, 2> samples{};
  bool is_ready = false;
  Pin measured{};
  Doing starting, calibrating, sampling;
  std::map<Pin, double> volts;
  double now = 0, regulated_at = 0, calibrated_at = 0, last_end = 0, offset_of_chip = 30,
         sampled_us = 0;
  bool is_late = false;
  unsigned accesses = 0, done = 0;
};

compiler::Board profile_of(std::string_view name) {
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_names()[i] == name) return compiler::board_at(i);
  FAIL("no board " << name);
  return {};
}

constexpr std::uint16_t kUntouched = 0xBEEF;

}  // namespace

TEMPLATE_TEST_CASE("analog: each pin's own voltage, as a part of the supply", "",
                   ConverterOfMicrobit, ConverterOfL475) {
  TestType chip;
  for (const auto& [number, pin] : chip.pins)
    chip.apply(number, 1.0);
  for (const auto& [number, pin] : chip.pins) {
    for (const double volts : {-0.005, 0.0, 0.1, 1.65, 3.0, 3.3, 3.4}) {
      chip.apply(number, volts);
      for (const auto& [read, its] : chip.pins) {
        chip.now += read % 2 == 0 ? 20'000 : 1;  // after a pause, and at once
        std::uint16_t voltage = kUntouched;
        REQUIRE(TestType::measure(read, voltage));
        CAPTURE(number, read, volts);
        const double wanted = read == number ? volts : 1.0;
        CHECK(voltage == std::clamp(std::lround(wanted / kSupply * 4096), 0L, 4095L));
        CHECK(chip.sampled_us >= kLongEnoughUs);
      }
    }
    chip.apply(number, 1.0);
  }
}

TEMPLATE_TEST_CASE("analog: the pins are those of the board's profile, and of no other", "",
                   ConverterOfMicrobit, ConverterOfL475) {
  TestType chip;
  const compiler::Board board = profile_of(TestType::kName);
  for (unsigned number = 0; number <= UINT16_MAX; ++number) {
    const auto pin = static_cast<std::uint16_t>(number);
    const bool is_there = chip.pins.contains(pin);
    CAPTURE(number);
    if (board.has_analog(pin) != is_there) FAIL_CHECK("the profile says otherwise");
    std::uint16_t voltage = kUntouched;
    if (!is_there && TestType::measure(pin, voltage)) FAIL_CHECK("measured, and not there");
    if (is_there && board.has_input(pin) && !board.has_output(pin))
      FAIL_CHECK("always pulled up as an input");
  }
}

TEMPLATE_TEST_CASE(
    "analog: one that does not answer is looked at a little, and none of its voltages is known", "",
    ConverterOfMicrobit, ConverterOfL475) {
  for (const Breaks breaks : {Breaks::everything, Breaks::ends}) {
    TestType chip(breaks);
    chip.apply(chip.pins.begin()->first, 1.0);
    for (unsigned turn = 0; turn < 3; ++turn) {
      const unsigned before = chip.accesses;
      std::uint16_t voltage = kUntouched;
      CHECK_FALSE(TestType::measure(chip.pins.begin()->first, voltage));
      CHECK(chip.accesses - before <= 620);
    }
  }
}

TEMPLATE_TEST_CASE("analog: bringing it up is looked at a while, not for ever", "",
                   ConverterOfMicrobit, ConverterOfL475) {
  for (const Breaks breaks : {Breaks::nothing, Breaks::everything, Breaks::calibration}) {
    const TestType chip(breaks);
    CHECK(chip.accesses < 11'000);
  }
}

TEMPLATE_TEST_CASE("analog: one that answers again is measured again", "", ConverterOfMicrobit,
                   ConverterOfL475) {
  TestType chip;
  const std::uint16_t pin = chip.pins.begin()->first;
  chip.apply(pin, 1.65);
  chip.broken = Breaks::ends;
  std::uint16_t voltage = kUntouched;
  CHECK_FALSE(TestType::measure(pin, voltage));
  chip.broken = Breaks::nothing;
  REQUIRE(TestType::measure(pin, voltage));
  CHECK(voltage == 2048);
}

TEST_CASE("analog: STM32L475: one that does not stop takes no other order, and costs no look") {
  ConverterOfL475 chip;
  chip.broken = Breaks::stops;
  std::uint16_t voltage = kUntouched;
  CHECK_FALSE(ConverterOfL475::measure(40, voltage));
  const unsigned before = chip.accesses;
  CHECK_FALSE(ConverterOfL475::measure(41, voltage));
  CHECK(chip.accesses - before == 1);
  CHECK(voltage == kUntouched);
}

TEST_CASE(
    "analog: STM32L475: one that ends when nobody looks any more is not taken for the next one") {
  ConverterOfL475 chip;
  chip.apply(40, 1.0);
  chip.apply(41, 1.65);
  std::uint16_t voltage = kUntouched;
  REQUIRE(ConverterOfL475::measure(40, voltage));
  chip.broken = Breaks::late;
  CHECK_FALSE(ConverterOfL475::measure(40, voltage));
  chip.broken = Breaks::nothing;
  REQUIRE(ConverterOfL475::measure(41, voltage));
  CHECK(voltage == 2048);
}

TEST_CASE("analog: nRF52833: no pin stays connected to it, nor does it go on") {
  ConverterOfMicrobit chip;
  for (const Breaks breaks : {Breaks::nothing, Breaks::ends}) {
    chip.broken = breaks;
    std::uint16_t voltage = kUntouched;
    static_cast<void>(ConverterOfMicrobit::measure(1, voltage));
    CHECK(chip.selected == 0);
    CHECK_FALSE(chip.started);
  }
}

TEST_CASE("analog: nRF52833: a ring is an output, and low, but for as long as it was let go") {
  using Level = ConverterOfMicrobit::Level;
  ConverterOfMicrobit chip;
  for (const auto& [number, pin] : chip.pins)
    boards::microbit::pins::take_back(number);
  for (const auto& [number, pin] : chip.pins) {
    CHECK(chip.level(pin) == Level::low);
    boards::microbit::pins::let_go(number, boards::Reads::voltage);
    CHECK(chip.level(pin) == Level::floating);
    boards::microbit::pins::switch_off();  // whatever goes wrong, it drives none
    CHECK(chip.level(pin) == Level::floating);
    for (const auto& [other, its] : chip.pins)
      if (other != number) CHECK(chip.level(its) == Level::low);
    boards::microbit::pins::take_back(number);
    CHECK(chip.level(pin) == Level::low);
    boards::microbit::pins::start();
    boards::microbit::pins::write(number, 1500);
    chip.pass_microsecond();
    CHECK_NOTHROW(chip.level(pin));
    boards::microbit::pins::switch_off();
  }
  boards::microbit::pins::let_go(5, boards::Reads::voltage);  // an input
  CHECK(chip.configuration_of({0, 14}) == 0b1100);
}
