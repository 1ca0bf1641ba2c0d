// SHA-256 (FIPS 180-4) over the words of an image in place: nothing is copied, and the padding is generated word by word.
// Assumes nothing about the bytes. Guarantees that it reads only bytes that have been received.
#include "vm/identity.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace robosync::vm {
namespace {

constexpr std::uint32_t kBlock = 64;  // bytes
constexpr std::uint32_t kWordBytes = sizeof(std::uint32_t);

// The first 32 bits of the fractional parts of the cube roots of the first 64 primes.
constexpr std::array<std::uint32_t, 64> kRoots = {
    0x428A2F98, 0x71374491, 0xB5C0FBCF, 0xE9B5DBA5, 0x3956C25B, 0x59F111F1, 0x923F82A4, 0xAB1C5ED5,
    0xD807AA98, 0x12835B01, 0x243185BE, 0x550C7DC3, 0x72BE5D74, 0x80DEB1FE, 0x9BDC06A7, 0xC19BF174,
    0xE49B69C1, 0xEFBE4786, 0x0FC19DC6, 0x240CA1CC, 0x2DE92C6F, 0x4A7484AA, 0x5CB0A9DC, 0x76F988DA,
    0x983E5152, 0xA831C66D, 0xB00327C8, 0xBF597FC7, 0xC6E00BF3, 0xD5A79147, 0x06CA6351, 0x14292967,
    0x27B70A85, 0x2E1B2138, 0x4D2C6DFC, 0x53380D13, 0x650A7354, 0x766A0ABB, 0x81C2C92E, 0x92722C85,
    0xA2BFE8A1, 0xA81A664B, 0xC24B8B70, 0xC76C51A3, 0xD192E819, 0xD6990624, 0xF40E3585, 0x106AA070,
    0x19A4C116, 0x1E376C08, 0x2748774C, 0x34B0BCB5, 0x391C0CB3, 0x4ED8AA4A, 0x5B9CCA4F, 0x682E6FF3,
    0x748F82EE, 0x78A5636F, 0x84C87814, 0x8CC70208, 0x90BEFFFA, 0xA4506CEB, 0xBEF9A3F7, 0xC67178F2};

std::uint32_t load(std::span<const std::byte> bytes, std::uint32_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

// The end of the bytes that are hashed. `image` must have a complete header.
std::uint32_t end_of(std::span<const std::byte> image) {
  std::uint16_t lines = 0;
  std::memcpy(&lines, image.data() + offsetof(ImageHeader, source_lines), sizeof lines);
  const std::uint32_t length = load(image, offsetof(ImageHeader, total_length));
  const std::uint32_t not_counted = lines * static_cast<std::uint32_t>(sizeof(SourceLine));
  return length - std::min(length, not_counted);
}

// A word of the image as it is hashed.
std::uint32_t counted(std::span<const std::byte> image, std::uint32_t at) {
  static_assert(offsetof(ImageHeader, source_lines) % kWordBytes == 0);
  switch (at) {
    case offsetof(ImageHeader, crc32):
    case offsetof(ImageHeader, total_length):
    case offsetof(ImageHeader, program_hash):
    case offsetof(ImageHeader, program_hash) + kWordBytes:
      return 0;
    case offsetof(ImageHeader, source_lines):
      return load(image, at) & 0xFFFF'0000;
    default:
      return load(image, at);
  }
}

std::uint32_t big_endian(std::uint32_t word) {
  return (word & 0xFF) << 24 | (word & 0xFF00) << 8 | (word >> 8 & 0xFF00) | word >> 24;
}

}  // namespace

// `bits_at`: the last word of the last block, which contains the length in bits; if it is past this block, more blocks follow.
void Identity::take_block(std::span<const std::byte> image, std::uint32_t end,
                          std::uint32_t bits_at) {
  std::array<std::uint32_t, 16> words{};
  Digest now = state_;
  for (unsigned round = 0; round < kRoots.size(); ++round) {
    std::uint32_t& word = words[round % 16];
    if (round < 16) {
      const std::uint32_t at = taken_ + round * kWordBytes;
      word = at < end        ? big_endian(counted(image, at))
             : at == end     ? 0x8000'0000
             : at == bits_at ? end * 8
                             : 0;
    } else {
      const std::uint32_t second = words[(round + 1) % 16];
      const std::uint32_t last = words[(round + 14) % 16];
      word += words[(round + 9) % 16] +
              (std::rotr(second, 7) ^ std::rotr(second, 18) ^ second >> 3) +
              (std::rotr(last, 17) ^ std::rotr(last, 19) ^ last >> 10);
    }
    const auto& [a, b, c, d, e, f, g, h] = now;
    const std::uint32_t one = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                              ((e & f) ^ (~e & g)) + kRoots[round] + word;
    const std::uint32_t two =
        (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    now = {one + two, a, b, c, d + one, e, f, g};
  }
  for (unsigned i = 0; i < state_.size(); ++i)
    state_[i] += now[i];
  taken_ += kBlock;
}

void Identity::follow(std::span<const std::byte> received) {
  if (received.size() < sizeof(ImageHeader)) return;
  const auto whole =
      std::min(static_cast<std::uint32_t>(received.size()), end_of(received)) & ~(kBlock - 1);
  while (taken_ < whole)
    take_block(received, whole, 0);
}

Digest Identity::finish(std::span<const std::byte> image) {
  follow(image);
  std::uint32_t end = static_cast<std::uint32_t>(image.size());
  if (image.size() >= sizeof(ImageHeader)) end = std::min(end, end_of(image));
  end &= ~(kWordBytes - 1);
  constexpr std::uint32_t kMark = kWordBytes, kLength = 2 * kWordBytes;  // after the end
  const std::uint32_t blocks = (end + kMark + kLength + kBlock - 1) / kBlock;
  const std::uint32_t bits_at = blocks * kBlock - kWordBytes;
  while (taken_ < bits_at)
    take_block(image, end, bits_at);
  return state_;
}

ProgramHash name_of(const Digest& digest) {
  const std::array<std::uint32_t, 2> first = {big_endian(digest[0]), big_endian(digest[1])};
  ProgramHash name{};
  std::memcpy(name.data(), first.data(), name.size());
  return name;
}

bool is_named(std::span<const std::byte> image, Identity identity) {
  if (image.size() < sizeof(ImageHeader)) return false;
  const ProgramHash name = name_of(identity.finish(image));
  return std::memcmp(name.data(), image.data() + offsetof(ImageHeader, program_hash),
                     name.size()) == 0;
}

void seal(std::span<std::byte> image) {
  const ProgramHash name = name_of(Identity().finish(image));
  std::memcpy(image.data() + offsetof(ImageHeader, program_hash), name.data(), name.size());
  constexpr std::size_t kAt = offsetof(ImageHeader, crc32);
  const std::uint32_t crc = crc32(image.subspan(kAt + sizeof crc));
  std::memcpy(image.data() + kAt, &crc, sizeof crc);
}

}  // namespace robosync::vm
