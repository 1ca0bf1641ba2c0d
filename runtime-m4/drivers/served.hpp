// What is told something in each of its frames, from a thread of its own, over a bus that others use as well: a servo chip
// (servo_chip.hpp), a display (screen.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::drivers {

// Its place on its bus, and who else may want that.
struct ServedBus {
  kernel::Kernel& kernel;
  boards::Board& board;
  kernel::Mutex& buses;  // one thread at a time has them; it is taken for one transfer at a time
  std::uint8_t bus, address;
};

// One transfer, tried so many times at most. Where the bus works by itself, what is wanted is said, and asked about when it is
// done. False: it was not acknowledged.  [thread of the device]
[[nodiscard]] bool exchange(const ServedBus& at, std::span<const std::byte> out,
                            std::span<std::byte> in, unsigned tries);

}  // namespace robosync::drivers
