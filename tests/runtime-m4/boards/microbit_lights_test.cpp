// The shipped code for the lights of the micro:bit V2, against the model of the chip's ports: which of them glow during each row,
// and while the row changes.
#include <random>
#include <set>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/lights.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"

using namespace robosync;
using tests::Nrf52833;
namespace lights = boards::microbit::lights;

namespace {

// tech.microbit.org, schematic of the V2: "ROW" and "COL" of the display.
constexpr std::array<Nrf52833::Pin, 5> kRowPins{{{0, 21}, {0, 22}, {0, 15}, {0, 24}, {0, 19}}};
constexpr std::array<Nrf52833::Pin, 5> kColumnPins{{{0, 28}, {0, 11}, {0, 31}, {1, 5}, {0, 30}}};

struct Display : Nrf52833 {
  Display() {
    lights::start();
    started = true;
  }
  // The lights with current: from a row that is high to a column that is low.
  std::uint32_t glowing() const {
    std::uint32_t lit = 0;
    for (unsigned row = 0; row < 5; ++row)
      for (unsigned column = 0; column < 5; ++column)
        if (level(kRowPins[row]) == Level::high && level(kColumnPins[column]) == Level::low)
          lit |= 1U << (5 * row + column);
    return lit;
  }
  unsigned rows_on() const {
    unsigned on = 0;
    for (const Pin& row : kRowPins)
      on += level(row) == Level::high ? 1U : 0U;
    return on;
  }
  // After every write, only lights of a picture that may be shown glow.
  void write(std::uintptr_t address, std::uint32_t value) override {
    Nrf52833::write(address, value);
    if ((glowing() & ~allowed) != 0) stray = true;
    if (rows_on() > 1) stray = true;
  }
  void show(std::uint32_t picture) {
    allowed |= picture;
    lights::show(picture);
  }
  std::uint32_t seen_in_a_frame() {
    std::uint32_t seen = 0;
    for (unsigned row = 0; row < 5; ++row) {
      REQUIRE(row_timer().asks());
      lights::next_row();
      seen |= glowing();
      CHECK(rows_on() == 1);
    }
    return seen;
  }
  std::uint32_t allowed = 0;
  bool stray = false, started = false;
};

constexpr std::uint32_t kAll = (1U << 25) - 1;

}  // namespace

TEST_CASE("the lights: from the start on their pins are driven, and all are dark") {
  Display display;
  CHECK(display.glowing() == 0);
  CHECK(display.rows_on() == 0);
  for (const auto& pins : {kRowPins, kColumnPins})
    for (const auto& pin : pins)
      CHECK(display.level(pin) != Nrf52833::Level::floating);
  // A row feeds five lights. With the standard drive of 2 mA, a light gets darker with each other light of its row.
  for (const auto& pins : {kRowPins, kColumnPins})
    for (const auto& pin : pins)
      CHECK(display.configuration_of(pin) >> 8 == 3);  // H0H1
  CHECK_FALSE(display.row_timer().runs);
  CHECK_FALSE(display.stray);
}

TEST_CASE("the lights: a picture is on row by row, each of its lights and no other") {
  std::mt19937 random(25);
  for (unsigned light = 0; light < 25; ++light) {
    Display display;
    display.show(1U << light);
    CHECK(display.seen_in_a_frame() == 1U << light);
    CHECK_FALSE(display.stray);
  }
  for (unsigned round = 0; round < 100; ++round) {
    Display display;
    const std::uint32_t picture = round == 0 ? kAll : static_cast<std::uint32_t>(random()) & kAll;
    display.show(picture | 1);
    CHECK(display.seen_in_a_frame() == (picture | 1));
    CHECK(display.row_timer().period_us() == 2000);
    CHECK_FALSE(display.stray);
  }
}

TEST_CASE(
    "the lights: the next picture takes over from row to row, dark is at once and stops the "
    "timer") {
  Display display;
  display.show(0b10101);
  display.seen_in_a_frame();
  lights::next_row();
  display.show(kAll);
  CHECK(display.seen_in_a_frame() == kAll);
  display.show(0);
  CHECK(display.rows_on() == 0);
  REQUIRE(display.row_timer().asks());
  lights::next_row();
  CHECK(display.rows_on() == 0);
  CHECK_FALSE(display.row_timer().runs);
  display.show(1);
  CHECK(display.seen_in_a_frame() == 1);
  CHECK_FALSE(display.stray);
}
