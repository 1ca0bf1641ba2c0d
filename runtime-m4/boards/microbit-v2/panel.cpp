// See panel.hpp. The module fetches the picture from memory, without any interrupt. When it is off, it releases its pin, which
// the port then drives low.
#include "runtime-m4/boards/microbit-v2/panel.hpp"

#include "runtime-m4/boards/common/panel_signal.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {
namespace {

// A byte takes 2 us and a poll at least 0.1 us: the polls wait for the last byte of a dropped picture, and no longer.
constexpr unsigned kMostLooks = 20;

void give_up() {
  if (panel_spi::kEnable.read() == 0 || panel_spi::kEnded.read() != 0) return;
  panel_spi::kStopped.write(0);
  panel_spi::kStop.write(kDoIt);
  for (unsigned looks = 0; looks < kMostLooks && panel_spi::kStopped.read() == 0; ++looks) {
  }
}

struct Spim {  // for PanelSignal
  static constexpr std::uint32_t kHz = panel_spi::kHz;
  // A zero is high for 0.25 us of 1.25 us, a one for 0.75 us.
  static constexpr unsigned kBitsOfBit = 5;
  static constexpr std::uint64_t kZero = 0b10000;
  static constexpr std::uint64_t kOne = 0b11100;

  static void let_go() {
    give_up();
    panel_spi::kEnable.write(0);
  }

  static void send(std::uint16_t pin, std::span<const std::byte> bytes) {
    const Pin* const chip = pins::chip_pin(pin);
    if (chip == nullptr) return;
    let_go();
    panel_spi::kClock.configuration().write(Pin::kClockOutput);
    panel_spi::kClockPin.write(panel_spi::kClock.number());
    panel_spi::kOutputPin.write(chip->number());
    panel_spi::kFrequency.write(panel_spi::k4MHz);
    panel_spi::kSendFrom.write(port::bus_address(bytes.data()));
    panel_spi::kSendCount.write(static_cast<std::uint32_t>(bytes.size()));
    panel_spi::kReceiveCount.write(0);
    panel_spi::kEnable.write(panel_spi::kOn);
    panel_spi::kEnded.write(0);
    panel_spi::kStart.write(kDoIt);
  }
};

constinit PanelSignal<Spim> signal;

}  // namespace

PanelOutput& panel_output() {
  return signal;
}

}  // namespace robosync::boards::microbit
