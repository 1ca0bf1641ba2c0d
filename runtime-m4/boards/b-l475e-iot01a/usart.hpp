// USART1, which the ST-Link of the board makes a serial port of USB: the link's serial line. UART4: the one to a sound player.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"
#include "runtime-m4/boards/common/player_line.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards::l475 {

template <const Usart& kUsart>
struct Transmitter {
  static void take_pin(unsigned pin) {
    kUsart.port.function(pin).set_field(pin % 8, 4, kUsart.function);
    kUsart.port.mode().set_field(pin, 2, kModeOfFunction);
  }

  static bool can_send() { return kUsart.state().has(Usart::kEmpty); }
  static void send(std::byte byte) {
    kUsart.transmit().write(std::to_integer<std::uint32_t>(byte));
  }

  // It interrupts as long as its register is empty, unless it is told that nothing comes. When the handler does that
  // between the reading and the writing here, it is called once in vain.
  static void begin_to_send() { kUsart.control().set(Usart::kInterruptWhenEmpty); }
  static void nothing_to_send() { kUsart.control().clear(Usart::kInterruptWhenEmpty); }
  static bool wants_to_send() { return kUsart.control().has(Usart::kInterruptWhenEmpty); }
};

struct Usart1 : Transmitter<kUsart1> {  // for SerialLine
  static void start() {
    rcc::give_clock(rcc::kApb2, rcc::kUsart1);
    for (const unsigned pin : {kLinkTransmitPin, kLinkReceivePin}) {
      kUsart1.port.pulls().set_field(pin, 2, kPullUp);  // a line that nobody drives is silent
      take_pin(pin);
    }
    kUsart1.baud_divider().write(Usart::divider_of(kBaud));
    kUsart1.control3().write(Usart::kNoOverrun);
    kUsart1.control().write(Usart::kOn);
    port::core::enable_interrupt(kUsart1.interrupt);
  }

  static bool has_received() { return kUsart1.state().has(Usart::kReceived); }
  static std::byte receive() { return static_cast<std::byte>(kUsart1.received().read()); }
};
using Line = SerialLine<Usart1>;

struct Uart4 : Transmitter<kUart4> {  // for PlayerLine
  static void start() {
    rcc::give_clock(rcc::kApb1, rcc::kUart4);
    take_pin(kPlayerTransmitPin);
    kUart4.baud_divider().write(Usart::divider_of(policy::kPlayerBaud));
    kUart4.control().write(Usart::kSendsOnly);
    port::core::enable_interrupt(kUart4.interrupt);
  }
};
using Player = PlayerLine<Uart4>;

}  // namespace robosync::boards::l475
