// See frames.hpp.
#include "runtime-m4/layers/frames.hpp"

#include <algorithm>

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

std::size_t Frames::closed_words(const LoadedProgram& program) {
  constexpr std::size_t kUnit = kWorkspaceUnit / sizeof(std::uint32_t);
  const std::size_t words = program.safety_cells + std::size_t{program.safety_timer_words};
  return (words + kUnit - 1) / kUnit * kUnit;
}

void Frames::start(const LoadedProgram& program) {
  const std::span memory = workspace_.memory;
  std::ranges::fill(memory, 0);
  const auto unknown = static_cast<std::uint32_t>(vm::kUnknown);
  std::ranges::fill(memory.first(program.safety_cells), unknown);
  std::ranges::fill(memory.subspan(closed_words(program), kMaxFrameCells - program.safety_cells),
                    unknown);
}

// The timers of a behaviour are numbered from the first one of the program.
vm::Machine Frames::machine(const LoadedProgram& program, unsigned behavior) const {
  std::uint32_t* const memory = workspace_.memory.data();
  const bool safety = behavior < program.first_behavior();
  std::size_t frame = safety ? 0 : closed_words(program);
  const std::size_t timers =
      safety ? program.safety_cells
             : frame + kMaxFrameCells - program.safety_cells - program.safety_timer_words;
  for (unsigned before = program.first_behavior(); before < behavior; ++before)
    frame += program.image.behaviors[before].cells;
  vm::Machine machine;
  machine.frame = reinterpret_cast<vm::Value*>(memory + frame);
  machine.constants = program.image.constants.data();
  machine.timers = program.image.timers.data();
  machine.timer_memory = memory + timers;
  machine.random = seed_of(program.image.header->seed, behavior);
  return machine;
}

}  // namespace robosync::layers
