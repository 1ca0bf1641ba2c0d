// The memory that bytecode works on: the frames of all behaviours, one behind the other, and what
// their time words remember.
#pragma once

#include <array>
#include <cstdint>

#include "runtime-m4/layers/program.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

class Frames {
public:
  // Nothing is known, nothing remembered.
  void start() {
    cells_.fill(vm::kUnknown);
    timer_memory_.fill(0);
  }

  // A machine for one behaviour. Its random numbers depend on the program's seed and on the number
  // of the behaviour only.
  vm::Machine machine(const Program& program, unsigned behavior);

  // Puts the inputs of `behavior` into its frame: value(input) is what each is.
  template <class ValueOf>
  static void latch(const vm::Machine& machine, const vm::Image& image,
                    const vm::Behavior& behavior, ValueOf value) {
    for (unsigned i = 0; i < behavior.input_count; ++i)
      machine.frame[i] = value(image.inputs[behavior.first_input + i]);
  }

private:
  std::array<vm::Value, kMaxFrameCells> cells_{};
  std::array<std::uint32_t, kMaxTimerWords> timer_memory_{};
};

}  // namespace robosync::layers
