// The serial line to a sound player, over a UART that holds a byte: interrupts send a command, and nothing is received.
//
// Hardware says how the UART does it: start(), can_send(), send(byte), begin_to_send() and nothing_to_send(), as
// boards/common/serial_line.hpp has them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards {

template <typename Hardware>
class PlayerLine {
public:
  static void start() { Hardware::start(); }

  // boards::Board::say(). While its interrupt is held off.
  void say(const policy::PlayerCommand& command) {
    command_ = command;
    sent_ = 0;
    Hardware::begin_to_send();
  }

  // [interrupt]
  void on_transmit() {
    if (sent_ == command_.size()) return Hardware::nothing_to_send();
    if (Hardware::can_send()) Hardware::send(command_[sent_++]);
  }

private:
  policy::PlayerCommand command_{};
  std::size_t sent_ = command_.size();  // of its bytes
};

}  // namespace robosync::boards
