// UART0: the link's serial line. UART1: the one to a sound player.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/common/player_line.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards::mps2 {

struct Uart0 {  // for SerialLine
  static UartRegisters& registers() { return at<UartRegisters>(kUart0); }

  static void start() {
    registers().baud_divider = kClockHz / kBaud;
    registers().control = kUartControlOn;
    port::core::enable_interrupt(kUart0ReceiveInterrupt);
    port::core::enable_interrupt(kUart0TransmitInterrupt);
  }

  static bool can_send() { return (registers().state & kUartStateTransmitFull) == 0; }
  static void send(std::byte byte) { registers().data = std::to_integer<std::uint32_t>(byte); }
  static bool has_received() { return (registers().state & kUartStateReceiveFull) != 0; }
  static std::byte receive() { return static_cast<std::byte>(registers().data); }

  // It interrupts when a byte has left, and not before.
  static void begin_to_send() { port::core::pend_interrupt(kUart0TransmitInterrupt); }
  static void nothing_to_send() {}

  // The interrupts were seen.
  static void clear_received() { registers().interrupt = kUartReceived; }
  static void clear_transmitted() { registers().interrupt = kUartTransmitted; }
};
using Uart = SerialLine<Uart0>;

struct Uart1 {  // for PlayerLine
  static UartRegisters& registers() { return at<UartRegisters>(kUart1); }

  static void start() {
    registers().baud_divider = kClockHz / kPlayerBaud;
    registers().control = kUartSendsOnly;
    port::core::enable_interrupt(kUart1TransmitInterrupt);
  }

  static bool can_send() { return (registers().state & kUartStateTransmitFull) == 0; }
  static void send(std::byte byte) { registers().data = std::to_integer<std::uint32_t>(byte); }
  static void begin_to_send() { port::core::pend_interrupt(kUart1TransmitInterrupt); }
  static void nothing_to_send() {}
  static void clear_transmitted() { registers().interrupt = kUartTransmitted; }
};
using Player = PlayerLine<Uart1>;

}  // namespace robosync::boards::mps2
