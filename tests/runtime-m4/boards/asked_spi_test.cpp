// The shipped SPI code of the boards, against models of their masters: results are ready in time and cost an interrupt each, a
// part is selected during its transfers only, and whatever the hardware does, no thread waits for it.
#include <array>
#include <optional>
#include <type_traits>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/player.hpp"
#include "runtime-m4/boards/microbit-v2/spi.hpp"
#include "runtime-m4/boards/stm32l4/inputs.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/spi.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "tests/runtime-m4/boards/board_costs.hpp"
#include "tests/runtime-m4/boards/spi_parts.hpp"

using namespace robosync;

namespace {

// Pin 16 is for an enable input, pin 2 an output.
struct Microbit : tests::SpimParts {
  static constexpr const policy::BoardCosts& kCosts = tests::kMicrobitCosts;
  static constexpr std::uint16_t kFirst = 16, kOther = 2;
  static constexpr unsigned kTransferUs = 24;
  Microbit() {
    boards::microbit::pins::start();
    boards::microbit::player::start();
  }
  static void switch_off() { boards::microbit::switch_spi_off(); }
  bool is_high(std::uint16_t pin) const {
    return level(pin == kFirst ? Pin{1, 2} : Pin{0, 4}) == Level::high;
  }

  boards::microbit::PartBus spi;
};

// Pin 45 is for an enable input, pin 10 an output.
struct L475 : tests::Stm32SpiParts {
  static constexpr const policy::BoardCosts& kCosts = tests::kL475Costs;
  static constexpr std::uint16_t kFirst = 45, kOther = 10;
  static constexpr unsigned kTransferUs = 39;
  L475() {
    write(0x4002'104C, 0xF);
    boards::stm32l4::pins::start();
    boards::stm32l4::inputs::start();
  }
  static void switch_off() { boards::stm32l4::switch_spi_off(); }
  bool is_high(std::uint16_t pin) const {
    return level(pin == kFirst ? Pin{'C', 0} : Pin{'A', 2}) == Level::high;
  }

  boards::stm32l4::PartBus spi;
};

using Read = std::optional<std::vector<std::uint8_t>>;

template <typename Model>
struct Bus : Model {
  Bus() {
    for (unsigned command = 0; command < 256; ++command) {
      const auto byte = static_cast<std::uint8_t>(command);
      this->answers[Model::kFirst][byte] = {static_cast<std::uint8_t>(command ^ 0x5A), 0x11};
      this->answers[Model::kOther][byte] = {static_cast<std::uint8_t>(command ^ 0xA5), 0x22};
    }
    this->spi.open(Model::kFirst);
    this->spi.open(Model::kOther);
  }
  ~Bus() { this->spi.close(); }
  // The processor takes each interrupt `latency` microseconds late.
  void run(unsigned microseconds, unsigned latency = 0) {
    unsigned waits = 0;
    for (; microseconds > 0; --microseconds) {
      this->pass_microsecond();
      if (!this->interrupt() || waits++ < latency) continue;
      waits = 0;
      ++interrupts;
      this->spi.on_interrupt();
      REQUIRE_FALSE(this->interrupt());
    }
  }
  bool ask(std::uint16_t select, unsigned command, std::size_t count = 2) {
    std::array<std::byte, 3> in{};
    return this->spi.transfer(true, select, std::array{static_cast<std::byte>(command)},
                              std::span(in).first(count));
  }
  Read collect(std::uint16_t select, unsigned command, std::size_t count = 2) {
    std::array<std::byte, 3> in{};
    if (!this->spi.transfer(false, select, std::array{static_cast<std::byte>(command)},
                            std::span(in).first(count)))
      return std::nullopt;
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < count; ++i)
      bytes.push_back(std::to_integer<std::uint8_t>(in.at(i)));
    return bytes;
  }
  bool all_are_high() const { return this->is_high(Model::kFirst) && this->is_high(Model::kOther); }

  unsigned interrupts = 0;
};

Read bytes(std::vector<std::uint8_t> them) {
  return them;
}

}  // namespace

TEMPLATE_TEST_CASE("SPI: what is asked ahead is there soon, by an interrupt", "", Microbit, L475) {
  Bus<TestType> bus;
  CHECK(bus.all_are_high());
  for (unsigned round = 1; round <= 3; ++round) {
    bus.answers[TestType::kFirst][0x8F] = {static_cast<std::uint8_t>(round), 0x77};
    CHECK_FALSE(bus.ask(TestType::kFirst, 0x8F));
    CHECK(bus.spi.is_busy());
    CHECK_FALSE(bus.is_high(TestType::kFirst));
    CHECK(bus.is_high(TestType::kOther));
    bus.run(TestType::kTransferUs);
    CHECK_FALSE(bus.spi.is_busy());
    CHECK(bus.all_are_high());
    CHECK(bus.interrupts == round);
    for (unsigned times = 0; times < 2; ++times)
      CHECK(bus.collect(TestType::kFirst, 0x8F) == bytes({static_cast<std::uint8_t>(round), 0x77}));
  }
  using Heard = tests::SpiParts::Heard;
  CHECK(bus.heard == std::vector(3, Heard{TestType::kFirst, {0x8F, 0, 0}}));
}

TEMPLATE_TEST_CASE("SPI: who wants the same gets it together, others one after the other", "",
                   Microbit, L475) {
  Bus<TestType> bus;
  const std::uint16_t first = TestType::kFirst, other = TestType::kOther;
  bus.ask(first, 1);
  bus.ask(other, 1);
  bus.ask(first, 1);
  bus.ask(first, 2);
  bus.ask(first, 1, 1);
  bus.run(500);
  CHECK_FALSE(bus.spi.is_busy());
  CHECK(bus.all_are_high());
  using Heard = tests::SpiParts::Heard;
  CHECK(bus.heard == std::vector{Heard{first, {1, 0, 0}}, Heard{other, {1, 0, 0}},
                                 Heard{first, {2, 0, 0}}, Heard{first, {1, 0}}});
  CHECK(bus.collect(first, 1) == bytes({0x5B, 0x11}));
  CHECK(bus.collect(other, 1) == bytes({0xA4, 0x22}));
  CHECK(bus.collect(first, 2) == bytes({0x58, 0x11}));
  CHECK(bus.collect(first, 1, 1) == bytes({0x5B}));
  CHECK(bus.collect(first, 3) == std::nullopt);  // was not asked for
  CHECK(bus.collect(other, 2) == std::nullopt);
}

TEMPLATE_TEST_CASE("SPI: what is asked again all the time keeps nobody waiting", "", Microbit,
                   L475) {
  Bus<TestType> bus;
  for (unsigned command = 0; command < 4; ++command)
    bus.ask(TestType::kFirst, command);
  for (unsigned round = 0; round < 4; ++round) {
    bus.run(TestType::kTransferUs + 1);
    for (unsigned command = 0; command < 2; ++command)
      bus.ask(TestType::kFirst, command);
  }
  CHECK(bus.collect(TestType::kFirst, 3) == bytes({0x59, 0x11}));
}

TEMPLATE_TEST_CASE("SPI: what is not there in time is given up, and the next one works", "",
                   Microbit, L475) {
  Bus<TestType> bus;
  const std::uint16_t first = TestType::kFirst, other = TestType::kOther;
  bus.ask(first, 1);
  bus.run(10);
  CHECK(bus.collect(first, 1) == std::nullopt);
  CHECK(bus.all_are_high());
  CHECK_FALSE(bus.spi.is_busy());
  bus.ask(first, 1);
  bus.run(60);
  CHECK(bus.collect(first, 1) == bytes({0x5B, 0x11}));
  bus.stuck = true;
  bus.ask(first, 2);
  bus.ask(other, 3);
  bus.ask(other, 4);
  bus.run(3000);
  CHECK(bus.spi.is_busy());
  CHECK(bus.collect(other, 3) == std::nullopt);  // ends the running one, which is another
  CHECK(bus.is_high(first));
  CHECK_FALSE(bus.is_high(other));
  CHECK(bus.collect(first, 2) == std::nullopt);
  bus.stuck = false;
  bus.run(60);
  CHECK(bus.collect(other, 4) == bytes({0xA1, 0x22}));
  CHECK(bus.all_are_high());
}

TEMPLATE_TEST_CASE("SPI: a late interrupt of a transfer that was given up means nothing", "",
                   Microbit, L475) {
  Bus<TestType> bus;
  bus.ask(TestType::kFirst, 1);
  for (unsigned us = 0; us < 100; ++us)
    bus.pass_microsecond();
  CHECK(bus.interrupt());
  CHECK(bus.collect(TestType::kFirst, 1) == std::nullopt);
  bus.ask(TestType::kFirst, 2);
  bus.spi.on_interrupt();
  CHECK(bus.spi.is_busy());
  bus.run(60);
  CHECK(bus.collect(TestType::kFirst, 2) == bytes({0x58, 0x11}));
}

TEMPLATE_TEST_CASE("SPI: without a part the line is pulled up; requests that cannot be are refused",
                   "", Microbit, L475) {
  Bus<TestType> bus;
  bus.answers[TestType::kFirst].clear();
  bus.ask(TestType::kFirst, 1);
  bus.run(60);
  CHECK(bus.collect(TestType::kFirst, 1) == bytes({0xFF, 0xFF}));
  std::array<std::byte, 3> in{};
  const std::array<std::byte, 2> two{};
  CHECK_FALSE(bus.spi.transfer(true, TestType::kFirst, two, std::span(in).first(1)));
  CHECK_FALSE(bus.ask(TestType::kFirst, 1, 3));
  CHECK_FALSE(bus.ask(TestType::kFirst, 1, 0));
  CHECK_FALSE(bus.ask(TestType::kFirst + 256, 1));
  CHECK_FALSE(bus.spi.is_busy());
}

TEMPLATE_TEST_CASE("SPI: a bus that is closed has forgotten all, and its pins are free", "",
                   Microbit, L475) {
  Bus<TestType> bus;
  bus.ask(TestType::kOther, 1);
  bus.run(60);
  bus.ask(TestType::kOther, 2);
  bus.run(5);
  bus.spi.close();
  CHECK_FALSE(bus.spi.is_busy());
  CHECK_FALSE(bus.is_on());
  CHECK(bus.is_high(TestType::kFirst));
  CHECK_FALSE(bus.is_high(TestType::kOther));  // an output that nobody has is low
  bus.ask(TestType::kOther, 1);
  CHECK_FALSE(bus.spi.is_busy());
  CHECK(bus.collect(TestType::kOther, 1) == std::nullopt);
  bus.spi.open(TestType::kOther);
  CHECK(bus.all_are_high());
  bus.ask(TestType::kFirst, 2);
  bus.run(5);
  bus.spi.close();
  CHECK(bus.is_high(TestType::kFirst));
  bus.spi.open(TestType::kOther);
  CHECK(bus.collect(TestType::kOther, 1) == std::nullopt);
  bus.ask(TestType::kOther, 1);
  bus.run(60);
  CHECK(bus.collect(TestType::kOther, 1) == bytes({0xA4, 0x22}));
}

// With the boards' own figures, as in analysis/bus_load.cpp; each interrupt comes 12 us late.
TEMPLATE_TEST_CASE("SPI: what rsc lets be asked at once is there in time", "", Microbit, L475) {
  const policy::BoardCosts& board = TestType::kCosts;
  const unsigned fit =
      policy::bus_window_us(board.bus_ahead_ms) / (board.spi_transfer_us + 3 * board.spi_byte_us);
  using Requests = boards::microbit::PartBus;
  const unsigned count = std::min<unsigned>(fit, Requests::kMostRequests);
  Bus<TestType> bus;
  for (unsigned i = 0; i < count; ++i)
    bus.ask(i % 2 == 0 ? TestType::kFirst : TestType::kOther, i);
  bus.run(count * (board.spi_transfer_us + 3 * board.spi_byte_us), 12);
  CHECK_FALSE(bus.spi.is_busy());
  for (unsigned i = 0; i < count; ++i)
    CHECK(bus.collect(i % 2 == 0 ? TestType::kFirst : TestType::kOther, i).has_value());
  for (unsigned i = count; i <= Requests::kMostRequests; ++i)  // more than there is room for
    bus.ask(TestType::kFirst, i);
  bus.run(3000);
  CHECK(bus.collect(TestType::kFirst, Requests::kMostRequests) == std::nullopt);
}

TEST_CASE(
    "micro:bit: while the bus is open, the player's line is closed; a transfer that lost a "
    "byte has failed; a dead module ends") {
  Bus<Microbit> bus;
  CHECK_FALSE(bus.player_has_its_pin());
  bus.loses_one = true;
  bus.ask(16, 1);
  bus.run(60);
  CHECK_FALSE(bus.spi.is_busy());
  CHECK(bus.collect(16, 1) == std::nullopt);
  bus.loses_one = false;
  bus.is_dead = true;
  bus.ask(16, 1);
  bus.run(60);
  CHECK(bus.collect(16, 1) == std::nullopt);
  CHECK(bus.all_are_high());
  bus.spi.close();
  CHECK(bus.player_has_its_pin());
  CHECK(bus.level(Microbit::kClock) == Microbit::Level::low);
  CHECK(bus.level(Microbit::kInput) == Microbit::Level::low);
  CHECK(bus.level(Microbit::kOutput) == Microbit::Level::high);
}

TEST_CASE("STM32L475: DMA that fails, or takes no byte, is a transfer that failed, and no more") {
  for (const unsigned latency : {0U, 60U}) {  // with the late interrupt, all bytes have come
    Bus<L475> bus;
    bus.dma_fails = true;
    bus.ask(45, 1);
    bus.run(100, latency);
    CHECK_FALSE(bus.spi.is_busy());
    CHECK(bus.collect(45, 1) == std::nullopt);
    CHECK(bus.all_are_high());
    bus.dma_is_late = true;
    bus.ask(45, 1);
    bus.ask(45, 2);
    bus.run(500);
    CHECK(bus.collect(45, 1) == std::nullopt);
    bus.dma_is_late = false;
    bus.run(100);
    CHECK(bus.collect(45, 2) == bytes({0x58, 0x11}));
  }
}

TEST_CASE("STM32L475: the pins of the bus are the header's again when it is closed") {
  Bus<L475> bus;
  CHECK(bus.has_pins());
  bus.spi.close();
  CHECK(bus.level({'A', 5}) == L475::Level::low);
  CHECK_FALSE(bus.has_pin(6));
  CHECK(bus.level({'A', 7}) == L475::Level::low);
  bus.wire({'A', 6}, std::nullopt);
  CHECK(boards::stm32l4::inputs::is_high(12));  // pulled up
  boards::stm32l4::pins::write(10, 1500);
  for (unsigned us = 0; us < 20'001; ++us)
    bus.pass_microsecond();
  CHECK(bus.is_high(10));
}

TEMPLATE_TEST_CASE("SPI: when the outputs are switched off, the bus drives nothing", "", Microbit,
                   L475) {
  Bus<TestType> bus;
  if constexpr (std::is_same_v<TestType, Microbit>) bus.is_dead = true;  // it is not waited for
  bus.ask(TestType::kFirst, 1);
  bus.run(5);
  TestType::switch_off();
  if constexpr (std::is_same_v<TestType, Microbit>)
    CHECK_FALSE(bus.is_on());
  else
    CHECK(bus.level({'A', 5}) == L475::Level::low);
}
