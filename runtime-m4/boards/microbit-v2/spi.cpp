// See spi.hpp. Nordic's nRF52833 Product Specification, 6.23 (SPIM).
#include "runtime-m4/boards/microbit-v2/spi.hpp"

#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/player.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {
namespace {

// A byte takes 8 us and a poll at least 0.1 us: the polls wait for the byte that is on its way, and no longer.
constexpr unsigned kLooksAtStop = 100;

}  // namespace

struct SpiMaster {  // for AskedSpi
  static void open() {
    player::close();
    kPartClock.set_low().write(kPartClock.mask());
    kPartClock.configuration().write(Pin::kClockOutput);
    kPartOutput.set_low().write(kPartOutput.mask());
    kPartInput.configuration().write(Pin::kInputPulledUp);
    kPartSpi.clock_pin().write(kPartClock.number());
    kPartSpi.output_pin().write(kPartOutput.number());
    kPartSpi.input_pin().write(kPartInput.number());
    kPartSpi.frequency().write(Spim::k1MHz);
    kPartSpi.configuration().write(Spim::kMode0);
    kPartSpi.interrupt_on().write(Spim::kWhenEnded);
    kPartSpi.enable().write(Spim::kOn);
  }

  // The module does not change the levels that the ports give its pins: both are low.
  static void close() {
    kPartSpi.enable().write(0);
    kPartClock.configuration().write(Pin::kOutput);
    kPartInput.configuration().write(Pin::kOutput);
    player::start();
  }

  static void begin(std::span<const std::byte> out, std::span<std::byte> in) {
    const auto bytes = static_cast<std::uint32_t>(out.size());
    kPartSpi.send_from().write(port::bus_address(out.data()));
    kPartSpi.send_count().write(bytes);
    kPartSpi.receive_to().write(port::bus_address(in.data()));
    kPartSpi.receive_count().write(bytes);
    kPartSpi.start().write(kDoIt);
  }

  static Transfer on_interrupt() {
    if (kPartSpi.ended().read() == 0) return Transfer::goes_on;
    forget(kPartSpi.ended());
    return kPartSpi.received().read() == kPartSpi.receive_count().read() ? Transfer::done
                                                                         : Transfer::failed;
  }

  // A transfer that is stopped ends, too.
  static void let_go() {
    forget(kPartSpi.stopped());
    kPartSpi.stop().write(kDoIt);
    unsigned looks = kLooksAtStop;
    static_cast<void>(happens(kPartSpi.stopped(), looks));
    kPartSpi.enable().write(0);
    forget(kPartSpi.ended());
    kPartSpi.enable().write(Spim::kOn);
  }

  static void begin_select(std::uint16_t pin) { pins::select(pin, false); }
  static void select(std::uint16_t pin, bool on) { pins::select(pin, on); }
  // A pin for pulses is low again; the one at the enable input stays high.
  static void end_select(std::uint16_t pin) { pins::end_select(pin); }
};

void switch_spi_off() {
  kPartSpi.enable().write(0);
}

}  // namespace robosync::boards::microbit

template class robosync::boards::AskedSpi<robosync::boards::microbit::SpiMaster>;
