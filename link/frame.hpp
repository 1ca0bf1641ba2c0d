// Frames on the serial line: {type, sequence, payload, CRC-16}, COBS-encoded, ended by a zero byte.
//
// A byte that is lost, flipped, doubled or inserted costs the frame it hits and no more: the decoder
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
// A frame is short enough for a single COBS code byte before it; the delimiter follows it.
inline constexpr std::size_t kMaxEncodedFrame = 1 + kMaxPayload + kFrameOverhead + 1;
// The most bytes that a host may have in flight on the line. A board's receive buffer holds that many, because the board does
// not read the line while it verifies an image.
inline constexpr std::uint16_t kReceiveWindow = 2 * kMaxEncodedFrame;
static_assert(kMaxPayload + kFrameOverhead < 254, "longer frames need COBS blocks");

struct Frame {
  MessageType type{};
  std::uint8_t sequence = 0;
  std::span<const std::byte> payload;  // valid until the decoder gets its next byte
};

// Encodes a frame and its delimiter into `out`. Returns the number of bytes; if the payload is longer
// than kMaxPayload, returns 0 and writes nothing.
std::size_t encode_frame(MessageType type, std::uint8_t sequence,
                         std::span<const std::byte> payload,
                         std::span<std::byte, kMaxEncodedFrame> out);

class FrameDecoder {
public:
  // Takes one byte from the line. True if it completed a valid frame, which is then in frame().
  [[nodiscard]] bool push(std::byte byte);
  const Frame& frame() const { return frame_; }
  // Dropped frames: too long, invalid COBS, or a wrong CRC. Empty frames are not counted.
  std::uint32_t bad_frames() const { return bad_frames_; }

private:
  bool finish();  // at the delimiter: is the buffer a valid frame?
  bool decode();

  std::array<std::byte, kMaxEncodedFrame - 1> buffer_{};  // without the delimiter
  std::size_t length_ = 0;
  bool overflow_ = false;
  std::uint32_t bad_frames_ = 0;
  Frame frame_;
};

// The frame that stops the robot always has these bytes: encode_frame(stop, kStopSequence, {}). So the code that takes bytes
// from the line, usually an interrupt handler, detects it without decoding, before any thread runs.
inline constexpr std::uint8_t kStopSequence = 0xFF;
inline constexpr std::array<std::byte, 6> kStopFrame{std::byte{0x05}, std::byte{0x15},
                                                     std::byte{0xFF}, std::byte{0x79},
                                                     std::byte{0xFF}, std::byte{0}};

class StopDetector {
public:
  // Takes one byte from the line. True if it completed a stop frame.
  [[nodiscard]] bool push(std::byte byte) {
    if (byte == kStopFrame.back()) return std::exchange(place_, 0U) == kStopFrame.size() - 1;
    const bool goes_on = place_ < kStopFrame.size() - 1 && byte == kStopFrame[place_];
    place_ = goes_on ? place_ + 1 : kStopFrame.size();
    return false;
  }

private:
  std::size_t place_ = 0;  // position in the stop frame; past its end: this is another frame
};

// CRC-16/CCITT-FALSE (poly 0x1021, init 0xFFFF).
[[nodiscard]] std::uint16_t crc16(std::span<const std::byte> bytes);

}  // namespace robosync::link
