// See inputs.hpp. The buttons have their own pull-ups (10 kΩ); the chip's do no harm in addition.
#include "runtime-m4/boards/microbit-v2/inputs.hpp"

#include "runtime-m4/boards/common/inputs.hpp"

namespace robosync::boards::microbit::inputs {

void start() {
  for (const Input& input : kInputs)
    input.chip.configuration().write(Pin::kInputPulledUp);
}

bool is_high(std::uint16_t pin) {
  const std::size_t i = find_input(kInputs, pin);
  return i < kInputs.size() && is_high(kInputs[i]);
}

}  // namespace robosync::boards::microbit::inputs
