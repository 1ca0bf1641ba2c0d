// The boards' trigger and echo code, and that which counts the edges of encoders, against models of the peripherals: the pulse, the
// length of an echo, the edges of a wheel, and anything else that a wire can do. The models were written from RM0351 and from Nordic's Product Specification, by the author of the
// drivers.
#include "runtime-m4/boards/stm32l4/echoes.hpp"

#include <array>
#include <map>
#include <random>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/echoes.hpp"
#include "runtime-m4/boards/microbit-v2/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/stm32l4/inputs.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"
#include "tests/runtime-m4/boards/stm32_timers.hpp"

using namespace robosync;

namespace {

// EXTI and SYSCFG: an edge becomes pending if its line is configured for it, and interrupts if the line is unmasked.
struct EdgesOfL475 : tests::Stm32Timers {
  static constexpr std::uint16_t kTrigger = 3, kEcho = 7, kOtherTrigger = 13, kOther = 12;
  const std::map<std::uint16_t, Pin> pins{
      {3, {'B', 0}}, {7, {'A', 4}}, {12, {'A', 6}}, {13, {'A', 5}}};

  EdgesOfL475() {
    write(0x4002'104C, 0b1111);
    for (const std::uint16_t pin : {kEcho, kOther})
      wire(pins.at(pin), false);
    boards::stm32l4::pins::start();
    boards::stm32l4::inputs::start();
    boards::stm32l4::echoes::start();
  }
  static void ping(std::uint16_t trigger, std::uint16_t echo) {
    boards::stm32l4::echoes::ping(trigger, echo);
  }
  static std::uint32_t take(std::uint16_t echo) { return boards::stm32l4::echoes::take(echo); }
  bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                  boards::Turned& turned) const {
    return boards::stm32l4::echoes::take_edges(number, a, b, most, 80 * now, turned);
  }
  static void end_edges(unsigned number) { boards::stm32l4::echoes::end_edges(number); }
  static policy::EncoderCount so_far(unsigned number) {
    return boards::stm32l4::echoes::edges_so_far(number);
  }

  std::uint32_t read(std::uintptr_t address) override {
    if (address == 0x4002'1060) return system_clocks;
    if (address >= 0x4001'0008 && address <= 0x4001'0014) return ports[(address - 0x4001'0008) / 4];
    if (address == 0x4001'0400) return mask;
    if (address == 0x4001'0408) return rising;
    if (address == 0x4001'040C) return falling;
    if (address == 0x4001'0414) return pending;
    return Stm32Timers::read(address);
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (address == 0x4002'1060) {
      system_clocks = value;
    } else if (address >= 0x4001'0008 && address <= 0x4001'0014) {
      if ((system_clocks & 1) != 0) ports[(address - 0x4001'0008) / 4] = value;
    } else if (address == 0x4001'0400) {
      mask = value;
    } else if (address == 0x4001'0408) {
      rising = value;
    } else if (address == 0x4001'040C) {
      falling = value;
    } else if (address == 0x4001'0414) {
      pending &= ~value;
    } else {
      Stm32Timers::write(address, value);
    }
  }
  void set(std::uint16_t pin, bool high) {
    const auto [port, line] = pins.at(pin);
    const bool was = level_of[pin];
    level_of[pin] = high;
    wire(pins.at(pin), high);
    const bool looked_at = ((high ? rising : falling) >> line & 1) != 0;
    const bool mine = (ports[line / 4] >> line % 4 * 4 & 0xF) == static_cast<unsigned>(port - 'A');
    if (was != high && looked_at && mine) pending |= 1U << line;
  }
  void interrupt() {
    for (unsigned i = 0; i < 8 && (pending & mask) != 0; ++i, ++interrupts)
      boards::stm32l4::echoes::on_edge(80 * now);
    CHECK((pending & mask) == 0);
  }
  void pass_one() {
    pass_microsecond();
    ++now;
  }
  bool is_triggered(std::uint16_t pin) const { return level(pins.at(pin)) == Level::high; }

  std::uint32_t system_clocks = 0, mask = 0xFF82'0000, rising = 0, falling = 0, pending = 0;
  std::array<std::uint32_t, 4> ports{};
  std::map<std::uint16_t, bool> level_of;
  std::uint32_t now = 0xFFFF'0000U / 80;  // the counter will overflow
  unsigned interrupts = 0;
};

// GPIOTE, PPI and TIMER3.
struct EdgesOfMicrobit : tests::Nrf52833 {
  static constexpr std::uint16_t kTrigger = 0, kEcho = 5, kOtherTrigger = 14, kOther = 11;
  const std::map<std::uint16_t, Pin> pins{{0, {0, 2}},   {14, {0, 1}}, {13, {0, 17}}, {5, {0, 14}},
                                          {11, {0, 23}}, {8, {0, 10}}, {9, {0, 9}}};
  static constexpr std::uintptr_t kGpiote = 0x4000'6000, kPpi = 0x4001'F000, kTimer = 0x4001'A000;

  EdgesOfMicrobit() {
    for (const std::uint16_t pin : {kEcho, kOther, std::uint16_t{8}, std::uint16_t{9}})
      wire(pins.at(pin), false);
    boards::microbit::pins::start();
    boards::microbit::inputs::start();
    boards::microbit::echoes::start();
  }
  static void ping(std::uint16_t trigger, std::uint16_t echo) {
    boards::microbit::echoes::ping(trigger, echo);
  }
  static std::uint32_t take(std::uint16_t echo) { return boards::microbit::echoes::take(echo); }
  static bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                         boards::Turned& turned) {
    return boards::microbit::echoes::take_edges(number, a, b, most, turned);
  }
  static void end_edges(unsigned number) { boards::microbit::echoes::end_edges(number); }
  static policy::EncoderCount so_far(unsigned number) {
    return boards::microbit::echoes::edges_so_far(number);
  }

  std::uint32_t read(std::uintptr_t address) override {
    if (address >= kGpiote + 0x100 && address < kGpiote + 0x120)
      return edges[(address - kGpiote - 0x100) / 4];
    if (address >= kTimer + 0x540 && address < kTimer + 0x558)
      return values[(address - kTimer - 0x540) / 4];
    return Nrf52833::read(address);
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (address >= kGpiote && address < kGpiote + 0x1000)
      return write_gpiote(address - kGpiote, value);
    if (address >= kPpi && address < kPpi + 0x1000) return write_ppi(address - kPpi, value);
    if (address >= kTimer && address < kTimer + 0x1000) return write_timer(address - kTimer, value);
    Nrf52833::write(address, value);
  }
  void write_gpiote(std::uintptr_t offset, std::uint32_t value) {
    if (offset >= 0x030 && offset < 0x050) {
      if (value == 1) drive(static_cast<unsigned>(offset - 0x030) / 4, true);
    } else if (offset >= 0x060 && offset < 0x080) {
      if (value == 1) drive(static_cast<unsigned>(offset - 0x060) / 4, false);
    } else if (offset >= 0x100 && offset < 0x120) {
      tests::demand(value == 0, "an event can only be cleared");
      edges[(offset - 0x100) / 4] = 0;
    } else if (offset == 0x304) {
      enabled |= value;
    } else if (offset == 0x308) {
      enabled &= ~value;
    } else if (offset >= 0x510 && offset < 0x530) {
      const auto channel = (offset - 0x510) / 4;
      configured[channel] = value;
      driven[channel] = (value >> 20 & 1) != 0;
    } else {
      tests::no_register(kGpiote + offset);
    }
  }
  void drive(unsigned channel, bool high) {
    if ((configured[channel] & 3) == 3) driven[channel] = high;
  }
  void write_ppi(std::uintptr_t offset, std::uint32_t value) {
    if (offset == 0x504)
      joined |= value;
    else if (offset >= 0x510 && offset < 0x5B0)
      ((offset - 0x510) % 8 == 0 ? events : tasks)[(offset - 0x510) / 8] = value;
    else
      tests::no_register(kPpi + offset);
  }
  void write_timer(std::uintptr_t offset, std::uint32_t value) {
    if (offset == 0x000) {
      runs = true;
    } else if (offset >= 0x040 && offset < 0x058) {
      values[(offset - 0x040) / 4] = count();
    } else if (offset == 0x508) {
      bits = value;
    } else if (offset == 0x510) {
      prescaler = value;
    } else if (offset >= 0x540 && offset < 0x558) {
      values[(offset - 0x540) / 4] = value;
    } else {
      tests::no_register(kTimer + offset);
    }
  }
  std::uint32_t count() const {
    tests::demand(bits == 3 && prescaler == 4, "a count is not 1 us");
    return counted;
  }
  void happens(std::uintptr_t event) {
    for (unsigned i = 0; i < events.size(); ++i)
      if ((joined >> i & 1) != 0 && events[i] == event) write(tasks[i], 1);
  }
  void set(std::uint16_t pin, bool high) {
    const auto [port, bit] = pins.at(pin);
    const bool was = level_of[pin];
    level_of[pin] = high;
    wire(pins.at(pin), high);
    for (unsigned channel = 0; channel < configured.size() && was != high; ++channel) {
      const std::uint32_t it = configured[channel];
      if ((it & 3) != 1 || (it >> 8 & 0x3F) != (port << 5 | bit) ||
          (it >> 16 & (high ? 1U : 2U)) == 0)
        continue;
      edges[channel] = 1;
      happens(kGpiote + 0x100 + 4 * channel);
    }
  }
  bool asks() const {
    for (unsigned channel = 0; channel < edges.size(); ++channel)
      if (edges[channel] != 0 && (enabled >> channel & 1) != 0) return true;
    return false;
  }
  void interrupt() {
    for (unsigned i = 0; i < 8 && asks(); ++i, ++interrupts)
      boards::microbit::echoes::on_edge();
    CHECK_FALSE(asks());
  }
  void pass_one() {
    pass_microsecond();
    if (runs) ++counted;
    for (unsigned channel = 0; channel < values.size(); ++channel)
      if (runs && values[channel] == counted) happens(kTimer + 0x140 + 4 * channel);
  }
  bool is_triggered(std::uint16_t number) const {
    const auto [port, bit] = pins.at(number);
    for (unsigned channel = 0; channel < configured.size(); ++channel)
      if ((configured[channel] & 3) == 3 && (configured[channel] >> 8 & 0x3F) == (port << 5 | bit))
        return driven[channel];
    return level(pins.at(number)) == Level::high;
  }

  std::array<std::uint32_t, 8> edges{}, configured{};
  std::array<bool, 8> driven{};
  std::array<std::uint32_t, 6> values{};
  std::array<std::uintptr_t, 20> events{}, tasks{};
  std::uint32_t enabled = 0, joined = 0, bits = 0, prescaler = 4, counted = 0xFFFF'F000;
  bool runs = false;
  std::map<std::uint16_t, bool> level_of;
  unsigned interrupts = 0;
};

// A wire changes, and the processor takes the interrupt immediately, or `late`.
template <typename Chip>
void set_wire(Chip& chip, bool high, std::uint16_t pin = Chip::kEcho) {
  chip.set(pin, high);
  chip.interrupt();
}

template <typename Chip>
void let_pass(Chip& chip, unsigned us) {
  while (us-- > 0)
    chip.pass_one();
}

template <typename Chip>
void send_echo(Chip& chip, unsigned us) {
  let_pass(chip, 450);
  set_wire(chip, true);
  let_pass(chip, us);
  set_wire(chip, false);
}

}  // namespace

TEMPLATE_TEST_CASE("echo: one pulse of 10 us or a little more, whenever it is asked for", "",
                   EdgesOfL475, EdgesOfMicrobit) {
  // Different places in the frame of the pin's pulses; the last ones are at its end.
  for (const unsigned before :
       {0U, 100U, 10'000U, 19'970U, 19'980U, 19'988U, 19'992U, 19'996U, 19'999U}) {
    TestType chip;
    let_pass(chip, before);
    CHECK_FALSE(chip.is_triggered(TestType::kTrigger));
    TestType::ping(TestType::kTrigger, TestType::kEcho);
    unsigned high = 0, begins = 0;
    for (unsigned us = 0; us < 45'000; ++us) {
      const bool was = chip.is_triggered(TestType::kTrigger);
      if (chip.is_triggered(TestType::kOtherTrigger)) FAIL("another pin");
      high += was ? 1U : 0U;
      chip.pass_one();
      begins += !was && chip.is_triggered(TestType::kTrigger) ? 1U : 0U;
    }
    CAPTURE(before);
    CHECK(high >= 11);
    CHECK(high <= 12);
    CHECK(begins == 0);  // the pulse began immediately, and there is no second one
  }
}

TEMPLATE_TEST_CASE("echo: how long the pin is high is measured, by two interrupts", "", EdgesOfL475,
                   EdgesOfMicrobit) {
  TestType chip;
  for (const unsigned us : {1U, 117U, 5831U, 23'324U, 38'000U}) {
    const unsigned before = chip.interrupts;
    TestType::ping(TestType::kTrigger, TestType::kEcho);
    send_echo(chip, us);
    let_pass(chip, 100);
    CHECK(TestType::take(TestType::kEcho) == us);
    CHECK(TestType::take(TestType::kEcho) == us);  // of another channel of the sensor
    CHECK(chip.interrupts == before + 2);
  }
}

TEMPLATE_TEST_CASE(
    "echo: nothing is measured of a pin that does not rise, or does not fall, or was high", "",
    EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  send_echo(chip, 1000);
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  let_pass(chip, 40'000);
  CHECK(TestType::take(TestType::kEcho) == 0);  // not the earlier result either
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  let_pass(chip, 500);
  set_wire(chip, true);
  let_pass(chip, 39'500);
  CHECK(TestType::take(TestType::kEcho) == 0);
  const unsigned before = chip.interrupts;
  set_wire(chip, false);  // late
  CHECK(TestType::take(TestType::kEcho) == 0);
  set_wire(chip, true);
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  let_pass(chip, 500);
  set_wire(chip, false);
  let_pass(chip, 500);
  send_echo(chip, 700);
  CHECK(TestType::take(TestType::kEcho) == 0);
  CHECK(chip.interrupts == before);
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  send_echo(chip, 700);
  CHECK(TestType::take(TestType::kEcho) == 700);
}

TEMPLATE_TEST_CASE(
    "echo: however often the pin changes, it interrupts twice in a measurement, and else never", "",
    EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  std::mt19937 random(4);
  const auto storm = [&] {
    for (unsigned i = 0; i < 2001; ++i) {
      let_pass(chip, random() % 4);
      set_wire(chip, i % 2 == 0);
    }
  };
  storm();
  set_wire(chip, false);
  CHECK(chip.interrupts == 0);
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  storm();
  CHECK(chip.interrupts == 2);
  set_wire(chip, false);
  CHECK(TestType::take(TestType::kEcho) <= 4);  // noise: no echo is that short
  storm();
  CHECK(chip.interrupts == 2);
  set_wire(chip, false);
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  send_echo(chip, 900);
  CHECK(TestType::take(TestType::kEcho) == 900);
}

TEMPLATE_TEST_CASE("echo: edges that the processor comes to late give no wrong length", "",
                   EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  for (const bool high : {true, false})
    chip.set(TestType::kEcho, high);  // both edges, before the processor handles one
  chip.interrupt();
  CHECK(TestType::take(TestType::kEcho) == 0);
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  set_wire(chip, true);
  let_pass(chip, 300);
  for (const bool high : {false, true})
    chip.set(TestType::kEcho, high);
  chip.interrupt();
  set_wire(chip, false);
  CHECK(TestType::take(TestType::kEcho) == 0);
}

TEMPLATE_TEST_CASE("echo: two sensors measure at the same time", "", EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  let_pass(chip, 30);
  TestType::ping(TestType::kOtherTrigger, TestType::kOther);
  CHECK(chip.is_triggered(TestType::kOtherTrigger));
  CHECK_FALSE(chip.is_triggered(TestType::kTrigger));
  let_pass(chip, 400);
  set_wire(chip, true);
  set_wire(chip, true, TestType::kOther);
  let_pass(chip, 1000);
  set_wire(chip, false, TestType::kOther);
  let_pass(chip, 2000);
  set_wire(chip, false);
  CHECK(TestType::take(TestType::kEcho) == 3000);
  CHECK(TestType::take(TestType::kOther) == 1000);
}

TEMPLATE_TEST_CASE("echo: a servo has the trigger pin when the sensor is gone", "", EdgesOfL475,
                   EdgesOfMicrobit) {
  TestType chip;
  const auto write = [](std::uint16_t pin, std::uint32_t us) {
    if constexpr (std::is_same_v<TestType, EdgesOfL475>)
      boards::stm32l4::pins::write(pin, us);
    else
      boards::microbit::pins::write(pin, us);
  };
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  let_pass(chip, 50);
  TestType::take(TestType::kEcho);
  write(TestType::kTrigger, 1500);
  let_pass(chip, 60'000);
  unsigned high = 0;
  for (unsigned us = 0; us < 20'000; ++us, chip.pass_one())
    high += chip.is_triggered(TestType::kTrigger) ? 1U : 0U;
  CHECK(high == 1500);
}

TEST_CASE(
    "echo: microbit: three sensors measure at the same time, and no other pin is one's echo") {
  EdgesOfMicrobit chip;
  const std::map<std::uint16_t, std::uint16_t> triggers{{5, 0}, {11, 14}, {8, 13}};
  for (const auto& [echo, trigger] : triggers) {
    EdgesOfMicrobit::ping(trigger, echo);
    CHECK(chip.is_triggered(trigger));
    let_pass(chip, 30);
    CHECK_FALSE(chip.is_triggered(trigger));
  }
  for (const auto& [echo, trigger] : triggers)
    set_wire(chip, true, echo);
  for (const auto& [echo, trigger] : triggers) {
    let_pass(chip, 500);
    set_wire(chip, false, echo);
  }
  CHECK(EdgesOfMicrobit::take(5) == 500);
  CHECK(EdgesOfMicrobit::take(8) == 1000);
  CHECK(EdgesOfMicrobit::take(11) == 1500);
  const auto is_one = [](std::uint16_t pin) { return pin == 5 || pin == 8 || pin == 11; };
  for (std::uint16_t pin = 0; pin < 70; ++pin) {
    CAPTURE(pin);
    if (is_one(pin)) continue;
    EdgesOfMicrobit::ping(0, pin);
    CHECK_FALSE(chip.is_triggered(0));
    CHECK(EdgesOfMicrobit::take(pin) == 0);
  }
}

namespace {

constexpr unsigned kMost = 50;

// Both wires of an encoder, a turn at a time: A is ahead of B by a quarter of a pulse, or behind it.
template <typename Chip>
struct Wheel {
  explicit Wheel(Chip& of, unsigned number_of = 0) : chip(of), number(number_of) {
    chip.set(Chip::kOther, false);
    chip.set(Chip::kEcho, false);
    REQUIRE(take());
    REQUIRE(turned.begun);
  }
  ~Wheel() { Chip::end_edges(number); }
  bool take(unsigned most = kMost) {
    return chip.take_edges(number, Chip::kEcho, static_cast<std::uint8_t>(Chip::kOther), most,
                           turned);
  }
  void turn(bool forward, unsigned us = 10) {
    for (const bool high : {true, false}) {
      set_wire(chip, high, forward ? Chip::kEcho : Chip::kOther);
      let_pass(chip, us);
      set_wire(chip, high, forward ? Chip::kOther : Chip::kEcho);
      let_pass(chip, us);
    }
  }
  Chip& chip;
  unsigned number;
  boards::Turned turned{};
};

}  // namespace

TEMPLATE_TEST_CASE("edges: with two pins they count forward or back, with the time of the last", "",
                   EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  Wheel<TestType> wheel(chip);
  CHECK(wheel.turned.edges == 0);
  for (unsigned i = 0; i < 20; ++i)
    wheel.turn(true);
  let_pass(chip, 70);
  REQUIRE(wheel.take());
  CHECK_FALSE(wheel.turned.begun);
  CHECK(wheel.turned.edges == 40);
  CHECK(wheel.turned.ago == 90);  // the last edge of A, B followed 10 us later
  for (unsigned i = 0; i < 23; ++i)
    wheel.turn(false);
  REQUIRE(wheel.take());
  CHECK(wheel.turned.edges == -6);
  CHECK(chip.interrupts == 86);
  // It trembles at an edge of A: back and forth.
  for (unsigned i = 0; i < 10; ++i) {
    set_wire(chip, true);
    set_wire(chip, false);
  }
  REQUIRE(wheel.take());
  CHECK(wheel.turned.edges == -6);
}

TEMPLATE_TEST_CASE("edges: with one pin all count forward, and only those from the beginning on",
                   "", EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  boards::Turned turned{};
  const auto take = [&] {
    return chip.take_edges(1, TestType::kEcho, vm::kNoSecondPin, kMost, turned);
  };
  for (const bool high : {true, false, true})
    set_wire(chip, high);
  for (unsigned program = 0; program < 2; ++program) {
    REQUIRE(take());
    CHECK(turned.begun);
    CHECK(turned.edges == 0);
    const unsigned before = chip.interrupts;
    for (unsigned i = 0; i < 7; ++i)
      set_wire(chip, i % 2 != 0);
    REQUIRE(take());
    CHECK_FALSE(turned.begun);
    CHECK(turned.edges == 7);
    CHECK(chip.interrupts == before + 7);
    TestType::end_edges(1);
    for (unsigned i = 0; i < 7; ++i)
      set_wire(chip, i % 2 == 0);
    CHECK(chip.interrupts == before + 7);
  }
  CHECK_FALSE(chip.take_edges(0, 77, vm::kNoSecondPin, kMost, turned));
}

TEMPLATE_TEST_CASE("edges: as many as were allowed interrupt, whatever the wire does, and one more",
                   "", EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  Wheel<TestType> wheel(chip);
  for (unsigned period = 0; period < 3; ++period) {
    const unsigned before = chip.interrupts;
    for (unsigned i = 0; i < 2000; ++i)
      wheel.turn(true, 1);
    CHECK(chip.interrupts <= before + kMost + 1);
    CHECK_FALSE(wheel.take());
  }
  const std::int32_t counted = wheel.turned.edges;
  for (unsigned i = 0; i < kMost / 2; ++i)
    wheel.turn(true);
  CHECK(wheel.take());
  CHECK(std::abs(wheel.turned.edges - counted - static_cast<int>(kMost)) <= 1);
}

TEMPLATE_TEST_CASE(
    "edges: what is counted so far is known between two takes, and how often some were lost", "",
    EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  CHECK(TestType::so_far(1).edges == 0);
  {
    Wheel<TestType> wheel(chip, 1);
    for (unsigned i = 0; i < 10; ++i)
      wheel.turn(true);
    CHECK(TestType::so_far(1).edges == 20);
    CHECK(TestType::so_far(0).edges == 0);
    for (std::uint8_t lost = 0; lost < 3; ++lost) {
      CHECK(TestType::so_far(1).losses == lost);
      for (unsigned i = 0; i < kMost; ++i)
        wheel.turn(false);
      CHECK(TestType::so_far(1).losses == lost + 1);
      const std::int32_t counted = TestType::so_far(1).edges;
      CHECK_FALSE(wheel.take());
      CHECK(wheel.turned.edges == counted);
    }
    wheel.turn(true);
    CHECK(wheel.take());
    CHECK(TestType::so_far(1).losses == 3);
  }
  CHECK(TestType::so_far(1).edges == 0);
  Wheel<TestType> again(chip, 1);
  CHECK(TestType::so_far(1).edges == 0);
  CHECK(TestType::so_far(1).losses == 0);
}

TEMPLATE_TEST_CASE("edges: an echo is measured meanwhile, and two encoders count at once", "",
                   EdgesOfL475, EdgesOfMicrobit) {
  TestType chip;
  boards::Turned left{}, right{};
  const auto take = [&] {
    CHECK(chip.take_edges(0, TestType::kOther, vm::kNoSecondPin, kMost, left));
    return chip.take_edges(1, TestType::kEcho, vm::kNoSecondPin, kMost, right);
  };
  chip.set(TestType::kOther, false);
  CHECK(chip.take_edges(0, TestType::kOther, vm::kNoSecondPin, kMost, left));
  TestType::ping(TestType::kTrigger, TestType::kEcho);
  send_echo(chip, 600);
  set_wire(chip, true, TestType::kOther);
  CHECK(TestType::take(TestType::kEcho) == 600);
  REQUIRE(take());
  CHECK(left.edges == 1);
  for (unsigned i = 0; i < 6; ++i) {
    set_wire(chip, i % 2 == 0);
    if (i < 3) set_wire(chip, i % 2 != 0, TestType::kOther);
  }
  REQUIRE(take());
  CHECK(left.edges == 4);
  CHECK(right.edges == 6);
  for (const unsigned number : {0U, 1U})
    TestType::end_edges(number);
}
