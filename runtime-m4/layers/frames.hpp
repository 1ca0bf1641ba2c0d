// The memory that bytecode works on: the frames of all behaviours, one after the other, and the state
// of their time words. It is part of the workspace; SAFETY rules work on a region of their own.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/safety_region.hpp"
#include "runtime-m4/layers/workspace.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

class Frames {
public:
  explicit Frames(Workspace& workspace) : workspace_(workspace) {}

  // Nothing is known or remembered; random numbers begin with `seed`. After the workspace.
  void start(std::uint32_t seed, const SafetyRegion& safety);

  vm::Value* frame(const LoadedProgram& program, unsigned behavior) const;
  // A machine for one behaviour. Its random numbers depend only on the program's seed and on the
  // behaviour's number.
  vm::Machine machine(const LoadedProgram& program, unsigned behavior) const;

  // Copies the inputs of `behavior` into its frame; value(input) returns each one.
  template <class ValueOf>
  static void latch(const vm::Machine& machine, const vm::Image& image,
                    const vm::Behavior& behavior, ValueOf value) {
    latch(machine.frame, image.inputs.subspan(behavior.first_input, behavior.input_count), value);
  }
  // Loads everything once, where the compiler would reload after every write; and the loop tests at its end.
  template <class ValueOf>
  static void latch(vm::Value* cell, std::span<const std::uint8_t> inputs, ValueOf value) {
    std::size_t left = inputs.size();
    if (left == 0) return;
    const std::uint8_t* input = inputs.data();
    do {
      *cell++ = value(*input++);
    } while (--left != 0);
  }

private:
  Workspace& workspace_;
  std::span<std::uint32_t> safety_cells_;
  std::span<std::uint32_t> safety_timers_;
  std::uint32_t seed_ = 1;
};

}  // namespace robosync::layers
