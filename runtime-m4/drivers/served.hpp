// A device that is told something in each of its frames, from its own thread, over a bus that others use as well: a servo chip
// (servo_chip.hpp), a display (screen.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::drivers {

// Its place on its bus, and what it takes to share that bus.
struct ServedBus {
  kernel::Kernel& kernel;
  boards::Board& board;
  kernel::Mutex& buses;  // one thread at a time holds them, for one transfer at a time
  std::uint8_t bus, address;
};

// One transfer, tried at most `tries` times. Where the bus works on its own, this requests the transfer, and collects its result
// when it is done. False: it was not acknowledged.  [thread of the device]
[[nodiscard]] bool exchange(const ServedBus& at, std::span<const std::byte> out,
                            std::span<std::byte> in, unsigned tries);

}  // namespace robosync::drivers
