// The serial line to a sound player, over a UART that holds a byte: interrupts send a command, and nothing is received.
//
// Hardware says how the UART does it: start(), can_send(), send(byte), begin_to_send() and nothing_to_send(), as
// boards/common/serial_line.hpp has them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards {

inline constexpr std::uint32_t kPlayerBaud = 9'600;

template <typename Hardware>
class PlayerLine {
public:
  static void start() { Hardware::start(); }

  // boards::Board::say(). While its interrupt is held off.
  void say(std::span<const std::byte> command) {
    end_ = static_cast<std::uint8_t>(std::min(command.size(), bytes_.size()));
    std::copy_n(command.begin(), end_, bytes_.begin());
    sent_ = 0;
    Hardware::begin_to_send();
  }

  // [interrupt]
  void on_transmit() {
    if (sent_ >= end_) return Hardware::nothing_to_send();
    if (Hardware::can_send()) Hardware::send(bytes_[sent_++]);
  }

private:
  std::array<std::byte, kMostSaid> bytes_{};
  std::uint8_t sent_ = 0;
  std::uint8_t end_ = 0;
};

}  // namespace robosync::boards
