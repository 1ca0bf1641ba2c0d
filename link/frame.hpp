// Frames on the serial line: COBS-coded {type, sequence, payload, CRC-16}, ended by a zero byte.
//
// Any byte lost, flipped, doubled or inserted costs the frame it hits, never the line: the decoder
// starts anew at the next zero byte.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "link/messages.hpp"

namespace robosync::link {

inline constexpr std::size_t kFrameOverhead = 2 + 2;  // type, sequence; CRC-16
// A frame is short enough for a single COBS code byte in front; the delimiter follows.
inline constexpr std::size_t kMaxEncodedFrame = 1 + kMaxPayload + kFrameOverhead + 1;
// What a host may have under way at most, in bytes on the line. A board's receive buffer holds that many: while it verifies
// an image it does not read the line.
inline constexpr std::uint16_t kReceiveWindow = 2 * kMaxEncodedFrame;
static_assert(kMaxPayload + kFrameOverhead < 254, "longer frames need COBS blocks");

struct Frame {
  MessageType type{};
  std::uint8_t sequence = 0;
  std::span<const std::byte> payload;  // valid until the decoder gets its next byte
};

// Encodes a frame with its delimiter into `out`. Returns the number of bytes; 0, and nothing is
// written, when the payload is longer than kMaxPayload.
std::size_t encode_frame(MessageType type, std::uint8_t sequence,
                         std::span<const std::byte> payload,
                         std::span<std::byte, kMaxEncodedFrame> out);

class FrameDecoder {
public:
  // Takes one byte from the line. True when it completed a good frame, now in frame().
  [[nodiscard]] bool push(std::byte byte);
  const Frame& frame() const { return frame_; }
  // Frames dropped: too long, not COBS, or a wrong CRC. Empty ones are not counted.
  std::uint32_t bad_frames() const { return bad_frames_; }

private:
  bool finish();  // at the delimiter: is what stands in the buffer a frame?
  bool decode();

  std::array<std::byte, kMaxEncodedFrame - 1> buffer_{};  // without the delimiter
  std::size_t length_ = 0;
  bool overflow_ = false;
  std::uint32_t bad_frames_ = 0;
  Frame frame_;
};

// The frame that stops the robot is always these bytes: encode_frame(stop, kStopSequence, {}). So who takes bytes from
// the line, an interrupt handler as a rule, knows it without decoding, before anybody else gets the processor.
inline constexpr std::uint8_t kStopSequence = 0xFF;
inline constexpr std::array<std::byte, 6> kStopFrame{std::byte{0x05}, std::byte{0x15},
                                                     std::byte{0xFF}, std::byte{0x79},
                                                     std::byte{0xFF}, std::byte{0}};

class StopDetector {
public:
  // Takes one byte from the line. True when it ended a stop frame.
  [[nodiscard]] bool push(std::byte byte) {
    if (byte == kStopFrame.back()) return std::exchange(place_, 0U) == kStopFrame.size() - 1;
    const bool goes_on = place_ < kStopFrame.size() - 1 && byte == kStopFrame[place_];
    place_ = goes_on ? place_ + 1 : kStopFrame.size();
    return false;
  }

private:
  std::size_t place_ = 0;  // in the frame; behind its end: the line has another one
};

// CRC-16/CCITT-FALSE (poly 0x1021, init 0xFFFF).
[[nodiscard]] std::uint16_t crc16(std::span<const std::byte> bytes);

}  // namespace robosync::link
