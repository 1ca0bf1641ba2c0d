// See inputs.hpp.
#include "runtime-m4/boards/stm32l4/inputs.hpp"

#include "runtime-m4/boards/common/inputs.hpp"

namespace robosync::boards::stm32l4::inputs {

using wiring::kInputs;

// The pull-up comes first: after reset most pins are analog, or belong to the debugger.
void start() {
  for (const Input& input : kInputs) {
    input.port.pulls().set_field(input.bit, 2, kPullUp);
    input.port.mode().set_field(input.bit, 2, kModeOfInput);
  }
}

bool is_high(std::uint16_t pin) {
  const std::size_t i = find_input(kInputs, pin);
  return i < kInputs.size() && is_high(kInputs[i]);
}

}  // namespace robosync::boards::stm32l4::inputs
