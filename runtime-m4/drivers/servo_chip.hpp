// Serves the servo chips of a program, from the thread of each: not from those that move the servos, nor from the output guard,
// which never waits for a bus.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {

// A chip's place on its bus, and who else may want that.
struct ChipBus {
  kernel::Kernel& kernel;
  boards::Board& board;
  kernel::Mutex& buses;  // one thread at a time has them; it is taken for one transfer at a time
  std::uint8_t bus, address;
};

// One frame of `sensor` of the image, which is a PCA9685: is it as it was set up? What pulses does it lack? False when it has not
// answered; where that leaves its pulses in doubt, its outputs are off. At most 17 transfers of 3 bytes or less, or 7 of 5,
// three times each.  [thread of the sensor]
[[nodiscard]] bool serve_pca9685(const ChipBus& bus, guard::OutputGuard& outputs, unsigned sensor);

}  // namespace robosync::drivers
