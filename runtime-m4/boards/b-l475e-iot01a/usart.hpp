// USART1, which the ST-Link of the board makes a serial port of USB: the link's serial line. UART4: the one to a sound player.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"
#include "runtime-m4/boards/common/player_line.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards::l475 {

struct Usart1 {  // for SerialLine
  static void start() {
    rcc::give_clock(rcc::kApb2, rcc::kUsart1);
    for (const unsigned pin : {usart1::kTransmitPin, usart1::kReceivePin}) {
      usart1::kPort.function(pin).set_field(pin % 8, 4, usart1::kFunction);
      usart1::kPort.pulls().set_field(pin, 2, kPullUp);  // a line that nobody drives is silent
      usart1::kPort.mode().set_field(pin, 2, kModeOfFunction);
    }
    usart1::kBaudDivider.write((kClockHz + kBaud / 2) / kBaud);
    usart1::kControl3.write(usart1::kNoOverrun);
    usart1::kControl.write(usart1::kOn);
    port::core::enable_interrupt(usart1::kInterrupt);
  }

  static bool can_send() { return usart1::kState.has(usart1::kEmpty); }
  static void send(std::byte byte) {
    usart1::kTransmit.write(std::to_integer<std::uint32_t>(byte));
  }
  static bool has_received() { return usart1::kState.has(usart1::kReceived); }
  static std::byte receive() { return static_cast<std::byte>(usart1::kReceive.read()); }

  // It interrupts as long as its register is empty, unless it is told that nothing comes. When the handler does that
  // between the reading and the writing here, it is called once in vain.
  static void begin_to_send() { usart1::kControl.set(usart1::kInterruptWhenEmpty); }
  static void nothing_to_send() { usart1::kControl.clear(usart1::kInterruptWhenEmpty); }
  static bool wants_to_send() { return usart1::kControl.has(usart1::kInterruptWhenEmpty); }
};
using Line = SerialLine<Usart1>;

struct Uart4 {  // for PlayerLine
  static void start() {
    rcc::give_clock(rcc::kApb1, rcc::kUart4);
    uart4::kPort.function(uart4::kTransmitPin)
        .set_field(uart4::kTransmitPin % 8, 4, uart4::kFunction);
    uart4::kPort.mode().set_field(uart4::kTransmitPin, 2, kModeOfFunction);
    uart4::kBaudDivider.write((kClockHz + kPlayerBaud / 2) / kPlayerBaud);
    uart4::kControl.write(uart4::kOn);
    port::core::enable_interrupt(uart4::kInterrupt);
  }

  static bool can_send() { return uart4::kState.has(uart4::kEmpty); }
  static void send(std::byte byte) { uart4::kTransmit.write(std::to_integer<std::uint32_t>(byte)); }
  static void begin_to_send() { uart4::kControl.set(uart4::kInterruptWhenEmpty); }
  static void nothing_to_send() { uart4::kControl.clear(uart4::kInterruptWhenEmpty); }
};
using Player = PlayerLine<Uart4>;

}  // namespace robosync::boards::l475
