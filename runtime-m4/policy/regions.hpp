// Which regions of the MPU cover a block of memory. Pure arithmetic, tested on the host.
//
// A region is a power of two in size and aligned to its size. In a region of 256 bytes or more, each
// eighth can be disabled. So a window, two neighbouring regions of one size, can cover any run of
// eighths that begins in the first region. In this way a stack gets exact borders, though its size is
// no power of two.
#pragma once

#include <cstdint>

namespace robosync::policy::regions {

inline constexpr unsigned kEighthBits = 3;
inline constexpr std::uint32_t kEighths = 1U << kEighthBits;
inline constexpr std::uint32_t kEnabled = 1;

// The values of the base register, and of the attribute register without the access rights.
struct Region {
  std::uint32_t base = 0;
  std::uint32_t size_and_eighths = 0;  // 0: covers nothing
};
struct Window {
  Region lower, upper;
};

// The SIZE field for 2^bits bytes.
constexpr std::uint32_t size_field(unsigned bits) {
  return (bits - 1) << 1 | kEnabled;
}

// A region of 2^bits bytes that covers the eighths in `mask`.
constexpr Region region(std::uint32_t base, unsigned bits, std::uint32_t mask) {
  mask &= 0xFF;
  if (mask == 0) return {base, 0};
  return {base, size_field(bits) | (~mask & 0xFF) << 8};
}

// Whether a window of two regions of 2^bits bytes can cover exactly these bytes.
constexpr bool fits_window(std::uint32_t begin, std::uint32_t bytes, unsigned bits) {
  const std::uint32_t within_eighth = (1U << bits) / kEighths - 1;
  const std::uint32_t within_region = (1U << bits) - 1;
  return ((begin | bytes) & within_eighth) == 0 && (begin & within_region) + bytes <= 2U << bits;
}

// That window. fits_window() must be true.
constexpr Window window(std::uint32_t begin, std::uint32_t bytes, unsigned bits) {
  const std::uint32_t size = 1U << bits;
  const std::uint32_t base = begin & ~(size - 1);
  const unsigned eighth = bits - kEighthBits;
  const std::uint32_t mask = ((1U << (bytes >> eighth)) - 1) << ((begin - base) >> eighth);
  return {region(base, bits, mask), region(base + size, bits, mask >> kEighths)};
}

inline constexpr unsigned kSmallest = 8;  // 256 bytes, the smallest region with eighths
inline constexpr unsigned kLargest = 31;

// The finest window that covers exactly these bytes; if there is none, a window that covers nothing.
constexpr Window finest_window(std::uint32_t begin, std::uint32_t bytes) {
  for (unsigned bits = kSmallest; bits < kLargest; ++bits)
    if (fits_window(begin, bytes, bits)) return window(begin, bytes, bits);
  return {};
}

// The size and alignment that memory for `bytes` bytes must have so that a window covers it wherever it begins: nine
// eighths of a region always fit two regions.
struct Fit {
  std::uint32_t bytes;
  std::uint32_t alignment;
};
constexpr Fit fit_anywhere(std::uint32_t bytes) {
  unsigned eighth = kSmallest - kEighthBits;
  while (bytes > (kEighths + 1) << eighth)
    ++eighth;
  const std::uint32_t unit = 1U << eighth;
  return {(bytes + unit - 1) & ~(unit - 1), unit};
}

// The size of the smallest region over begin … end - 1, as a power of two.
constexpr unsigned cover_bits(std::uint32_t begin, std::uint32_t end) {
  unsigned bits = kSmallest;
  while (bits < kLargest && begin >> bits != (end - 1) >> bits)
    ++bits;
  return bits;
}

// The smallest single region that covers begin … end - 1. At both ends it may cover more than that, up
// to an eighth of its size.
constexpr Region cover(std::uint32_t begin, std::uint32_t end) {
  const unsigned bits = cover_bits(begin, end);
  if (bits == kLargest) return {};
  const std::uint32_t base = begin >> bits << bits;
  const unsigned eighth = bits - kEighthBits;
  const std::uint32_t first = (begin - base) >> eighth;
  const std::uint32_t last = (end - 1 - base) >> eighth;
  return region(base, bits, (2U << last) - (1U << first));
}

// The highest place below `end` at which eighths of one region cover exactly so many bytes, or a few more: an address, and the bytes.
struct Seat {
  std::uint32_t begin;
  std::uint32_t bytes;
};
constexpr Seat highest_seat(std::uint32_t end, std::uint32_t bytes) {
  for (unsigned bits = kSmallest; bits < kLargest; ++bits) {
    const std::uint32_t unit = (1U << bits) / kEighths, top = end & ~(unit - 1);
    const std::uint32_t taken = (bytes + unit - 1) & ~(unit - 1), begin = top - taken;
    if (begin >> bits == (top - 1) >> bits) return {begin, taken};
  }
  return {end - bytes, bytes};
}

// Whether eighths of one region can cover exactly these bytes: cover() is it then.
constexpr bool fits_region(std::uint32_t begin, std::uint32_t bytes) {
  const unsigned bits = cover_bits(begin, begin + bytes);
  return bits < kLargest && ((begin | bytes) & ((1U << bits) / kEighths - 1)) == 0;
}

}  // namespace robosync::policy::regions
