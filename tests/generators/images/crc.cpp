// The checksum of a mutant, fast: tables for eight bytes at a time. That it is the VM's is seen by
// what is accepted.
#include <cstring>

#include "tests/generators/images/draft.hpp"

namespace robosync::fuzz {
namespace {

// A plain array: std::array's operator would be instrumented.
struct Tables {
  std::uint32_t of[8][256];
};

constexpr Tables kTables = [] {
  Tables tables{};
  auto& t = tables.of;
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    t[0][byte] = byte;
    for (int bit = 0; bit < 8; ++bit)
      t[0][byte] = t[0][byte] >> 1 ^ ((t[0][byte] & 1) != 0 ? 0xEDB88320 : 0);
  }
  for (std::uint32_t byte = 0; byte < 256; ++byte)
    for (int i = 1; i < 8; ++i)
      t[i][byte] = t[i - 1][byte] >> 8 ^ t[0][t[i - 1][byte] & 0xFF];
  return tables;
}();

}  // namespace

__attribute__((no_sanitize("address", "undefined"))) std::uint32_t fast_crc32(
    std::span<const std::byte> bytes) {
  const auto& t = kTables.of;
  const std::byte* next = bytes.data();
  std::size_t left = bytes.size();
  std::uint32_t crc = 0xFFFFFFFF;
  for (; left >= 8; left -= 8, next += 8) {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::memcpy(&low, next, 4);
    std::memcpy(&high, next + 4, 4);
    low ^= crc;
    crc = t[7][low & 0xFF] ^ t[6][low >> 8 & 0xFF] ^ t[5][low >> 16 & 0xFF] ^ t[4][low >> 24] ^
          t[3][high & 0xFF] ^ t[2][high >> 8 & 0xFF] ^ t[1][high >> 16 & 0xFF] ^ t[0][high >> 24];
  }
  for (; left > 0; --left, ++next)
    crc = crc >> 8 ^ t[0][(crc ^ static_cast<std::uint32_t>(*next)) & 0xFF];
  return ~crc;
}

}  // namespace robosync::fuzz
