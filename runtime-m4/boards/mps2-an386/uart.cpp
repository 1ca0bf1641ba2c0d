#include "runtime-m4/boards/mps2-an386/uart.hpp"

#include <array>

#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards::mps2 {

namespace {

constexpr std::uint32_t kBaud = 115'200;
// Bytes one interrupt moves at most, so that it never keeps others waiting for long.
constexpr unsigned kBurst = 16;

UartRegisters& uart() {
  return at<UartRegisters>(kUart0);
}

}  // namespace

void Uart::start(const LineEvents& events) {
  events_ = events;
  uart().baud_divider = kClockHz / kBaud;
  uart().control = kUartControlOn;
  port::core::enable_interrupt(kUart0ReceiveInterrupt);
  port::core::enable_interrupt(kUart0TransmitInterrupt);
}

// The handler sends while there is room and goes on by itself with each byte that has left. It is
// called in any case, and behind wants_room_: so it sees that, even when the last byte has just left.
std::size_t Uart::write(std::span<const std::byte> bytes) {
  const std::size_t count = to_send_.write(bytes);
  if (count < bytes.size()) wants_room_.store(true);
  port::core::pend_interrupt(kUart0TransmitInterrupt);
  return count;
}

void Uart::on_transmit() {
  uart().interrupt = kUartTransmitted;
  std::array<std::byte, 1> next{};
  for (unsigned i = 0; i < kBurst && (uart().state & kUartStateTransmitFull) == 0; ++i) {
    if (to_send_.read(next) == 0) break;
    uart().data = std::to_integer<std::uint32_t>(next[0]);
  }
  if (!wants_room_.load() || to_send_.used() > kSendBuffer / 2) return;
  wants_room_.store(false);
  events_.ready(events_.argument);
}

// Bytes that find the ring full are lost; the link's frames are checked and asked for again. A stop is not.
void Uart::on_receive() {
  uart().interrupt = kUartReceived;
  std::array<std::byte, 1> next{};
  for (unsigned i = 0; i < kBurst && (uart().state & kUartStateReceiveFull) != 0; ++i) {
    next[0] = static_cast<std::byte>(uart().data);
    received_.write(next);
    if (stops_.push(next[0])) events_.stop(events_.argument);
  }
  events_.ready(events_.argument);
}

}  // namespace robosync::boards::mps2
