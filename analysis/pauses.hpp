// How soon a response may go on after its pauses, and how soon it may do so again.
#pragma once

#include <cstdint>
#include <limits>

#include "analysis/walk.hpp"

namespace robosync::analysis {

// The pauses of a rule's responses, taken together. kNever: there are none.
struct Pauses {
  static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
  static constexpr unsigned kNoLine = ~0U;

  void note(std::uint32_t ms);
  void note(const Pauses& other);
  void note_end(std::uint64_t waited_ms);  // the response may end when it has waited so long
  // It is better to count the pauses that may be over immediately on their own: they and the others then come less often.
  [[nodiscard]] bool better_apart() const;
  [[nodiscard]] bool any() const { return least_ms != kNever; }

  std::uint32_t least_ms = kNever;   // the shortest takes at least this long
  unsigned at_once = 0;              // how many may be over in the next step
  std::uint32_t again_ms = kNever;   // … the time between two ends of one of these
  std::uint32_t others_ms = kNever;  // the shortest of all others
  std::uint32_t round_ms =
      kNever;  // from its beginning to its end; of a WHILE, to the next beginning
  // The line of a WAIT that may be over immediately because its number may be 0, negative or unknown;
  // 0: the line is not known.
  unsigned line = kNoLine;
};

[[nodiscard]] Pauses pauses_of(const vm::Image& image, const vm::Behavior& behavior,
                               const vm::Response& response, const Ranges& inputs);

}  // namespace robosync::analysis
