// See inputs.hpp. The buttons have pull-ups of their own (10 kΩ); the chip's do no harm beside them.
#include "runtime-m4/boards/microbit-v2/inputs.hpp"

namespace robosync::boards::microbit::inputs {

void start() {
  for (const Input& input : kInputs)
    input.chip.configuration().write(Pin::kInputPulledUp);
}

bool is_high(std::uint16_t pin) {
  for (const Input& input : kInputs)
    if (input.pin == pin) return input.chip.levels().has(input.chip.mask());
  return false;
}

}  // namespace robosync::boards::microbit::inputs
