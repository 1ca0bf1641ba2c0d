// How far a transfer on a bus has come.
#pragma once

#include <cstdint>

namespace robosync::boards {

enum class Transfer : std::uint8_t { goes_on, done, failed };

}  // namespace robosync::boards
