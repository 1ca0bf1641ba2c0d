// MPU regions (policy/regions.hpp) compared byte by byte with what they cover according to the ARMv7-M
// manual.
#include "runtime-m4/policy/regions.hpp"

#include <catch2/catch.hpp>

using namespace robosync::policy::regions;

namespace {

// Interprets the two registers as the core does.
bool covers(const Region& region, std::uint32_t address) {
  if ((region.size_and_eighths & 1) == 0) return false;
  const std::uint32_t size = 2U << (region.size_and_eighths >> 1 & 0x1F);
  REQUIRE(region.base % size == 0);
  if (address - region.base >= size) return false;
  const std::uint32_t eighth = (address - region.base) / (size / 8);
  return (region.size_and_eighths >> (8 + eighth) & 1) == 0;
}

}  // namespace

TEST_CASE("a window covers exactly what it is for") {
  constexpr unsigned kBits = 9;
  constexpr std::uint32_t kEighth = 64;
  unsigned fitting = 0;
  for (std::uint32_t begin = 0x2000'0000; begin < 0x2000'0000 + 1024; begin += 32)
    for (std::uint32_t bytes = 32; bytes <= 640; bytes += 32) {
      const bool aligned = begin % kEighth == 0 && bytes % kEighth == 0;
      const bool inside = begin % 512 + bytes <= 1024;
      CHECK(fits_window(begin, bytes, kBits) == (aligned && inside));
      if (!fits_window(begin, bytes, kBits)) continue;
      ++fitting;
      const Window made = window(begin, bytes, kBits);
      unsigned wrong = 0;
      for (std::uint32_t address = begin - 2048; address < begin + 2048; address += 4) {
        const bool covered = covers(made.lower, address) || covers(made.upper, address);
        if (covered != (address - begin < bytes)) ++wrong;
      }
      CHECK(wrong == 0);
    }
  CHECK(fitting > 100);
}

TEST_CASE("the finest window is exact, whatever its size; there may be none") {
  for (const std::uint32_t unit : {32U, 128U, 4096U})
    for (std::uint32_t units = 1; units <= 12; ++units)
      for (std::uint32_t first = 0; first < 8; first += 4) {
        const std::uint32_t begin = 0x2000'0000 + first * unit;
        const Window made = finest_window(begin, units * unit);
        unsigned wrong = 0;
        for (std::uint32_t at = begin - 16 * unit; at < begin + 32 * unit; at += 4)
          if ((covers(made.lower, at) || covers(made.upper, at)) != (at - begin < units * unit))
            ++wrong;
        CHECK(wrong == 0);
      }
  const Window none = finest_window(0x2000'0004, 100);
  CHECK(none.lower.size_and_eighths == 0);
  CHECK(none.upper.size_and_eighths == 0);
}

TEST_CASE("a seat is the highest place that eighths of one region cover exactly") {
  for (std::uint32_t end = 0x2001'8000; end < 0x2002'0000; end += 1024 * 3 + 128)
    for (std::uint32_t bytes = 1024; bytes <= 24 * 1024; bytes += 1024) {
      const Seat seat = highest_seat(end, bytes);
      CHECK((seat.bytes >= bytes && seat.bytes < 2 * bytes));
      CHECK((seat.begin + seat.bytes <= end && end - seat.begin <= 3 * bytes));
      REQUIRE(fits_region(seat.begin, seat.bytes));
      const Region made = cover(seat.begin, seat.begin + seat.bytes);
      for (const std::uint32_t inside : {seat.begin, seat.begin + seat.bytes - 1})
        CHECK(covers(made, inside));
      for (const std::uint32_t outside : {seat.begin - 1, seat.begin + seat.bytes})
        CHECK(!covers(made, outside));
    }
  CHECK(highest_seat(0x2002'0000, 10 * 1024).begin == 0x2002'0000 - 10 * 1024);
  CHECK(!fits_region(0x2002'0000 - 10 * 1024, 10 * 1024 + 32));
  CHECK(!fits_region(0x2002'0000 - 9 * 1024, 9 * 1024));
  CHECK(!fits_region(0x2001'F000, 8 * 1024));
}

TEST_CASE("one region covers a piece of memory, with less than an eighth of itself around") {
  std::uint32_t state = 1;
  for (unsigned round = 0; round < 500; ++round) {
    state = state * 1664525 + 1013904223;
    const std::uint32_t begin = 0x2000'0000 + state % 0x8000;
    state = state * 1664525 + 1013904223;
    const std::uint32_t end = begin + 1 + state % 0x4000;
    const Region made = cover(begin, end);
    REQUIRE(made.size_and_eighths != 0);
    const std::uint32_t eighth = (2U << (made.size_and_eighths >> 1 & 0x1F)) / 8;
    CHECK(covers(made, begin));
    CHECK(covers(made, end - 1));
    CHECK(covers(made, begin + (end - begin) / 2));
    CHECK(!covers(made, begin - eighth));
    CHECK(!covers(made, end - 1 + eighth));
  }
}
