// The shipped I2C code of the boards, against models of their masters: results are ready in time and cost an interrupt or two,
// and whatever the device does, no thread waits for it.
#include <array>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/i2c.hpp"
#include "runtime-m4/boards/stm32l4/i2c.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "tests/runtime-m4/boards/board_costs.hpp"
#include "tests/runtime-m4/boards/nrf52833_twim.hpp"
#include "tests/runtime-m4/boards/stm32_i2c.hpp"

using namespace robosync;

namespace {

constexpr std::byte operator""_b(unsigned long long value) {
  return static_cast<std::byte>(value);
}

// Nordic: TWIM0; tech.microbit.org: the internal bus is P0.08 and P0.16.
struct MicrobitBus : tests::TwimBus {
  static constexpr const policy::BoardCosts& kCosts = tests::kMicrobitCosts;
  static constexpr unsigned kInterrupts = 1;  // for a read
  MicrobitBus() : TwimBus(0x4000'3000, {0, 8}, {0, 16}) {}
  boards::microbit::I2c bus{{boards::microbit::kTwim0, {.clock = {0, 8}, .data = {0, 16}}}};
};

// RM0351: I2C1 and I2C2 with their requests of DMA1; UM2153: PB8 and PB9 are D15 and D14, PB10 and PB11 the sensors' on the board.
template <unsigned kNumber>
struct L475Bus : tests::Stm32I2c {
  static constexpr const policy::BoardCosts& kCosts = tests::kL475Costs;
  static constexpr unsigned kInterrupts = 2;  // one after the request, one after the answer
  static constexpr bool kOwn = kNumber == 2;
  L475Bus()
      : Stm32I2c(kOwn ? Wiring{0x4000'5800, 1U << 22, 10, 11, 4, 5}
                      : Wiring{0x4000'5400, 1U << 21, 8, 9, 6, 7}) {}
  boards::stm32l4::I2c bus{boards::stm32l4::i2c_master(kOwn ? 1 : 0)};
};

// A device with pages: the value of one register depends on the other.
constexpr std::byte kPage = 0x00_b;
constexpr std::byte kPaged = 0x0B_b;
constexpr std::byte kPageMark = 0x40_b;

template <typename Model>
struct Bus : Model {
  Bus() {
    this->bus.start();
    for (unsigned i = 0; i < this->registers.size(); ++i)
      this->registers[i] = static_cast<std::byte>(i ^ 0x5A);
  }
  // The processor takes each interrupt `latency` microseconds late.
  void run(unsigned microseconds, unsigned latency = 0) {
    unsigned waits = 0;
    for (; microseconds > 0; --microseconds) {
      this->pass_microsecond();
      at(kPaged) = at(kPage) ^ kPageMark;
      if (this->interrupt() && waits++ < latency) continue;
      waits = 0;
      for (unsigned i = 0; this->interrupt(); ++i) {
        REQUIRE(i < 3);
        ++interrupts;
        this->bus.on_interrupt();
      }
    }
  }
  std::byte& at(std::byte number) { return this->registers[std::to_integer<unsigned>(number)]; }
  void select(std::byte page) { CHECK(this->bus.select(std::array{kPage, page})); }
  std::uint8_t device() const { return static_cast<std::uint8_t>(this->address); }
  bool ask(std::byte from, std::size_t count = 3) { return ask_of(device(), from, count); }
  bool ask_of(std::uint8_t who, std::byte from, std::size_t count = 3) {
    return this->bus.transfer(true, who, std::array{from}, std::span(got).first(count));
  }
  bool collect(std::byte from, std::size_t count = 3) { return collect_of(device(), from, count); }
  bool collect_of(std::uint8_t who, std::byte from, std::size_t count = 3) {
    got.fill(0_b);
    return this->bus.transfer(false, who, std::array{from}, std::span(got).first(count));
  }
  // From the same device: three registers, and then ten.
  bool two(bool ahead, std::byte first, std::byte second) {
    if (!ahead) got.fill(0_b);
    return this->bus.read_two(ahead, device(), {first, second, 3}, std::span(got).first(13));
  }
  bool put(bool ahead, std::byte to, std::byte value) {
    return this->bus.transfer(ahead, device(), std::array{to, value}, {});
  }
  bool got_from(unsigned first, std::size_t count = 3) const {
    for (std::size_t i = 0; i < count; ++i)
      if (got[i] != this->registers[first + i]) return false;
    return true;
  }

  std::array<std::byte, 16> got{};
  unsigned interrupts = 0;
};

}  // namespace

TEMPLATE_TEST_CASE(
    "a bus: what is asked ahead is there before a millisecond is over, by an interrupt or two", "",
    MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  for (unsigned round = 0; round < 3; ++round) {
    CHECK_FALSE(bus.ask(0xA0_b, 14));
    CHECK(bus.bus.is_busy());
    bus.run(450);
    CHECK_FALSE(bus.bus.is_busy());
    CHECK(bus.interrupts == bus.kInterrupts * (round + 1));
    CHECK(bus.collect(0xA0_b, 14));
    CHECK(bus.got_from(0x20, 14));
    bus.registers[0x20 + round] = 0x77_b;
  }
  CHECK(bus.written == std::vector(3, std::vector{0xA0_b}));
  CHECK(bus.bus.state().clears == 0);
}

TEMPLATE_TEST_CASE("a bus: who wants the same gets it together, others one after the other", "",
                   MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
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
  CHECK_FALSE(bus.collect(0x31_b));  // was not asked for
  CHECK_FALSE(bus.collect(0x30_b, 2));
}

TEMPLATE_TEST_CASE("a bus: what is asked anew is read anew, and is not there before", "",
                   MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
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

TEMPLATE_TEST_CASE("a bus: what is written goes out in its order, asked ahead or not", "",
                   MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
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

TEST_CASE("micro:bit: a read that a stray stop ends early has failed, and the next one works") {
  for (const unsigned bytes : {0U, 1U, 2U}) {
    CAPTURE(bytes);
    Bus<MicrobitBus> bus;
    bus.stops_after = bytes;
    bus.ask(0x10_b);
    bus.run(500);
    CHECK_FALSE(bus.bus.is_busy());
    CHECK_FALSE(bus.collect(0x10_b));
    bus.stops_after = ~0U;
    bus.ask(0x30_b);
    bus.run(500);
    CHECK(bus.collect(0x30_b));
    CHECK(bus.got_from(0x30));
  }
}

TEMPLATE_TEST_CASE(
    "a bus: nobody there, or one who refuses a byte, is a transfer that failed, and no more", "",
    MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  bus.ask_of(0x33, 0x10_b);
  bus.ask(0x10_b);
  bus.run(500);
  CHECK_FALSE(bus.collect_of(0x33, 0x10_b));
  CHECK(bus.collect(0x10_b));
  bus.refuses_after = 0;
  bus.ask(0x10_b);
  bus.run(500);
  CHECK_FALSE(bus.bus.is_busy());
  CHECK_FALSE(bus.collect(0x10_b));
  bus.refuses_after = ~0U;
  bus.ask(0x30_b);  // nothing is left of the refused transfer
  bus.run(500);
  CHECK(bus.collect(0x30_b));
  CHECK(bus.got_from(0x30));
  CHECK(bus.written.back() == std::vector{0x30_b});
  CHECK(bus.bus.state().held == 0);
}

TEMPLATE_TEST_CASE(
    "a bus: a device that gains time by the clock gets it; one that never lets go is given up", "",
    MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
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
  CHECK_FALSE(bus.bus.is_busy());  // no transfer begins while the line is held
  CHECK_FALSE(bus.collect(0x10_b));
  CHECK(bus.bus.state().held == 1);
  CHECK(bus.clocks == 0);
  bus.holds_clock = false;
  bus.ask(0x10_b);
  bus.run(300);
  CHECK(bus.collect(0x10_b));
  CHECK(bus.bus.state().held == 0);
}

TEMPLATE_TEST_CASE(
    "a bus: a write that hangs, which nobody asks about, holds up no reading for good", "",
    MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
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

TEMPLATE_TEST_CASE(
    "a bus: a data line that is held down gets clocks until it is free, nine at most", "",
    MicrobitBus, L475Bus<1>, L475Bus<2>) {
  for (unsigned clocks = 1; clocks <= 12; ++clocks) {
    Bus<TestType> bus;
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

TEMPLATE_TEST_CASE(
    "a bus: what is too long is refused, and too many requests leave those that run alone", "",
    MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  std::array<std::byte, 19> long_in{};  // with what is written, one too many
  CHECK_FALSE(bus.bus.transfer(true, bus.device(), std::array{1_b}, long_in));
  CHECK_FALSE(bus.bus.transfer(true, bus.device(), std::array<std::byte, 20>{}, {}));
  CHECK_FALSE(bus.bus.transfer(true, bus.device(), {}, std::span(long_in).first(2)));
  CHECK_FALSE(bus.bus.is_busy());
  constexpr unsigned kMost = decltype(bus.bus)::kMostRequests;
  for (unsigned i = 0; i < kMost + 2; ++i)
    bus.ask(static_cast<std::byte>(i));
  bus.run(5000);
  for (unsigned i = 0; i < kMost + 2; ++i)
    CHECK(bus.collect(static_cast<std::byte>(i)) == (i < kMost));
  for (unsigned i = kMost; i < kMost + 2; ++i)  // replaces the requests asked the longest time ago
    bus.ask(static_cast<std::byte>(i));
  bus.run(1000);
  for (unsigned i = 0; i < kMost + 2; ++i)
    CHECK(bus.collect(static_cast<std::byte>(i)) == (i >= 2));
}

TEMPLATE_TEST_CASE("a bus: however much is written, a result waits until it is taken", "",
                   MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  bus.ask(0x10_b);
  bus.run(300);
  for (unsigned i = 0; i <= decltype(bus.bus)::kMostRequests; ++i) {
    CHECK(bus.put(false, 0x20_b, static_cast<std::byte>(i)));
    bus.run(300);
  }
  CHECK(bus.collect(0x10_b));
}

TEMPLATE_TEST_CASE("a bus: of a device with pages each reading is of its own page", "", MicrobitBus,
                   L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  const auto read = [&](bool ahead, std::byte page) {
    bus.select(page);
    return ahead ? bus.ask(kPaged, 1) : bus.collect(kPaged, 1);
  };
  for (unsigned round = 0; round < 2; ++round) {
    bus.written.clear();
    for (const std::byte page : {3_b, 1_b, 7_b, 3_b})
      CHECK_FALSE(read(true, page));
    bus.run(2000);
    CHECK(bus.written.size() == 6);
    for (const std::byte page : {1_b, 7_b, 3_b, 1_b}) {
      CHECK(read(false, page));
      CHECK(bus.got[0] == (page ^ kPageMark));
    }
  }
  CHECK_FALSE(bus.collect(kPaged, 1));  // was not asked for without a page
  CHECK_FALSE(read(false, 2_b));
  bus.refuses_after = 1;  // the page is not taken, so nothing is read
  read(true, 3_b);
  bus.run(500);
  bus.refuses_after = ~0U;
  CHECK_FALSE(bus.bus.is_busy());
  CHECK_FALSE(read(false, 3_b));
  const std::array<std::byte, boards::kMostSelected + 1> too_long{};
  CHECK_FALSE(bus.bus.select(too_long));
}

TEMPLATE_TEST_CASE("a bus: two blocks of registers are one request, and nobody comes between them",
                   "", MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  for (unsigned round = 0; round < 2; ++round) {
    bus.written.clear();
    CHECK_FALSE(bus.two(true, 0x10_b, 0x22_b));
    CHECK_FALSE(bus.ask(0x30_b));
    CHECK_FALSE(bus.two(true, 0x10_b, 0x28_b));  // only the second block differs
    bus.run(2000);
    CHECK(bus.written == std::vector{std::vector{0x10_b}, std::vector{0x22_b}, std::vector{0x30_b},
                                     std::vector{0x10_b}, std::vector{0x28_b}});
    for (const unsigned second : {0x22U, 0x28U, 0x22U}) {
      CHECK(bus.two(false, 0x10_b, static_cast<std::byte>(second)));
      CHECK(std::equal(bus.got.begin(), bus.got.begin() + 3, bus.registers.begin() + 0x10));
      CHECK(std::equal(bus.got.begin() + 3, bus.got.begin() + 13, bus.registers.begin() + second));
    }
    bus.registers[0x11] ^= 0xFF_b;
    bus.registers[0x23] ^= 0xFF_b;
  }
  CHECK_FALSE(bus.two(false, 0x11_b, 0x22_b));  // was not asked for
  CHECK_FALSE(bus.collect(0x10_b));
  std::array<std::byte, 19> in{};
  CHECK_FALSE(bus.bus.read_two(true, bus.device(), {0x10_b, 0x22_b, 3}, in));
  CHECK_FALSE(bus.bus.read_two(true, bus.device(), {0x10_b, 0x22_b, 3}, std::span(in).first(3)));
  CHECK_FALSE(bus.bus.is_busy());
  CHECK_FALSE(bus.bus.read_two(true, bus.device(), {0x10_b, 0x22_b, 3}, std::span(in).first(18)));
  bus.run(1000);
  CHECK(bus.bus.read_two(false, bus.device(), {0x10_b, 0x22_b, 3}, std::span(in).first(18)));
  CHECK(in[17] == bus.registers[0x22 + 14]);
}

TEMPLATE_TEST_CASE("a bus: of two blocks either both are there or none", "", MicrobitBus,
                   L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  bus.refuses_after = 0;  // the first block is refused, so the second is not read
  bus.two(true, 0x10_b, 0x22_b);
  bus.run(1000);
  CHECK_FALSE(bus.bus.is_busy());
  CHECK_FALSE(bus.two(false, 0x10_b, 0x22_b));
  bus.refuses_after = ~0U;
  for (const unsigned after : {40U, 250U}) {  // in the first block, in the second
    CAPTURE(after);
    bus.written.clear();
    bus.two(true, 0x10_b, 0x22_b);
    bus.ask(0x30_b);
    bus.run(after);
    bus.holds_clock = true;
    bus.run(1000);
    bus.holds_clock = false;
    CHECK_FALSE(bus.two(false, 0x10_b, 0x22_b));  // is given up
    bus.run(400);
    CHECK(bus.written.back() == std::vector{0x30_b});
    CHECK(bus.collect(0x30_b));
    CHECK(bus.got_from(0x30));
    bus.two(true, 0x10_b, 0x22_b);
    bus.run(1000);
    CHECK(bus.two(false, 0x10_b, 0x22_b));
    CHECK(bus.got_from(0x10));
  }
}

TEMPLATE_TEST_CASE("a bus: a page whose selection is given up is not that of the next request", "",
                   MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  bus.select(3_b);
  bus.ask(kPaged, 1);
  bus.run(30);
  bus.holds_clock = true;
  bus.run(1000);
  bus.holds_clock = false;
  bus.select(3_b);
  CHECK_FALSE(bus.collect(kPaged, 1));
  bus.written.clear();
  bus.ask(0x30_b);
  bus.run(400);
  CHECK(bus.written == std::vector(1, std::vector{0x30_b}));
  CHECK(bus.collect(0x30_b));
  CHECK(bus.got_from(0x30));
}

// As one sensor stays silent while others change what they read.
TEMPLATE_TEST_CASE("a bus: whatever the order in which its users come, each gets its own answer",
                   "", MicrobitBus, L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  unsigned seed = 12;
  for (unsigned round = 0; round < 60; ++round) {
    std::vector<std::byte> asked;
    for (unsigned i = 0; i < 3; ++i) {
      seed = seed * 1103515245 + 12345;
      asked.push_back(static_cast<std::byte>(seed >> 16 & 0x1F));
      CHECK_FALSE(bus.ask(asked.back(), 1));
      if (round % 3 == 0) bus.put(false, 0x60_b, asked.back());
      if (round % 5 == 0) bus.ask_of(0x33, asked.back());
    }
    bus.run(2500);
    for (const unsigned i : {seed >> 18 & 1, 2U, 0U, 1U}) {
      CHECK(bus.collect(asked[i], 1));
      CHECK(bus.got_from(std::to_integer<unsigned>(asked[i]), 1));
    }
  }
}

TEMPLATE_TEST_CASE("a bus: what is written each time goes out each time", "", MicrobitBus,
                   L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  for (unsigned times = 1; times <= 3; ++times) {
    CHECK(bus.put(false, 0x20_b, 0x77_b));
    bus.run(300);
    CHECK(bus.written.size() == times);
  }
}

// With the boards' own figures, as in analysis/bus_load.cpp; each interrupt comes 12 us late.
TEMPLATE_TEST_CASE("a bus: what rsc lets be asked at once is there in time", "", MicrobitBus,
                   L475Bus<1>, L475Bus<2>) {
  const policy::BoardCosts& board = TestType::kCosts;
  const auto as_many_as_fit = [&](unsigned transfers, unsigned bytes) {
    return policy::bus_window_us(board.bus_ahead_ms) /
           (transfers * board.i2c_transfer_us + bytes * board.i2c_byte_us);
  };
  const auto check = [&](unsigned count, auto call) {
    Bus<TestType> bus;
    CAPTURE(count);
    REQUIRE(count <= decltype(bus.bus)::kMostRequests);
    for (unsigned i = 0; i < count; ++i)
      CHECK_FALSE(call(bus, true, static_cast<std::byte>(i)));
    bus.run(policy::bus_window_us(board.bus_ahead_ms), 12);
    for (unsigned i = 0; i < count; ++i)
      CHECK(call(bus, false, static_cast<std::byte>(i)));
  };
  const auto read = [](auto& bus, bool ahead, std::byte from, std::size_t bytes) {
    return ahead ? bus.ask(from, bytes) : bus.collect(from, bytes);
  };
  check(as_many_as_fit(1, 5),
        [&](auto& bus, bool ahead, std::byte i) { return read(bus, ahead, i, 2); });
  check(as_many_as_fit(1, 17),
        [&](auto& bus, bool ahead, std::byte i) { return read(bus, ahead, i, 14); });
  check(as_many_as_fit(2, 8), [&](auto& bus, bool ahead, std::byte i) {
    bus.select(i);
    return read(bus, ahead, kPaged, 2);
  });
}

TEMPLATE_TEST_CASE("STM32L475: a byte of a message that was refused is not the first of the next",
                   "", L475Bus<1>, L475Bus<2>) {
  Bus<TestType> bus;
  bus.refuses_after = 1;
  CHECK(bus.bus.transfer(true, bus.device(), std::array{0x20_b, 0x77_b, 0x78_b}, {}));
  bus.run(300);
  CHECK_FALSE(bus.bus.is_busy());
  CHECK_FALSE(bus.bus.transfer(false, bus.device(), std::array{0x20_b, 0x77_b, 0x78_b}, {}));
  bus.refuses_after = ~0U;
  CHECK(bus.put(true, 0x21_b, 0x99_b));
  bus.run(300);
  CHECK(bus.written.back() == std::vector{0x21_b, 0x99_b});
  CHECK(bus.registers[0x21] == 0x99_b);
}

TEMPLATE_TEST_CASE(
    "STM32L475: who loses the bus to another master has failed at once, and begins anew", "",
    L475Bus<1>, L475Bus<2>) {
  for (const unsigned after : {10U, 60U, 110U}) {
    Bus<TestType> bus;
    bus.ask(0x10_b);
    bus.ask(0x30_b);
    bus.run(after);
    bus.another_master = true;
    bus.run(400);
    CHECK_FALSE(bus.bus.is_busy());
    CHECK_FALSE(bus.collect(0x10_b));
    CHECK(bus.collect(0x30_b));
    CHECK(bus.got_from(0x30));
  }
}

TEMPLATE_TEST_CASE("STM32L475: a bus error that the master sees is none", "", L475Bus<1>,
                   L475Bus<2>) {
  Bus<TestType> bus;
  bus.ask(0x10_b);
  bus.run(30);
  bus.spurious_bus_error = true;
  bus.run(300);
  CHECK(bus.collect(0x10_b));
  CHECK(bus.got_from(0x10));
}

TEMPLATE_TEST_CASE("STM32L475: DMA that fails is a transfer that failed, and no more", "",
                   L475Bus<1>, L475Bus<2>) {
  // During the write, during the read, and at the last byte.
  for (const unsigned after : {10U, 70U, 130U}) {
    Bus<TestType> bus;
    bus.ask(0x10_b);
    bus.run(after);
    bus.dma_fails = true;
    bus.run(900);
    CHECK_FALSE(bus.collect(0x10_b));
    CHECK_FALSE(bus.bus.is_busy());
    bus.ask(0x30_b);
    bus.run(300);
    CHECK(bus.collect(0x30_b));
    CHECK(bus.got_from(0x30));
  }
}
