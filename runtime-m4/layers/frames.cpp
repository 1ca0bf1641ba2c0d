// See frames.hpp.
#include "runtime-m4/layers/frames.hpp"

namespace robosync::layers {
namespace {

// A seed of its own for each behaviour: neighbours in number must not be neighbours in state
// (the finalizer of MurmurHash3, which is a bijection). 0 is no state of the VM's generator.
std::uint32_t seed_of(std::uint32_t program_seed, unsigned behavior) {
  constexpr std::uint32_t kGoldenRatio = 0x9E37'79B9;
  std::uint32_t state = program_seed + (behavior + 1) * kGoldenRatio;
  state = (state ^ state >> 16) * 0x85EB'CA6B;
  state = (state ^ state >> 13) * 0xC2B2'AE35;
  state ^= state >> 16;
  return state != 0 ? state : 1;
}

}  // namespace

vm::Machine Frames::machine(const Program& program, unsigned behavior) {
  vm::Machine machine;
  machine.frame = cells_.data();
  for (const vm::Behavior& before : program.image.behaviors.first(behavior))
    machine.frame += before.cells;
  machine.constants = program.image.constants.data();
  machine.timers = program.image.timers.data();
  machine.timer_memory = timer_memory_.data();
  machine.random = seed_of(program.image.header->seed, behavior);
  return machine;
}

}  // namespace robosync::layers
