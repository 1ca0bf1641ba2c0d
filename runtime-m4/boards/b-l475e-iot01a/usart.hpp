// USART1, which the ST-Link of the board makes a serial port of USB: the link's serial line.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"
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

}  // namespace robosync::boards::l475
