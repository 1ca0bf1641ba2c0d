// Finds the sections of an image, and computes the few properties of an image that all users need.
//
// Assumes nothing about the bytes; a view is in bounds for any bytes that view_image() accepts.
#include "vm/image.hpp"

#include <bit>
#include <cstddef>
#include <cstring>

namespace robosync::vm {
namespace {

static_assert(std::endian::native == std::endian::little, "records are read in place");

// Puts `records` at `next`, and moves `next` past them and their padding to 4 bytes. Addresses are
// numbers here, because they may be outside the image until all sections have been placed.
template <typename Record>
void place(std::uintptr_t& next, std::size_t count, std::span<const Record>& records) {
  static_assert(alignof(Record) <= 4);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): not yet known to be a pointer into the image
  records = {reinterpret_cast<const Record*>(next), count};
  next += count * sizeof(Record);
  if constexpr (sizeof(Record) % 4 != 0) next = (next + 3) & ~std::uintptr_t{3};
}

// For six bits at a time: with a whole byte at a time, the table would take 1 KB of flash.
constexpr unsigned kCrcBits = 6;
using CrcTable = std::array<std::uint32_t, 1U << kCrcBits>;

constexpr CrcTable crc_table() {
  CrcTable table{};
  for (std::uint32_t bits = 0; bits < table.size(); ++bits) {
    std::uint32_t remainder = bits;
    for (unsigned bit = 0; bit < kCrcBits; ++bit)
      remainder = remainder >> 1 ^ ((remainder & 1) != 0 ? 0xEDB88320 : 0);
    table[bits] = remainder;
  }
  return table;
}

constexpr CrcTable kCrcTable = crc_table();

[[gnu::always_inline]] inline std::uint32_t crc_six(std::uint32_t crc) {
  return crc >> kCrcBits ^ kCrcTable[crc & (kCrcTable.size() - 1)];
}
[[gnu::always_inline]] inline std::uint32_t crc_two(std::uint32_t crc) {
  return crc >> 2 ^ kCrcTable[(crc & 3) << (kCrcBits - 2)];
}

}  // namespace

bool view_image(std::span<const std::byte> bytes, Image& image) {
  image.header = nullptr;
  const auto begin = reinterpret_cast<std::uintptr_t>(bytes.data());
  if (begin % 4 != 0 || bytes.size() < sizeof(ImageHeader)) return false;
  const ImageHeader& header = *reinterpret_cast<const ImageHeader*>(bytes.data());
  image.header = &header;
  std::uintptr_t next = begin + sizeof(ImageHeader);
#define IMAGE_SECTION(records, Record, Count, check, name) \
  place(next, header.records, image.records);
#include "vm/sections.def"
#undef IMAGE_SECTION
  return header.total_length == bytes.size() && next - begin == bytes.size();
}

std::string_view Image::string(std::uint16_t offset) const {
  if (offset >= strings.size()) return {};
  const std::size_t room = strings.size() - offset;
  const char* const text = strings.data() + offset;
  const void* const nul = std::memchr(text, 0, room);
  return {text,
          nul == nullptr ? room : static_cast<std::size_t>(static_cast<const char*>(nul) - text)};
}

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t seed) {
  std::uint32_t crc = ~seed;
  const std::byte* next = bytes.data();
  const std::byte* const end = next + bytes.size();
  std::size_t words = bytes.size() / sizeof(std::uint32_t);
  if (words > 0) {
    do {
      std::uint32_t word = 0;
      std::memcpy(&word, next, sizeof word);
      next += sizeof word;
      crc = crc_two(crc_six(crc_six(crc_six(crc_six(crc_six(crc ^ word))))));
    } while (--words > 0);
  }
  while (next != end)
    crc = crc_two(crc_six(crc ^ std::to_integer<std::uint32_t>(*next++)));
  return ~crc;
}

ProgramHash stated_name(std::span<const std::byte> image) {
  ProgramHash name{};
  if (image.size() >= sizeof(ImageHeader))
    std::memcpy(name.data(), image.data() + offsetof(ImageHeader, program_hash), name.size());
  return name;
}

}  // namespace robosync::vm
