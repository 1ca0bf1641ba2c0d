// See frames.hpp.
#include "runtime-m4/layers/frames.hpp"

#include <algorithm>

namespace robosync::layers {
namespace {

// A separate seed for each behaviour: adjacent numbers must not give adjacent states
// (the finalizer of MurmurHash3, which is a bijection). 0 is not a state of the VM's generator.
std::uint32_t seed_of(std::uint32_t program_seed, unsigned behavior) {
  constexpr std::uint32_t kGoldenRatio = 0x9E37'79B9;
  std::uint32_t state = program_seed + (behavior + 1) * kGoldenRatio;
  state = (state ^ state >> 16) * 0x85EB'CA6B;
  state = (state ^ state >> 13) * 0xC2B2'AE35;
  state ^= state >> 16;
  return state != 0 ? state : 1;
}

}  // namespace

void Frames::start(std::uint32_t seed, const SafetyRegion& safety) {
  seed_ = seed;
  safety_cells_ = safety.cells;
  safety_timers_ = safety.timer_words;
  const auto unknown = static_cast<std::uint32_t>(vm::kUnknown);
  std::ranges::fill(safety_cells_, unknown);
  std::ranges::fill(workspace_.cells, unknown);
}

vm::Value* Frames::frame(const LoadedProgram& program, unsigned behavior) const {
  const unsigned first = program.first_behavior();
  std::size_t begin = 0;
  for (unsigned before = first; before < behavior; ++before)
    begin += program.image.behaviors[before].cells;
  const std::span<std::uint32_t> cells = behavior < first ? safety_cells_ : workspace_.cells;
  return reinterpret_cast<vm::Value*>(cells.data() + begin);
}

// Timers are numbered from the program's first one, which is SAFETY's.
vm::Machine Frames::machine(const LoadedProgram& program, unsigned behavior) const {
  const bool safety = behavior < program.first_behavior();
  vm::Machine machine;
  machine.frame = frame(program, behavior);
  machine.constants = program.image.constants.data();
  machine.timers = program.image.timers.data();
  machine.timer_memory =
      safety ? safety_timers_.data() : workspace_.timer_words.data() - safety_timers_.size();
  machine.random = seed_of(seed_, behavior);
  return machine;
}

}  // namespace robosync::layers
