// The link's guaranteed share of the processor. Its thread ranks below the whole program, so the step thread waits for it between
// two passes. So a host can always make requests, stop, go back and upload (a sporadic server; Sprunt, Sha and Lehoczky, 1989).
// Pure; layers/link_share.hpp implements it, analysis/ counts it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace robosync::policy {

// A turn ends with the tick after the next one, or when the link has nothing left to do. After a turn of full length, the next
// one begins a period later at the earliest; after a shorter turn, proportionally earlier.
inline constexpr std::uint32_t kLinkTurnMs = 2;
inline constexpr std::uint32_t kLinkPeriodMs = 40;

// The link counts as waiting while it has no more than 1/kLinkParts of the processor.
inline constexpr std::uint32_t kLinkParts = kLinkPeriodMs / kLinkTurnMs;

// The longest time from the last byte of a request that takes no long work to its answer.
inline constexpr std::uint32_t kAnswerMs = 10;

// How long the link waits for idle time before it takes a turn. It allows for two passes: a request may arrive when a pass
// begins and be seen only at the pass's end, and the next pass may begin just before the time is over. `step_cost`: instructions
// of one step of the program.
constexpr std::uint32_t link_patience_us(std::uint32_t step_cost) {
  constexpr std::uint32_t kAnsweringUs = 1000;
  constexpr std::uint32_t kMostUs = 1000 * kAnswerMs - kAnsweringUs;
  constexpr std::uint32_t kInstructionsAMs =
      12'500;  // of the slowest board, with a margin for the rest of a pass
  const std::uint64_t passes_us = std::uint64_t{step_cost} * 2 * 1000 / kInstructionsAMs;
  return kMostUs - static_cast<std::uint32_t>(std::min<std::uint64_t>(passes_us, kMostUs));
}

}  // namespace robosync::policy
