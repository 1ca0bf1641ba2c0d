// See lights.hpp. When the picture becomes dark, the timer runs for one more row before it is stopped.
#include "runtime-m4/boards/microbit-v2/lights.hpp"

#include <array>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::lights {

namespace {

constexpr std::array kRows{Pin{0, 21}, Pin{0, 22}, Pin{0, 15}, Pin{0, 24}, Pin{0, 19}};
constexpr std::array kColumns{Pin{0, 28}, Pin{0, 11}, Pin{0, 31}, Pin{1, 5}, Pin{0, 30}};
constexpr std::uint32_t kRowTime = 2000;  // microseconds; policy::kRowMs

volatile std::uint32_t shown = 0;
unsigned row = 0;
bool runs = false;

constexpr unsigned kPorts = 2;
constexpr Pin port_pin(unsigned port) {
  return {static_cast<std::uint8_t>(port), 0};
}

constexpr std::uint32_t columns_of(unsigned port) {
  std::uint32_t columns = 0;
  for (const Pin& column : kColumns)
    columns |= column.port == port ? column.mask() : 0;
  return columns;
}
constexpr std::array<std::uint32_t, kPorts> kAllColumns{columns_of(0), columns_of(1)};

// Sets the columns for a row. No row may be on.
void set_columns(std::uint32_t lit) {
  std::array<std::uint32_t, kPorts> low{};
  for (const Pin& column : kColumns) {
    if ((lit & 1) != 0) low[column.port] |= column.mask();
    lit >>= 1;
  }
  for (unsigned port = 0; port < kPorts; ++port) {
    port_pin(port).set_high().write(kAllColumns[port]);
    port_pin(port).set_low().write(low[port]);
  }
}

void all_dark() {
  for (const Pin& pin : kRows)
    pin.set_low().write(pin.mask());
}

}  // namespace

void start() {
  all_dark();
  for (const Pin& column : kColumns)
    column.set_high().write(column.mask());
  for (const auto* pins : {&kRows, &kColumns})
    for (const Pin& pin : *pins)
      pin.configuration().write(Pin::kStrongOutput);
  kRowTimer.prescaler().write(Timer::kMicroseconds);
  kRowTimer.value(0).write(kRowTime);
  kRowTimer.shortcuts().write(Timer::kBeginAgain);
  kRowTimer.interrupts_on().write(Timer::interrupt(0));
  runs = false;
}

void show(std::uint32_t picture) {
  const port::Alone alone;
  shown = picture;
  if (picture == 0) return all_dark();
  if (runs) return;
  runs = true;
  kRowTimer.start().write(kDoIt);
}

// The old row goes dark first, or its lights would glow in the columns of the next one.
void next_row() {
  const port::Alone alone;
  forget(kRowTimer.reached(0));
  kRows[row].set_low().write(kRows[row].mask());
  if (shown == 0) {
    kRowTimer.stop().write(kDoIt);
    runs = false;
    return;
  }
  row = row + 1 == kRows.size() ? 0 : row + 1;
  set_columns(shown >> (kColumns.size() * row));
  kRows[row].set_high().write(kRows[row].mask());
}

}  // namespace robosync::boards::microbit::lights
