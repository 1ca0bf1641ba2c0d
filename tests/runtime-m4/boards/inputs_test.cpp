// The boards' shipped input pins against models of their ports: each reads its own pin of the chip,
// and is pulled up; no other pin can be read.
#include "runtime-m4/boards/stm32l4/inputs.hpp"

#include <map>

#include <catch2/catch.hpp>

#include "compiler/config/boards.hpp"
#include "runtime-m4/boards/microbit-v2/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/registers.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"
#include "tests/runtime-m4/boards/stm32_timers.hpp"

using namespace robosync;

namespace {

// tech.microbit.org, "Edge Connector & micro:bit pinout", V2.
struct Microbit : tests::Nrf52833 {
  Microbit() {
    boards::microbit::pins::start();
    boards::microbit::inputs::start();
  }
  static bool is_high(std::uint16_t pin) { return boards::microbit::inputs::is_high(pin); }
  static constexpr const char* kName = "microbit-v2";
  const std::map<std::uint16_t, Pin> read{{5, {0, 14}}, {11, {0, 23}}};
};

// UM2153, table 4 and "Buttons".
struct L475 : tests::Stm32Timers {
  L475() {
    boards::stm32l4::rcc::kAhb2.set(boards::stm32l4::rcc::kPortsAToD);
    boards::stm32l4::pins::start();
    boards::stm32l4::inputs::start();
  }
  static bool is_high(std::uint16_t pin) { return boards::stm32l4::inputs::is_high(pin); }
  static constexpr const char* kName = "b-l475e-iot01a";
  const std::map<std::uint16_t, Pin> read{
      {7, {'A', 4}}, {8, {'B', 2}}, {9, {'A', 15}}, {12, {'A', 6}}, {32, {'C', 13}}};
};

compiler::Board profile(std::string_view name) {
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_names()[i] == name) return compiler::board_at(i);
  FAIL("no board " << name);
  return {};
}

}  // namespace

TEMPLATE_TEST_CASE("an input has the level of its own pin, and is pulled up", "", Microbit, L475) {
  TestType chip;
  for (const auto& [number, pin] : chip.read)
    chip.wire(pin, std::nullopt);
  for (const auto& [pressed, its] : chip.read) {
    chip.wire(its, false);
    for (const auto& [number, pin] : chip.read) {
      CAPTURE(pressed, number);
      CHECK(TestType::is_high(number) == (number != pressed));
    }
    chip.wire(its, true);
    CHECK(TestType::is_high(pressed));
    chip.wire(its, std::nullopt);
  }
}

TEMPLATE_TEST_CASE("the inputs are those of the board's profile, and no output is one", "",
                   Microbit, L475) {
  TestType chip;
  for (const auto& [number, pin] : chip.read) {
    chip.wire(pin, true);
    CHECK(chip.level(pin) == TestType::Level::floating);
  }
  const compiler::Board board = profile(TestType::kName);
  for (unsigned number = 0; number <= UINT16_MAX; ++number) {
    const auto pin = static_cast<std::uint16_t>(number);
    CAPTURE(number);
    const bool is_input = chip.read.contains(pin);
    if (board.has_input(pin) != is_input) FAIL_CHECK("the profile says otherwise");
    if (!is_input && TestType::is_high(pin)) FAIL_CHECK("read, and no input");
  }
}
