// UART0, which the board's interface chip connects to USB as a serial port: the link's serial line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {

// For SerialLine: everything except enabling the interrupt in the core.
class Uart {
public:
  // Both pins are high, the idle level of a line, before UART0 takes them.
  static void open() {
    uart::kTransmitPin.set_high().write(uart::kTransmitPin.mask());
    uart::kTransmitPin.configuration().write(Pin::kOutput);
    uart::kReceivePin.configuration().write(Pin::kInputPulledUp);
    uart::kTransmitPinSelect.write(uart::kTransmitPin.number());
    uart::kReceivePinSelect.write(uart::kReceivePin.number());
    uart::kBaudRate.write(uart::k115200);
    uart::kEnable.write(uart::kOn);
    sends_ = false;
    forget(uart::kSent);
    forget(uart::kReceived);
    uart::kInterruptOn.write(uart::kWhenReceived);
    uart::kStartTransmitting.write(kDoIt);
    uart::kStartReceiving.write(kDoIt);
  }

  // UART0 takes a byte when the one before has left; it reports that once. [interrupt]
  static bool can_send() {
    if (sends_ && uart::kSent.read() != 0) {
      forget(uart::kSent);
      sends_ = false;
    }
    return !sends_;
  }
  static void send(std::byte byte) {
    sends_ = true;
    uart::kTransmit.write(std::to_integer<std::uint32_t>(byte));
  }

  // Up to five more bytes may wait behind the one that is read; the next one sets the event again.
  static bool has_received() { return holds() || uart::kReceived.read() != 0; }
  static std::byte receive() { return holds() ? static_cast<std::byte>(held_[taken_++]) : next(); }

  // For times when interrupts are delayed by more than six bytes: stores a received byte for receive(). Inlined, because its
  // caller must not execute from flash.
  [[gnu::always_inline]] static void hold() {
    if (uart::kReceived.read() == 0 || count_ == held_.size()) return;
    uart::kReceived.write(0);
    held_[count_] = static_cast<std::uint8_t>(uart::kReceive.read());
    count_ = count_ + 1;
  }
  static bool holds() { return taken_ != count_; }
  // Call it before a series of hold().
  static void let_go() {
    if (holds()) return;
    taken_ = 0;
    count_ = 0;
  }

  static void wants_to_send(bool wants) {
    (wants ? uart::kInterruptOn : uart::kInterruptOff).write(uart::kWhenSent);
  }
  static bool wants_to_send() { return uart::kInterruptOn.has(uart::kWhenSent); }

private:
  static std::byte next() {
    forget(uart::kReceived);
    return static_cast<std::byte>(uart::kReceive.read());
  }

  static inline bool sends_ = false;  // a byte is on its way
  static inline std::array<std::uint8_t, 32> held_{};
  static inline std::size_t count_ = 0;
  static inline std::size_t taken_ = 0;  // of held_
};

}  // namespace robosync::boards::microbit
