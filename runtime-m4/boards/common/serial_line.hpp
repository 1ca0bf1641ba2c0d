// The link's serial line over a UART that holds one byte each way. Interrupts move bytes between the line and two rings, and
// tell the reader and the writer when there is something to do.
//
// Hardware implements the UART access: start(), which enables its interrupts for when the kernel runs; can_send(),
// send(byte), has_received(), receive(); begin_to_send(), after which on_transmit() is called, even if no byte has left;
// and nothing_to_send(), after which it is not called until the next begin_to_send().
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/frame.hpp"
#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/ring.hpp"

namespace robosync::boards {

inline constexpr std::uint32_t kBaud = 115'200;

template <typename Hardware>
class SerialLine {
public:
  void start(const LineEvents& events) {
    events_ = events;
    Hardware::start();
  }

  // Both return immediately with the number of bytes moved. [one thread each]
  //
  // The handler fills the UART and continues on its own with each byte that has left. begin_to_send() calls it after
  // wants_room_ is set, so it sees the flag even if the last byte has just left.
  std::size_t write(std::span<const std::byte> bytes) {
    const std::size_t count = to_send_.write(bytes);
    if (count < bytes.size()) wants_room_.store(true);
    Hardware::begin_to_send();
    return count;
  }
  std::size_t read(std::span<std::byte> bytes) { return received_.read(bytes); }

  // Bytes that find the ring full are lost; the link checks its frames and repeats them. A stop is never lost. [interrupt]
  void on_receive() {
    std::array<std::byte, 1> next{};
    for (unsigned i = 0; i < kBurst && Hardware::has_received(); ++i) {
      next[0] = Hardware::receive();
      received_.write(next);
      if (stops_.push(next[0])) events_.stop(events_.argument);
    }
    events_.ready(events_.argument);
  }

  // [interrupt]
  void on_transmit() {
    std::array<std::byte, 1> next{};
    for (unsigned i = 0; i < kBurst && Hardware::can_send(); ++i) {
      if (to_send_.read(next) == 0) {
        Hardware::nothing_to_send();
        break;
      }
      Hardware::send(next[0]);
    }
    if (!wants_room_.load() || to_send_.used() > kSendBuffer / 2) return;
    wants_room_.store(false);
    events_.ready(events_.argument);
  }

private:
  static constexpr std::size_t kSendBuffer = 256;
  // Most bytes that one interrupt moves, so that it never delays others for long.
  static constexpr unsigned kBurst = 16;

  Ring<kReceiveBuffer> received_;
  Ring<kSendBuffer> to_send_;
  std::atomic<bool> wants_room_ = false;  // the writer waits until half of the ring is free
  link::StopDetector stops_;
  LineEvents events_;
};

}  // namespace robosync::boards
