// See inputs.hpp.
#include "runtime-m4/boards/b-l475e-iot01a/inputs.hpp"

namespace robosync::boards::l475::inputs {

// The pull first: out of reset most pins are analog, and 9 belongs to the debugger.
void start() {
  for (const Input& input : kInputs) {
    input.port.pulls().set_field(input.bit, 2, kPullUp);
    input.port.mode().set_field(input.bit, 2, kModeOfInput);
  }
}

bool is_high(std::uint16_t pin) {
  for (const Input& input : kInputs)
    if (input.pin == pin) return input.port.levels().has(1U << input.bit);
  return false;
}

}  // namespace robosync::boards::l475::inputs
