// COBS framing with a CRC-16. Assumes nothing about its input. Guarantees that a frame which the
// decoder accepts was sent as one frame (except for one damaged frame in 65,536), and that the decoder
// is synchronised again after the next delimiter.
#include "link/frame.hpp"

#include <algorithm>

namespace robosync::link {
namespace {

constexpr std::byte kDelimiter{0};

// The CRC of each half-byte value: a table of 32 bytes instead of 512, for twice the steps.
constexpr std::array<std::uint16_t, 16> kCrcTable = [] {
  std::array<std::uint16_t, 16> table{};
  for (unsigned nibble = 0; nibble < table.size(); ++nibble) {
    unsigned crc = nibble << 12;
    for (int bit = 0; bit < 4; ++bit) {
      crc = (crc & 0x8000) != 0 ? (crc << 1) ^ 0x1021 : crc << 1;
    }
    table[nibble] = static_cast<std::uint16_t>(crc);
  }
  return table;
}();

// Replaces each zero of block[1…] with the distance to the next one; block[0] gets the first distance.
void cobs_encode(std::span<std::byte> block) {
  std::size_t last_zero = 0;
  for (std::size_t i = 1; i < block.size(); ++i) {
    if (block[i] != std::byte{0}) continue;
    block[last_zero] = static_cast<std::byte>(i - last_zero);
    last_zero = i;
  }
  block[last_zero] = static_cast<std::byte>(block.size() - last_zero);
}

// The reverse, in place. False if the distances do not end at the block's end.
bool cobs_decode(std::span<std::byte> block) {
  std::size_t i = 0;
  while (i < block.size()) {
    const auto distance = std::to_integer<std::size_t>(block[i]);
    block[i] = std::byte{0};
    i += distance;  // never 0: a zero byte would have ended the frame
  }
  return i == block.size();
}

}  // namespace

std::uint16_t crc16(std::span<const std::byte> bytes) {
  unsigned crc = 0xFFFF;
  for (const std::byte byte : bytes) {
    const auto value = std::to_integer<unsigned>(byte);
    crc = (crc << 4) ^ kCrcTable[((crc >> 12) ^ (value >> 4)) & 0xF];
    crc = (crc << 4) ^ kCrcTable[((crc >> 12) ^ value) & 0xF];
  }
  return static_cast<std::uint16_t>(crc);
}

std::size_t encode_frame(MessageType type, std::uint8_t sequence,
                         std::span<const std::byte> payload,
                         std::span<std::byte, kMaxEncodedFrame> out) {
  if (payload.size() > kMaxPayload) return 0;
  const std::size_t content = 2 + payload.size();
  out[1] = static_cast<std::byte>(type);
  out[2] = std::byte{sequence};
  std::copy(payload.begin(), payload.end(), out.begin() + 3);
  const std::uint16_t crc = crc16(out.subspan(1, content));
  out[1 + content] = static_cast<std::byte>(crc & 0xFF);
  out[2 + content] = static_cast<std::byte>(crc >> 8);
  const std::size_t block = 1 + content + 2;
  cobs_encode(out.first(block));
  out[block] = kDelimiter;
  return block + 1;
}

bool FrameDecoder::push(std::byte byte) {
  if (byte == kDelimiter) return finish();
  if (length_ == buffer_.size()) {
    overflow_ = true;
  } else {
    buffer_[length_++] = byte;
  }
  return false;
}

bool FrameDecoder::finish() {
  const bool empty = length_ == 0;  // two delimiters in a row: a host clears the line
  const bool good = !empty && !overflow_ && decode();
  if (!empty && !good) ++bad_frames_;
  length_ = 0;
  overflow_ = false;
  return good;
}

bool FrameDecoder::decode() {
  const auto block = std::span(buffer_).first(length_);
  if (block.size() < 1 + kFrameOverhead || !cobs_decode(block)) return false;
  const auto content = block.subspan(1, block.size() - 3);
  const auto crc = std::to_integer<unsigned>(block[block.size() - 2]) |
                   std::to_integer<unsigned>(block[block.size() - 1]) << 8;
  if (crc16(content) != crc) return false;
  frame_.type = static_cast<MessageType>(content[0]);
  frame_.sequence = std::to_integer<std::uint8_t>(content[1]);
  frame_.payload = content.subspan(2);
  return true;
}

}  // namespace robosync::link
