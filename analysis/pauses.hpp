// How soon a response may go on after its pauses, and how soon again.
#pragma once

#include <cstdint>
#include <limits>

#include "analysis/walk.hpp"

namespace robosync::analysis {

// What the pauses of a rule have in common. kNever: there is none.
struct Pauses {
  static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
  static constexpr unsigned kNoLine = ~0U;

  void note(std::uint32_t ms);
  void note(const Pauses& other);
  // Those that may be over at once come more seldom by themselves, as the others do then.
  [[nodiscard]] bool better_apart() const;
  [[nodiscard]] bool any() const { return least_ms != kNever; }

  std::uint32_t least_ms = kNever;   // the shortest takes at least
  unsigned at_once = 0;              // how many may be over in the next step
  std::uint32_t again_ms = kNever;   // … between two times that one of these is over
  std::uint32_t others_ms = kNever;  // the shortest of all others
  // Of a WAIT that may be over at once since its number may be 0, negative or unknown; 0: the line is
  // not known.
  unsigned line = kNoLine;
};

[[nodiscard]] Pauses pauses_of(const vm::Image& image, const vm::Behavior& behavior,
                               const vm::Response& response, const Ranges& inputs);

}  // namespace robosync::analysis
