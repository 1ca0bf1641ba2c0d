// How far a transfer on a bus has come, and a request for one that was asked ahead.
#pragma once

#include <cstdint>

namespace robosync::boards {

enum class Transfer : std::uint8_t { goes_on, done, failed };

enum class RequestState : std::uint8_t { waits, runs, done, failed };
constexpr bool is_under_way(RequestState state) {
  return state == RequestState::waits || state == RequestState::runs;
}

}  // namespace robosync::boards
