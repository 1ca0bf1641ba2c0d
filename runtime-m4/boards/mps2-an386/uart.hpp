// UART0: the link's serial line. Interrupts move bytes between the line and two rings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/ring.hpp"

namespace robosync::boards::mps2 {

class Uart {
public:
  // Starts the line at 115200 baud. Its interrupts come once the kernel runs.
  void start();
  // From now on `ready(argument)` is called, from interrupts, when bytes have arrived or there is
  // room for more. Before start().
  void notify(void (*ready)(void*), void* argument);

  // Both return at once with the number of bytes moved. [one thread each]
  std::size_t write(std::span<const std::byte> bytes);
  std::size_t read(std::span<std::byte> bytes) { return received_.read(bytes); }

  // [interrupt]
  void on_receive();
  void on_transmit();

private:
  Ring<kReceiveBuffer> received_;
  Ring<kReceiveBuffer> to_send_;
  void (*ready_)(void*) = [](void*) {};
  void* ready_argument_ = nullptr;
};

}  // namespace robosync::boards::mps2
