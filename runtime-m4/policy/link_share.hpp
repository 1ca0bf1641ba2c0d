// What the link has of the processor for sure, though its thread ranks below the whole program: when the program has left it
// nothing for a period, the step thread waits so long between two passes. So a host can always ask, stop, go back and upload
// (a polling server; Sprunt, Sha and Lehoczky, 1989). Pure; layers/link_share.hpp keeps it, analysis/ counts it.
#pragma once

#include <cstdint>

namespace robosync::policy {

inline constexpr std::uint32_t kLinkTurnMs =
    2;  // turns begin between ticks and end at one: at least 1 ms
inline constexpr std::uint32_t kLinkPeriodMs = 40;

// Who has less than one part in so many has nothing.
inline constexpr std::uint32_t kLinkParts = kLinkPeriodMs / kLinkTurnMs;

}  // namespace robosync::policy
