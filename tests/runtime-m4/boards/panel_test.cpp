// The shipped panel code of both boards, against models of their SPI masters and of a chain of WS2812: the colour of each light,
// bit times included, whatever came before and whatever level the idle line has.
#include "runtime-m4/boards/stm32l4/panel.hpp"

#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "compiler/config/boards.hpp"
#include "runtime-m4/boards/microbit-v2/panel.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/registers.hpp"
#include "tests/runtime-m4/boards/spi_masters.hpp"
#include "tests/runtime-m4/boards/ws2812_chain.hpp"

using namespace robosync;

namespace panel_test {
namespace {

using tests::Idle;
constexpr unsigned kPictures = 1U << 25;
constexpr unsigned kLong = 5000;  // microseconds: more than a picture takes

std::vector<std::uint16_t> panel_pins(std::string_view board) {
  std::vector<std::uint16_t> found;
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_names()[i] == board)
      for (const compiler::Board::Pins& pins : compiler::board_at(i).panels)
        for (std::uint16_t pin = pins.first; pin <= pins.last; ++pin)
          found.push_back(pin);
  return found;
}

struct Microbit : tests::NrfSpim {
  static constexpr const char* kName = "microbit-v2";
  Microbit() { boards::microbit::pins::start(); }
  static boards::PanelOutput& output() { return boards::microbit::panel_output(); }
  bool has_pin() const { return pin() != ~0U; }
};

struct L475 : tests::Stm32Spi {
  static constexpr const char* kName = "b-l475e-iot01a";
  L475() {
    boards::stm32l4::rcc::kAhb2.set(boards::stm32l4::rcc::kPortsAToD);
    boards::stm32l4::pins::start();
  }
  static boards::PanelOutput& output() { return boards::stm32l4::panel_output(); }
};

template <class Chip>
struct Wired : Chip {
  explicit Wired(const policy::Panel& with, Idle between = Idle::as_it_was)
      : panel(with), chain(with.lights()) {
    Chip::idle = between;
    Chip::heard = [this](bool high, unsigned ns) { chain.hear(high, ns); };
    Chip::output().begin(panel);
  }
  std::vector<std::uint32_t> after(std::uint32_t picture, unsigned us = kLong) {
    Chip::output().show(picture);
    Chip::pass(us);
    return chain.shown();
  }

  policy::Panel panel;
  tests::Ws2812Chain chain;
};

// Drawn row by row, then put in the order of the wire.
std::vector<std::uint32_t> drawn(std::uint32_t picture, const policy::Panel& panel) {
  const unsigned first = panel.side == 8 ? 1 : 0;
  std::vector<std::vector<std::uint32_t>> rows(panel.side, std::vector<std::uint32_t>(panel.side));
  for (unsigned row = 0; row < 5; ++row)
    for (unsigned column = 0; column < 5; ++column)
      if ((picture >> (5 * row + column) & 1) != 0) rows[first + row][first + column] = panel.color;
  std::vector<std::uint32_t> chain;
  for (unsigned row = 0; row < panel.side; ++row) {
    if (panel.goes_back && row % 2 == 1)
      chain.insert(chain.end(), rows[row].rbegin(), rows[row].rend());
    else
      chain.insert(chain.end(), rows[row].begin(), rows[row].end());
  }
  return chain;
}

template <class Chip>
std::vector<policy::Panel> all_panels() {
  std::vector<policy::Panel> panels;
  for (const std::uint8_t side : {std::uint8_t{5}, std::uint8_t{8}})
    for (const bool back : {false, true})
      for (const std::uint32_t color : {0x19'19'19U, 0x33'00'02U, 0x01'33'00U, 0x00'2A'15U})
        panels.push_back({.pin = panel_pins(Chip::kName).front(),
                          .side = side,
                          .goes_back = back,
                          .color = color});
  return panels;
}

}  // namespace

TEMPLATE_TEST_CASE(
    "panel: each picture is there, in its colour and with the times of the data sheet", "",
    Microbit, L475) {
  std::mt19937 random(2812);
  for (const policy::Panel& panel : all_panels<TestType>()) {
    Wired<TestType> board(panel);
    for (unsigned light = 0; light < 25; ++light)
      CHECK(board.after(1U << light) == drawn(1U << light, panel));
    for (unsigned round = 0; round < 20; ++round) {
      const auto picture = static_cast<std::uint32_t>(random()) % kPictures;
      CHECK(board.after(picture) == drawn(picture, panel));
    }
    CHECK(board.after(0) == drawn(0, panel));
    CHECK(board.chain.pictures() == 25 + 20 + 1);
    CHECK(board.chain.disturbed() == 0);
  }
}

TEMPLATE_TEST_CASE("panel: all lights of a strip have its colour", "", Microbit, L475) {
  std::mt19937 random(64);
  const std::uint16_t pin = panel_pins(TestType::kName).front();
  for (const unsigned lights : {1U, 8U, 33U, 64U}) {
    Wired<TestType> board({.pin = pin, .strip = static_cast<std::uint8_t>(lights)});
    for (unsigned round = 0; round < 10; ++round) {
      const auto color = static_cast<std::uint32_t>(random()) % (1U << 24);
      CHECK(board.after(color) == std::vector<std::uint32_t>(lights, color));
    }
    CHECK(board.after(0) == std::vector<std::uint32_t>(lights, 0));
    CHECK(board.chain.pictures() == 10 + 1);
    CHECK(board.chain.disturbed() == 0);
  }
}

TEMPLATE_TEST_CASE("panel: a picture of 64 lights has its time before the next one may come", "",
                   Microbit, L475) {
  const policy::Panel panel{
      .pin = panel_pins(TestType::kName).front(), .side = 8, .goes_back = false, .color = 0x333333};
  Wired<TestType> board(panel, Idle::low);
  for (unsigned round = 0; round < 10; ++round)
    board.after(round * 77777, policy::kPanelGapMs * 1000);
  CHECK(board.chain.pictures() == 10);
  CHECK(board.chain.disturbed() == 0);
}

TEMPLATE_TEST_CASE("panel: it does not matter what the line is between two pictures", "", Microbit,
                   L475) {
  for (const Idle idle : {Idle::low, Idle::high, Idle::as_it_was})
    for (const policy::Panel& panel : all_panels<TestType>()) {
      Wired<TestType> board(panel, idle);
      CHECK(board.after(0x1FF'FFFF) == drawn(0x1FF'FFFF, panel));
      CHECK(board.after(0x0AA'AAAA) == drawn(0x0AA'AAAA, panel));
      CHECK(board.after(0) == drawn(0, panel));
    }
}

TEMPLATE_TEST_CASE("panel: one that is given up in its midst leaves nothing behind", "", Microbit,
                   L475) {
  std::mt19937 random(5);
  for (const Idle idle : {Idle::low, Idle::high, Idle::as_it_was})
    for (const policy::Panel& panel : all_panels<TestType>()) {
      Wired<TestType> board(panel, idle);
      for (unsigned round = 0; round < 10; ++round) {
        board.after(static_cast<std::uint32_t>(random()) % kPictures,
                    static_cast<unsigned>(random() % 2500));
        const auto picture = static_cast<std::uint32_t>(random()) % kPictures;
        CHECK(board.after(picture) == drawn(picture, panel));
      }
      board.after(0x1FF'FFFF, static_cast<unsigned>(random() % 2500));
      TestType::output().begin(panel);  // the next program's, which begins dark
      CHECK(board.after(0) == drawn(0, panel));
    }
}

TEMPLATE_TEST_CASE("panel: a smaller one, and one of another colour, are what they are", "",
                   Microbit, L475) {
  const auto panels = all_panels<TestType>();
  Wired<TestType> large(panels.back());
  large.after(0x1FF'FFFF);
  for (const policy::Panel& panel : panels) {
    Wired<TestType> board(panel);
    CHECK(board.after(0x155'5555) == drawn(0x155'5555, panel));
  }
}

TEMPLATE_TEST_CASE("panel: before its first picture and behind its end it has no pin", "", Microbit,
                   L475) {
  for (const unsigned us : {kLong, 500U, 0U}) {
    Wired<TestType> board(all_panels<TestType>().front());
    CHECK_FALSE(board.has_pin());
    board.after(0x155'5555, us);
    CHECK(board.has_pin());
    TestType::output().end();
    CHECK_FALSE(board.has_pin());
    TestType::output().end();
    CHECK(board.after(0x0AA'AAAA) == drawn(0x0AA'AAAA, board.panel));  // works again
  }
}

TEST_CASE("panel: of the micro:bit it may be at each of its outputs, one after the other") {
  for (const std::uint16_t pin : panel_pins("microbit-v2")) {
    const policy::Panel panel{.pin = pin, .side = 5, .goes_back = false, .color = 0x123456};
    Wired<Microbit> board(panel);
    CHECK(board.after(0x155'5555) == drawn(0x155'5555, panel));
    CHECK(board.pin() == boards::microbit::pins::chip_pin(pin)->number());
  }
  CHECK(panel_pins("microbit-v2") == std::vector<std::uint16_t>{0, 1, 2, 12, 13, 14});
  CHECK(panel_pins("b-l475e-iot01a") == std::vector<std::uint16_t>{11});
}

TEST_CASE("panel: a module that does nothing, as that of an emulator, holds nobody up") {
  Wired<Microbit> board(all_panels<Microbit>().front());
  board.is_dead = true;
  for (unsigned round = 0; round < 10; ++round)
    Microbit::output().show(round);
  Microbit::output().end();
  CHECK(board.looks <= 10 * 20);
}

TEST_CASE("panel: a pin that a panel has had gives pulses again") {
  Wired<L475> board(all_panels<L475>().front());
  board.after(1);
  L475::output().end();
  boards::stm32l4::pins::write(11, 1000);
  unsigned high = 0;
  for (unsigned us = 0; us < 40'000; ++us) {
    board.pass_microsecond();
    high += board.level({'A', 7}) == tests::Stm32Timers::Level::high ? 1U : 0U;
  }
  CHECK(high >= 1000);
}

}  // namespace panel_test
