// Helpers for tests of the line: frames as owned values, and everything a decoder makes of a
// stream.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "link/frame.hpp"

namespace robosync::test {

using Bytes = std::vector<std::byte>;

struct OwnedFrame {
  link::MessageType type{};
  std::uint8_t sequence = 0;
  Bytes payload;
  bool operator==(const OwnedFrame&) const = default;
};

inline Bytes encode(const OwnedFrame& frame) {
  std::array<std::byte, link::kMaxEncodedFrame> out{};
  const std::size_t length = link::encode_frame(frame.type, frame.sequence, frame.payload, out);
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(length)};
}

inline std::vector<OwnedFrame> decode(const Bytes& stream, link::FrameDecoder& decoder) {
  std::vector<OwnedFrame> frames;
  for (const std::byte byte : stream) {
    if (!decoder.push(byte)) continue;
    const link::Frame& frame = decoder.frame();
    frames.push_back(
        {frame.type, frame.sequence, Bytes(frame.payload.begin(), frame.payload.end())});
  }
  return frames;
}

inline std::vector<OwnedFrame> decode(const Bytes& stream) {
  link::FrameDecoder decoder;
  return decode(stream, decoder);
}

}  // namespace robosync::test
