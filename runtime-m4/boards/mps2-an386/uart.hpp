// UART0: the link's serial line. Interrupts move bytes between the line and two rings, and tell who
// reads and writes when there is something to do.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/frame.hpp"
#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/ring.hpp"

namespace robosync::boards::mps2 {

class Uart {
public:
  // Starts the line at 115200 baud. Its interrupts come once the kernel runs.
  void start(const LineEvents& events);

  // Both return at once with the number of bytes moved. [one thread each]
  std::size_t write(std::span<const std::byte> bytes);
  std::size_t read(std::span<std::byte> bytes) { return received_.read(bytes); }

  // [interrupt]
  void on_receive();
  void on_transmit();

private:
  static constexpr std::size_t kSendBuffer = 256;

  Ring<kReceiveBuffer> received_;
  Ring<kSendBuffer> to_send_;
  std::atomic<bool> wants_room_ = false;  // who writes waits until half of the ring is free
  link::StopDetector stops_;
  LineEvents events_;
};

}  // namespace robosync::boards::mps2
