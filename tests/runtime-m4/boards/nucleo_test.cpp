// The Nucleo-L476RG's shipped inputs against models of its registers: each pin reads its own line of the chip. Everything else in
// the drivers is tested with the other board that has this chip.
#include <map>
#include <optional>

#include <catch2/catch.hpp>

#include "compiler/config/boards.hpp"
#include "runtime-m4/boards/stm32l4/analog.hpp"
#include "runtime-m4/boards/stm32l4/echoes.hpp"
#include "runtime-m4/boards/stm32l4/inputs.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/usart.hpp"
#include "tests/runtime-m4/boards/stm32_timers.hpp"

using namespace robosync;
using tests::Stm32Timers;
namespace chip = boards::stm32l4;

namespace {

// UM1724, "Arduino connectors on NUCLEO-L476RG"; the button B1.
const std::map<std::uint16_t, Stm32Timers::Pin> kRead{
    {2, {'A', 10}}, {4, {'B', 5}}, {7, {'A', 8}}, {9, {'C', 7}}, {12, {'A', 6}}, {32, {'C', 13}}};
// The same; DS10198, table 16: the channel of ADC1 for each pin.
struct Analog {
  Stm32Timers::Pin pin;
  unsigned channel;
};
const std::map<std::uint16_t, Analog> kAnalog{{40, {{'A', 0}, 5}},
                                              {41, {{'A', 1}, 6}},
                                              {42, {{'A', 4}, 9}},
                                              {43, {{'B', 0}, 15}},
                                              {44, {{'C', 1}, 2}}};

compiler::Board profile() {
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_names()[i] == "nucleo-l476rg") return compiler::board_at(i);
  FAIL("no such board");
  return {};
}

// Ports, EXTI and SYSCFG, and an ADC1 that starts immediately and measures its channel's number.
struct Nucleo : Stm32Timers {
  Nucleo() {
    for (const auto& [number, pin] : kRead)
      wire(pin, std::nullopt);
    write(0x4002'104C, 0b1111);
    chip::pins::start();
    chip::inputs::start();
    chip::echoes::start();
    chip::analog::start();
  }
  static bool is_other(std::uintptr_t address) {
    return address == 0x4002'1060 || address == 0x4002'1088 || address >= 0x5000'0000 ||
           (address >= 0x4001'0000 && address < 0x4001'0500) ||
           (address >= 0x4800'0000 && address < 0x4800'1000 && (address & 0x3FF) == 0x2C);
  }
  std::uint32_t read(std::uintptr_t address) override {
    if (!is_other(address)) return Stm32Timers::read(address);
    if (address == 0x5004'0000) return 0b1001;                                  // ready, measured
    if (address == 0x5004'0008) return others[address] & ~(1U << 31 | 0b100U);  // calibrated
    if (address == 0x5004'0040) {  // of the last conversion
      const std::uint32_t sequence = others[0x5004'0030];
      return sequence >> 6 * ((sequence & 0xF) + 1) & 31;
    }
    return others[address];
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (!is_other(address)) return Stm32Timers::write(address, value);
    if (address == 0x4001'0414) value = others[address] & ~value;
    others[address] = value;
  }
  void edge(Pin pin, bool high) {
    wire(pin, high);
    others[0x4001'0414] |= 1U << pin.second;
  }
  std::uint32_t mode_of(Pin pin) {
    return Stm32Timers::read(0x4800'0000 + 0x400U * static_cast<unsigned>(pin.first - 'A')) >>
               2 * pin.second &
           3;
  }

  std::map<std::uintptr_t, std::uint32_t> others;
};

}  // namespace

TEST_CASE("Nucleo: an input has the level of its own pin, is pulled up, and the profile has it") {
  Nucleo board;
  for (const auto& [pressed, its] : kRead) {
    board.wire(its, false);
    for (const auto& [number, pin] : kRead)
      CHECK(chip::inputs::is_high(number) == (number != pressed));
    board.wire(its, std::nullopt);
  }
  const compiler::Board told = profile();
  for (unsigned number = 0; number <= UINT16_MAX; ++number) {
    const auto pin = static_cast<std::uint16_t>(number);
    if (told.has_input(pin) == kRead.contains(pin)) continue;
    FAIL_CHECK("the profile says otherwise of " << number);
  }
}

TEST_CASE("Nucleo: an analog input is its own channel, and its pin is analog") {
  Nucleo board;
  std::uint16_t voltage = 0;
  for (const auto& [number, it] : kAnalog) {
    CAPTURE(number);
    CHECK(board.mode_of(it.pin) == 3);
    const auto [port, bit] = it.pin;
    CHECK((board.others[0x4800'002C + 0x400U * static_cast<unsigned>(port - 'A')] >> bit & 1) == 1);
    REQUIRE(chip::analog::read(number, voltage));
    CHECK(voltage == it.channel);
  }
  CHECK_FALSE(chip::analog::read(45, voltage));
}

TEST_CASE("Nucleo: the edges of an echo are those of its own pin") {
  for (const auto& [number, pin] : kRead) {
    CAPTURE(number);
    Nucleo board;
    const auto [port, line] = pin;
    board.wire(pin, false);
    chip::echoes::ping(3, number);
    CHECK(board.level({'B', 3}) == Stm32Timers::Level::high);
    CHECK(board.others[0x4001'0400] == 1U << line);
    CHECK((board.others[0x4001'0008 + 4 * (line / 4)] >> line % 4 * 4 & 0xF) ==
          static_cast<unsigned>(port - 'A'));
    board.edge(pin, true);
    chip::echoes::on_edge(0);
    board.edge(pin, false);
    chip::echoes::on_edge(80 * 580);
    CHECK(chip::echoes::take(number) == 580);
  }
}

TEST_CASE("Nucleo: the link is USART2 at PA2 and PA3, the player USART1 at PA9") {
  constexpr auto link = chip::wiring::kLink, player = chip::wiring::kPlayer;
  // RM0351, 2.2.2 and 13.3; DS10198, table 17.
  CHECK(link.usart.base == 0x4000'4400);
  CHECK(link.usart.interrupt == 38);
  CHECK((link.usart.clocks.address == 0x4002'1058 && link.usart.clock == 1U << 17));
  CHECK((link.port.base == 0x4800'0000 && link.function == 7));
  CHECK((link.transmit == 2 && link.receive == 3));
  CHECK(player.usart.base == 0x4001'3800);
  CHECK(player.usart.interrupt == 37);
  CHECK((player.port.base == 0x4800'0000 && player.function == 7 && player.transmit == 9));
}
