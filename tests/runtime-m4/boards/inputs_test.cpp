// The boards' shipped input pins against models of their ports: each reads its own pin of the chip,
// and is pulled up; no other pin can be read.
#include "runtime-m4/boards/stm32l4/inputs.hpp"

#include <array>
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
    for (const auto& [number, pin] : read)
      boards::microbit::pins::let_go(number, boards::Reads::level);
  }
  static bool is_high(std::uint16_t pin) { return boards::microbit::inputs::is_high(pin); }
  static constexpr const char* kName = "microbit-v2";
  const std::map<std::uint16_t, Pin> read{{0, {0, 2}},   {1, {0, 3}}, {2, {0, 4}},   {5, {0, 14}},
                                          {8, {0, 10}},  {9, {0, 9}}, {11, {0, 23}}, {12, {0, 12}},
                                          {13, {0, 17}}, {14, {0, 1}}};
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

namespace {

constexpr std::array<std::uint16_t, 6> kShared{0, 1, 2, 12, 13, 14};
constexpr std::array<std::uint16_t, 4> kAlwaysInputs{5, 8, 9, 11};

}  // namespace

TEST_CASE("microbit: a pin for pulses is an output, and low, but while its level is read") {
  using Level = Microbit::Level;
  namespace edge = boards::microbit::pins;
  Microbit chip;
  for (const std::uint16_t number : kShared)
    edge::take_back(number);
  for (const std::uint16_t number : kShared) {
    CAPTURE(number);
    const auto pin = chip.read.at(number);
    chip.wire(pin, true);
    CHECK(chip.level(pin) == Level::low);
    CHECK_FALSE(Microbit::is_high(number));  // nobody reads an output
    edge::let_go(number, boards::Reads::level);
    CHECK(chip.level(pin) == Level::floating);
    CHECK(Microbit::is_high(number));
    chip.wire(pin, std::nullopt);
    CHECK(Microbit::is_high(number));  // pulled up
    edge::switch_off();                // whatever goes wrong, it drives none
    CHECK(chip.level(pin) == Level::floating);
    edge::let_go(number, boards::Reads::voltage);
    CHECK(chip.configuration_of(pin) == 0b10);
    edge::let_go(number, boards::Reads::level);
    CHECK(chip.configuration_of(pin) == 0b1100);
    edge::take_back(number);
    CHECK(chip.level(pin) == Level::low);
  }
  for (const std::uint16_t number : kAlwaysInputs) {
    edge::let_go(number, boards::Reads::voltage);
    edge::take_back(number);
    CHECK(chip.configuration_of(chip.read.at(number)) == 0b1100);
  }
}

namespace {

// The setting of the pins 8 and 9 (UICR.NFCPINS), which is a word of flash, and what identifies the chip.
struct NewMicrobit : tests::RegisterModel {
  std::uint32_t page = 4096, nfc_pins = 0xFFFF'FFFF, configuration = 0, busy = 0;
  bool is_stuck = false, has_setting = true;
  unsigned reads = 0;

  std::uint32_t read(std::uintptr_t address) override {
    ++reads;
    if (address == 0x1000'0010) return page;
    if (address == 0x1000'120C && has_setting) return nfc_pins;
    if (address == 0x4001'E400) return busy == 0 ? 1 : --busy, 0;
    tests::no_register(address);
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (address == 0x4001'E504) {
      tests::demand(busy == 0, "the flash is busy");
      configuration = value;
    } else if (address == 0x1000'120C) {
      tests::demand(configuration == 1 && (value & 0xFFFF'FFFE) == 0xFFFF'FFFE,
                    "a word is written");
      if (!is_stuck) nfc_pins &= value;
      busy = 100;
    } else {
      tests::no_register(address);
    }
  }
};

}  // namespace

TEST_CASE("microbit: the pins 8 and 9 are taken from NFC once, and reset for only if that worked") {
  using boards::microbit::inputs::free_from_nfc;
  NewMicrobit chip;
  CHECK(free_from_nfc());
  CHECK(chip.nfc_pins == 0xFFFF'FFFE);
  CHECK(chip.configuration == 0);  // the flash is read-only again
  CHECK_FALSE(free_from_nfc());
  NewMicrobit stuck;
  stuck.is_stuck = true;
  CHECK_FALSE(free_from_nfc());
  CHECK(stuck.reads < 11'000);
  NewMicrobit other;  // QEMU's chip
  other.page = 1024;
  other.has_setting = false;
  CHECK_FALSE(free_from_nfc());
}
