// The serial line to a sound player, over a UART that holds one byte: interrupts send a command, and nothing is received.
//
// Hardware implements the UART access: start(), can_send(), send(byte), begin_to_send() and nothing_to_send(), as in
// boards/common/serial_line.hpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards {

template <typename Hardware>
class PlayerLine {
public:
  static void start() { Hardware::start(); }

  // See boards::Board::say(). Call it with the UART's interrupt masked.
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
  std::size_t sent_ = command_.size();  // bytes of command_
};

}  // namespace robosync::boards
