// What the link has of the processor for sure, though its thread ranks below the whole program: the step thread waits for it
// between two passes. So a host can always ask, stop, go back and upload (a sporadic server; Sprunt, Sha and Lehoczky, 1989).
// Pure; layers/link_share.hpp keeps it, analysis/ counts it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace robosync::policy {

// A turn ends with the tick after the next one, or when nothing is left to do. After one that was so long there is none for a
// period; after a shorter one, for as many times its length.
inline constexpr std::uint32_t kLinkTurnMs = 2;
inline constexpr std::uint32_t kLinkPeriodMs = 40;

// Who has no more of the processor than one part in so many waits.
inline constexpr std::uint32_t kLinkParts = kLinkPeriodMs / kLinkTurnMs;

// From the last byte of a request that takes no long work to its answer, at most.
inline constexpr std::uint32_t kAnswerMs = 10;

// So long the link waits for the program to leave it some time, before it takes a turn. A request may come when a pass begins,
// and be seen at the pass's end; and the next pass may begin just before the time is over. `step_cost`: of the program.
constexpr std::uint32_t link_patience_us(std::uint32_t step_cost) {
  constexpr std::uint32_t kAnsweringUs = 1000;
  constexpr std::uint32_t kMostUs = 1000 * kAnswerMs - kAnsweringUs;
  constexpr std::uint32_t kInstructionsAMs =
      12'500;  // of the slowest board, with what a pass has besides
  const std::uint64_t passes_us = std::uint64_t{step_cost} * 2 * 1000 / kInstructionsAMs;
  return kMostUs - static_cast<std::uint32_t>(std::min<std::uint64_t>(passes_us, kMostUs));
}

}  // namespace robosync::policy
