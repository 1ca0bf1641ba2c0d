// See inputs.hpp.
#include "runtime-m4/boards/b-l475e-iot01a/inputs.hpp"

#include <array>

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"

namespace robosync::boards::l475::inputs {

namespace {

struct Input {
  std::uint16_t pin;  // of the header
  Port port;
  unsigned bit;
};
constexpr std::array kInputs{Input{7, kPortA, 4}, Input{8, kPortB, 2}, Input{9, kPortA, 15},
                             Input{12, kPortA, 6}, Input{32, kPortC, 13}};

}  // namespace

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
