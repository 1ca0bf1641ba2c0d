// A block of images as the host hands it to the board: header, then for each image an entry and its
// bytes, padded to 4. Little-endian. Every entry says what the host has found.
#pragma once

#include <cstdint>

#include "vm/verifier.hpp"

namespace robosync::fuzz {

inline constexpr std::uint32_t kBlockMagic = 0x315A5546;  // "FUZ1"

enum class Mode : std::uint32_t {
  run,    // verify every image, and run those that are accepted
  stray,  // write outside once, and do not expect the fault: the trap must be seen to work
};

struct BlockHeader {
  std::uint32_t magic;
  Mode mode;
  std::uint32_t images;
  std::uint32_t reserved;
};

struct Entry {
  std::uint32_t size;  // bytes
  std::uint32_t seed;  // of the inputs
  std::uint32_t tight;
  std::uint32_t verdict;  // verdict_word()
  std::uint32_t hash;     // Facts::hash; 0 where it is refused
};

constexpr std::uint32_t verdict_word(const vm::Verdict& verdict) {
  return static_cast<std::uint32_t>(verdict.refusal) |
         static_cast<std::uint32_t>(verdict.section) << 8 | std::uint32_t{verdict.index} << 16;
}

// What a fuzzed image is verified against: what a board offers, but for steps that are short enough
// to run many; `tight`: so little that images meet its limits.
constexpr vm::Limits limits(bool tight) {
  vm::Limits limits;
  limits.step_cost = 60000;
  if (!tight) return limits;
  limits.image_bytes = 900;
  limits.step_cost = 900;
  limits.frame_cells = 12;
  limits.timer_words = 4;
  limits.samples = 4;
  limits.rules = 3;
  limits.inputs = 9;
  limits.behaviors = 2;
  limits.sensors = 3;
  limits.actuators = 4;
  limits.drivers = 0x39;
  return limits;
}

}  // namespace robosync::fuzz
