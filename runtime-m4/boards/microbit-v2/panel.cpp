// See panel.hpp. The module fetches the picture from memory, without any interrupt. When it is off, it releases its pin, which
// the port then drives low.
#include "runtime-m4/boards/microbit-v2/panel.hpp"

#include "runtime-m4/boards/common/panel_signal.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {
namespace {

// A byte takes 2 us and a poll at least 0.1 us: the polls wait for the last byte of a dropped picture, and no longer.
constexpr unsigned kLooksAtStop = 20;

void give_up() {
  if (kPanelSpi.enable().read() == 0 || kPanelSpi.ended().read() != 0) return;
  kPanelSpi.stopped().write(0);
  kPanelSpi.stop().write(kDoIt);
  for (unsigned looks = 0; looks < kLooksAtStop && kPanelSpi.stopped().read() == 0; ++looks) {
  }
}

struct PanelSpi {  // for PanelSignal
  static constexpr std::uint32_t kHz = 4'000'000;
  // A zero is high for 0.25 us of 1.25 us, a one for 0.75 us.
  static constexpr unsigned kBitsOfBit = 5;
  static constexpr std::uint64_t kZero = 0b10000;
  static constexpr std::uint64_t kOne = 0b11100;

  static void let_go() {
    give_up();
    kPanelSpi.enable().write(0);
  }

  static void send(std::uint16_t pin, std::span<const std::byte> bytes) {
    const Pin* const chip = pins::chip_pin(pin);
    if (chip == nullptr) return;
    let_go();
    kPanelClock.configuration().write(Pin::kClockOutput);
    kPanelSpi.clock_pin().write(kPanelClock.number());
    kPanelSpi.output_pin().write(chip->number());
    kPanelSpi.frequency().write(Spim::k4MHz);
    kPanelSpi.send_from().write(port::bus_address(bytes.data()));
    kPanelSpi.send_count().write(static_cast<std::uint32_t>(bytes.size()));
    kPanelSpi.receive_count().write(0);
    kPanelSpi.enable().write(Spim::kOn);
    kPanelSpi.ended().write(0);
    kPanelSpi.start().write(kDoIt);
  }
};

constinit PanelSignal<PanelSpi> signal;

}  // namespace

PanelOutput& panel_output() {
  return signal;
}

}  // namespace robosync::boards::microbit
