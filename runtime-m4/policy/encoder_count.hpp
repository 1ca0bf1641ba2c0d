// What an encoder has counted since its program began.
#pragma once

#include <cstdint>

namespace robosync::policy {

struct EncoderCount {
  std::int32_t edges = 0;   // forward, less those backward
  std::uint8_t losses = 0;  // how often there were more than the board counts; wraps
};

}  // namespace robosync::policy
