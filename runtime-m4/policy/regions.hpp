// Which regions of the MPU cover a piece of memory. Pure arithmetic, tested on the host.
//
// A region is a power of two in size and aligned to it; from 256 bytes on, each of its eighths can
// be left out. So two neighboring ones of a size, a window, cover any run of eighths that begins
// in the first: that is how a stack gets its exact borders without being a power of two.
#pragma once

#include <cstdint>

namespace robosync::policy::regions {

inline constexpr unsigned kEighthBits = 3;
inline constexpr std::uint32_t kEighths = 1U << kEighthBits;
inline constexpr std::uint32_t kEnabled = 1;

// What goes into the base register, and into the attribute register but for the access.
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

// One region of 2^bits bytes, of which it covers the eighths in `mask`.
constexpr Region region(std::uint32_t base, unsigned bits, std::uint32_t mask) {
  mask &= 0xFF;
  if (mask == 0) return {base, 0};
  return {base, size_field(bits) | (~mask & 0xFF) << 8};
}

// Whether a window of two regions of 2^bits bytes covers exactly that.
constexpr bool fits_window(std::uint32_t begin, std::uint32_t bytes, unsigned bits) {
  const std::uint32_t within_eighth = (1U << bits) / kEighths - 1;
  const std::uint32_t within_region = (1U << bits) - 1;
  return ((begin | bytes) & within_eighth) == 0 && (begin & within_region) + bytes <= 2U << bits;
}

// It, when it fits.
constexpr Window window(std::uint32_t begin, std::uint32_t bytes, unsigned bits) {
  const std::uint32_t size = 1U << bits;
  const std::uint32_t base = begin & ~(size - 1);
  const unsigned eighth = bits - kEighthBits;
  const std::uint32_t mask = ((1U << (bytes >> eighth)) - 1) << ((begin - base) >> eighth);
  return {region(base, bits, mask), region(base + size, bits, mask >> kEighths)};
}

inline constexpr unsigned kSmallest = 8;  // 256 bytes, which is the smallest with eighths
inline constexpr unsigned kLargest = 31;

// The finest window that covers exactly that; one that covers nothing when there is none.
constexpr Window finest_window(std::uint32_t begin, std::uint32_t bytes) {
  for (unsigned bits = kSmallest; bits < kLargest; ++bits)
    if (fits_window(begin, bytes, bits)) return window(begin, bytes, bits);
  return {};
}

// How large a window for so many bytes must be, and how aligned, so that there is one wherever it begins: nine eighths
// of a region are always in two.
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

// The smallest power of two that one region over begin … end - 1 can have.
constexpr unsigned cover_bits(std::uint32_t begin, std::uint32_t end) {
  unsigned bits = kSmallest;
  while (bits < kLargest && begin >> bits != (end - 1) >> bits)
    ++bits;
  return bits;
}

// The one region that covers begin … end - 1 with the least around it. It may need more than there
// is at both sides: up to an eighth.
constexpr Region cover(std::uint32_t begin, std::uint32_t end) {
  const unsigned bits = cover_bits(begin, end);
  if (bits == kLargest) return {};
  const std::uint32_t base = begin >> bits << bits;
  const unsigned eighth = bits - kEighthBits;
  const std::uint32_t first = (begin - base) >> eighth;
  const std::uint32_t last = (end - 1 - base) >> eighth;
  return region(base, bits, (2U << last) - (1U << first));
}

}  // namespace robosync::policy::regions
