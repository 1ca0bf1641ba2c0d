// Compares what a replay decides with what was recorded.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "link/events.hpp"
#include "rsc/json.hpp"
#include "rsc/trace/replay.hpp"
#include "rsc/trace/replay_file.hpp"
#include "rsc/trace/trace_format.hpp"

namespace robosync::tool {

// An event recorded later than replayed by more than this is a different event. One servo frame: no movement is shorter.
inline constexpr std::uint64_t kMostLateUs = 20'000;

// Whether the lines of rules are compared: two programs that decide the same may differ in them.
enum class Lines : std::uint8_t { compared, of_another };

// What the replay decides.
// NOLINTNEXTLINE(bugprone-exception-escape): JSON ends itself with memory of its own
struct Decided {
  Json line;
  link::Event event;
};

struct Compared {
  Replayed result;
  // The first time at which SAFETY did something in the replay only.
  std::optional<std::uint64_t> safety_alone_us;
};

// Excludes what is fed to the program and what only depends on the board.
[[nodiscard]] bool is_compared(std::string_view kind);

// `replayed`: only what is compared.
[[nodiscard]] Compared compare(const std::vector<RecordedEvent>& recorded,
                               const std::vector<Decided>& replayed, Lines lines,
                               const TraceNames& names);

}  // namespace robosync::tool
