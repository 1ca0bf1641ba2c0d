// The I2C buses of the micro:bit V2, as they are shipped, against the model of their master: what is asked for is there in
// time and costs one interrupt, and whatever the device does, nobody waits for it.
#include <array>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/i2c.hpp"
#include "tests/runtime-m4/boards/nrf52833_twim.hpp"

using namespace robosync;
using boards::microbit::I2c;

namespace {

constexpr std::byte operator""_b(unsigned long long value) {
  return static_cast<std::byte>(value);
}

// Nordic: TWIM0; tech.microbit.org: the internal bus is P0.08 and P0.16.
struct Bus : tests::TwimBus {
  Bus() : TwimBus(0x4000'3000, {0, 8}, {0, 16}) {
    bus.start();
    for (unsigned i = 0; i < registers.size(); ++i)
      registers[i] = static_cast<std::byte>(i ^ 0x5A);
  }
  void run(unsigned microseconds) {
    for (; microseconds > 0; --microseconds) {
      pass_microsecond();
      for (unsigned i = 0; interrupt(); ++i) {
        REQUIRE(i < 3);
        ++interrupts;
        bus.on_end();
      }
    }
  }
  bool ask(std::byte from, std::size_t count = 3, std::uint8_t who = 0x19) {
    return bus.transfer(true, who, std::array{from}, std::span(got).first(count));
  }
  bool collect(std::byte from, std::size_t count = 3, std::uint8_t who = 0x19) {
    got.fill(0_b);
    return bus.transfer(false, who, std::array{from}, std::span(got).first(count));
  }
  bool put(bool ahead, std::byte to, std::byte value) {
    return bus.transfer(ahead, 0x19, std::array{to, value}, {});
  }
  bool got_from(unsigned first, std::size_t count = 3) const {
    for (std::size_t i = 0; i < count; ++i)
      if (got[i] != registers[first + i]) return false;
    return true;
  }

  I2c bus{boards::microbit::kTwim0, {.clock = {0, 8}, .data = {0, 16}}};
  std::array<std::byte, 16> got{};
  unsigned interrupts = 0;
};

}  // namespace

TEST_CASE("a bus: what is asked ahead is there before a millisecond is over, by one interrupt") {
  Bus bus;
  for (unsigned round = 0; round < 3; ++round) {
    CHECK_FALSE(bus.ask(0xA0_b, 14));
    CHECK(bus.bus.is_busy());
    bus.run(450);
    CHECK_FALSE(bus.bus.is_busy());
    CHECK(bus.interrupts == round + 1);
    CHECK(bus.collect(0xA0_b, 14));
    CHECK(bus.got_from(0x20, 14));
    bus.registers[0x20 + round] = 0x77_b;
  }
  CHECK(bus.written == std::vector(3, std::vector{0xA0_b}));
  CHECK(bus.bus.state().clears == 0);
}

TEST_CASE("a bus: who wants the same gets it together, others one after the other") {
  Bus bus;
  for (const std::byte from : {0x10_b, 0x10_b, 0x30_b, 0x10_b, 0x20_b})
    CHECK_FALSE(bus.ask(from));
  bus.run(600);
  CHECK(bus.written == std::vector{std::vector{0x10_b}, std::vector{0x30_b}, std::vector{0x20_b}});
  for (unsigned times = 0; times < 3; ++times) {
    CHECK(bus.collect(0x10_b));
    CHECK(bus.got_from(0x10));
  }
  CHECK(bus.collect(0x30_b));
  CHECK(bus.got_from(0x30));
  CHECK_FALSE(bus.collect(0x31_b));  // nobody has asked for it
  CHECK_FALSE(bus.collect(0x30_b, 2));
}

TEST_CASE("a bus: what is asked anew is read anew, and is not there before") {
  Bus bus;
  bus.ask(0x10_b);
  bus.run(300);
  bus.registers[0x10] = 0x01_b;
  bus.ask(0x10_b);
  CHECK_FALSE(bus.collect(0x10_b));  // it is given up
  bus.ask(0x10_b);
  bus.run(300);
  CHECK(bus.collect(0x10_b));
  CHECK(bus.got_from(0x10));
}

TEST_CASE("a bus: what is written goes out in its order, asked ahead or not") {
  Bus bus;
  CHECK(bus.put(true, 0x20_b, 0x99_b));
  CHECK_FALSE(bus.ask(0x20_b, 1));
  bus.run(400);
  CHECK(bus.put(false, 0x20_b, 0x99_b));  // how it went
  CHECK(bus.collect(0x20_b, 1));
  CHECK(bus.got[0] == 0x99_b);
  CHECK(bus.written.size() == 2);
  for (unsigned times = 0; times < 3; ++times)
    CHECK(bus.put(false, 0x21_b, 0x98_b));  // by several channels
  bus.run(200);
  CHECK(bus.registers[0x21] == 0x98_b);
  CHECK(bus.written.size() == 3);
}

TEST_CASE(
    "a bus: nobody there, or one who refuses a byte, is a transfer that failed, and no more") {
  Bus bus;
  bus.ask(0x10_b, 3, 0x33);
  bus.ask(0x10_b);
  bus.run(500);
  CHECK_FALSE(bus.collect(0x10_b, 3, 0x33));
  CHECK(bus.collect(0x10_b));
  bus.refuses_after = 0;
  bus.ask(0x10_b);
  bus.run(500);
  CHECK_FALSE(bus.bus.is_busy());
  CHECK_FALSE(bus.collect(0x10_b));
  bus.refuses_after = ~0U;
  bus.ask(0x10_b);
  bus.run(500);
  CHECK(bus.collect(0x10_b));
  CHECK(bus.bus.state().held == 0);
}

TEST_CASE(
    "a bus: a device that gains time by the clock gets it; one that never lets go is given up") {
  Bus bus;
  bus.ask(0x10_b);
  bus.run(50);
  bus.holds_clock = true;
  bus.run(700);
  bus.holds_clock = false;
  bus.run(300);
  CHECK(bus.collect(0x10_b));
  bus.ask(0x10_b);
  bus.run(50);
  bus.holds_clock = true;
  bus.run(3000);
  CHECK(bus.bus.is_busy());
  CHECK_FALSE(bus.collect(0x10_b));
  CHECK_FALSE(bus.bus.is_busy());
  CHECK_FALSE(bus.ask(0x10_b));
  CHECK_FALSE(bus.bus.is_busy());  // nobody tries while it is held
  CHECK_FALSE(bus.collect(0x10_b));
  CHECK(bus.bus.state().held == 1);
  CHECK(bus.clocks == 0);
  bus.holds_clock = false;
  bus.ask(0x10_b);
  bus.run(300);
  CHECK(bus.collect(0x10_b));
  CHECK(bus.bus.state().held == 0);
}

TEST_CASE("a bus: a write that hangs, which nobody asks about, holds up no reading for good") {
  Bus bus;
  bus.put(false, 0x20_b, 1_b);
  bus.run(40);
  bus.holds_clock = true;
  bus.ask(0x10_b);
  bus.run(3000);
  CHECK(bus.bus.is_busy());
  CHECK_FALSE(bus.collect(0x10_b));
  CHECK_FALSE(bus.bus.is_busy());
  bus.holds_clock = false;
  bus.ask(0x10_b);
  bus.run(300);
  CHECK(bus.collect(0x10_b));
}

TEST_CASE("a bus: a data line that is held down gets clocks until it is free, nine at most") {
  for (unsigned clocks = 1; clocks <= 12; ++clocks) {
    Bus bus;
    bus.holds_data = clocks;
    bus.ask(0x10_b);
    CHECK(bus.clocks == std::min(clocks, 9U));
    CHECK(bus.is_on());
    bus.run(300);
    CHECK(bus.collect(0x10_b) == (clocks <= 9));
    CHECK(bus.bus.state().held == (clocks <= 9 ? 0 : 1));
    CHECK(bus.bus.state().clears == 1);
    bus.ask(0x10_b);  // the rest of them
    bus.run(300);
    CHECK(bus.collect(0x10_b));
    CHECK(bus.bus.state().clears == 1);
  }
}

TEST_CASE("a bus: what is too long is refused, and too many requests leave those that run alone") {
  Bus bus;
  std::array<std::byte, 17> long_in{};
  CHECK_FALSE(bus.bus.transfer(true, 0x19, std::array{1_b}, long_in));
  CHECK_FALSE(bus.bus.transfer(true, 0x19, std::array<std::byte, 20>{}, {}));
  CHECK_FALSE(bus.bus.transfer(true, 0x19, {}, std::span(long_in).first(2)));
  CHECK_FALSE(bus.bus.is_busy());
  for (unsigned i = 0; i < 8; ++i)
    bus.ask(static_cast<std::byte>(i));
  bus.run(3000);
  for (unsigned i = 0; i < 8; ++i)
    CHECK(bus.collect(static_cast<std::byte>(i)) == (i < 6));
  for (unsigned i = 6; i < 8; ++i)  // what nobody asked about for the longest time gives way
    bus.ask(static_cast<std::byte>(i));
  bus.run(1000);
  for (unsigned i = 0; i < 8; ++i)
    CHECK(bus.collect(static_cast<std::byte>(i)) == (i >= 2));
}
