// The link's serial line, on the USART that the board connects to USB as a serial port, and the sound player's, on another USART.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/common/player_line.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/boards/stm32l4/wiring.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards::stm32l4 {

template <const SerialPins& kPins>
struct Transmitter {
  static constexpr Usart kUsart = kPins.usart;

  static void take_pin(unsigned pin) {
    kPins.port.function(pin).set_field(pin % 8, 4, kPins.function);
    kPins.port.mode().set_field(pin, 2, kModeOfFunction);
  }

  static bool can_send() { return kUsart.state().has(Usart::kEmpty); }
  static void send(std::byte byte) {
    kUsart.transmit().write(std::to_integer<std::uint32_t>(byte));
  }

  // The USART interrupts while its register is empty, unless nothing_to_send() has been called. If the handler calls that
  // between the read and the write in set(), it runs once more without cause.
  static void begin_to_send() { kUsart.control().set(Usart::kInterruptWhenEmpty); }
  static void nothing_to_send() { kUsart.control().clear(Usart::kInterruptWhenEmpty); }
  static bool wants_to_send() { return kUsart.control().has(Usart::kInterruptWhenEmpty); }
};

struct LinkUsart : Transmitter<wiring::kLink> {  // for SerialLine
  static void start() {
    rcc::give_clock(kUsart.clocks, kUsart.clock);
    for (const unsigned pin : {wiring::kLink.transmit, wiring::kLink.receive}) {
      wiring::kLink.port.pulls().set_field(pin, 2, kPullUp);  // an undriven line stays silent
      take_pin(pin);
    }
    kUsart.baud_divider().write(Usart::divider_of(kBaud));
    kUsart.control3().write(Usart::kNoOverrun);
    kUsart.control().write(Usart::kOn);
    port::core::enable_interrupt(kUsart.interrupt);
  }

  static bool has_received() { return kUsart.state().has(Usart::kReceived); }
  static std::byte receive() { return static_cast<std::byte>(kUsart.received().read()); }
};
using Line = SerialLine<LinkUsart>;

struct PlayerUsart : Transmitter<wiring::kPlayer> {  // for PlayerLine
  static void start() {
    rcc::give_clock(kUsart.clocks, kUsart.clock);
    take_pin(wiring::kPlayer.transmit);
    kUsart.baud_divider().write(Usart::divider_of(policy::kPlayerBaud));
    kUsart.control().write(Usart::kSendsOnly);
    port::core::enable_interrupt(kUsart.interrupt);
  }
};
using Player = PlayerLine<PlayerUsart>;

}  // namespace robosync::boards::stm32l4
