// Encoders of wheels: the board counts the edges of each, and a sample makes two inputs of that: 0 is how far the wheel has turned
// since the program began, in edges; 1 its speed, in kSpeedParts of an edge per second.
//
// The speed is that between the last edges of two samples, so a slow wheel has one, too, though not every sample has an edge. Until the
// next edge comes the speed is at most that of an edge now; after kStandsUs the wheel stands still.
#pragma once

#include <array>
#include <cstdint>

#include "runtime-m4/guard/output_guard.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {

class Encoders {
public:
  static constexpr kernel::Duration kStandsUs = 500'000;

  // A sample of one channel of the program's encoder `number`, in counts of its input. All channels are those of the edges that the
  // first one takes. False if edges were lost since the last sample: there were more than the board counts.  [sensor's thread]
  bool sample(guard::OutputGuard& outputs, const vm::Sensor& sensor, unsigned number, bool is_first,
              std::uint8_t input, kernel::Time now, std::int32_t& raw);

private:
  struct Wheel {
    std::int32_t edges = 0;
    std::int32_t speed = 0;
    std::uint32_t last = 0;  // when the last edge was, in microseconds
    bool known = false;
  };
  static void take(guard::OutputGuard& outputs, const vm::Sensor& sensor, unsigned number,
                   kernel::Time time, Wheel& wheel);

  std::array<Wheel, vm::kMaxEncoders> wheels_{};
};

}  // namespace robosync::drivers
