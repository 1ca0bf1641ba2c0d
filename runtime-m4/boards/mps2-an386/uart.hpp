// UART0: the link's serial line. UART1: the line to a sound player.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/common/player_line.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards::mps2 {

template <std::uintptr_t kBase, unsigned kInterrupt>
struct Transmitter {
  static UartRegisters& registers() { return at<UartRegisters>(kBase); }

  static void start(std::uint32_t baud, std::uint32_t control) {
    registers().baud_divider = kClockHz / baud;
    registers().control = control;
    port::core::enable_interrupt(kInterrupt);
  }

  static bool can_send() { return (registers().state & kUartStateTransmitFull) == 0; }
  static void send(std::byte byte) { registers().data = std::to_integer<std::uint32_t>(byte); }

  // The UART interrupts only when a byte has left, so the first interrupt is pended here.
  static void begin_to_send() { port::core::pend_interrupt(kInterrupt); }
  static void nothing_to_send() {}

  // Acknowledges the interrupt.
  static void clear_transmitted() { registers().interrupt = kUartTransmitted; }
};

struct Uart0 : Transmitter<kUart0, kUart0TransmitInterrupt> {  // for SerialLine
  static void start() {
    Transmitter::start(kBaud, kUartControlOn);
    port::core::enable_interrupt(kUart0ReceiveInterrupt);
  }

  static bool has_received() { return (registers().state & kUartStateReceiveFull) != 0; }
  static std::byte receive() { return static_cast<std::byte>(registers().data); }
  static void clear_received() { registers().interrupt = kUartReceived; }
};
using Uart = SerialLine<Uart0>;

struct Uart1 : Transmitter<kUart1, kUart1TransmitInterrupt> {  // for PlayerLine
  static void start() { Transmitter::start(policy::kPlayerBaud, kUartSendsOnly); }
};
using Player = PlayerLine<Uart1>;

}  // namespace robosync::boards::mps2
