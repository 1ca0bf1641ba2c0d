// Policy of the scheduler: who outranks whom, and which ready thread runs. Pure: no machine, no
// state but the ready set. Every thread has a rank of its own, so there are no ties, no lists, and
// "who runs next" is two CLZ however many threads there are.
#pragma once

#include <bit>
#include <cstdint>

#include "runtime-m4/limits.hpp"

namespace robosync::kernel {

inline constexpr std::uint8_t kIdleRank = kMaxThreads;  // what an empty ready set selects

// The paper's four categories, and the two kinds of threads around them. Inside one behaviour's
// priority, a later category of the four ranks higher: a decision reaches the actuator before new
// data is gathered. `safety` ranks above everything, `system` (the link) below everything.
enum class Category : std::uint8_t { system, sensor, processing, behavior, control, safety };

// A thread's place in the order as one number: the higher outranks. Equals rank by age.
constexpr std::int32_t standing(Category category, std::int16_t priority) {
  constexpr std::int32_t kBeyondAnyPriority = 1 << 24;
  switch (category) {
    case Category::safety:
      return kBeyondAnyPriority + priority;
    case Category::system:
      return -kBeyondAnyPriority + priority;
    default:
      return std::int32_t{priority} * 8 + static_cast<std::int32_t>(category);
  }
}

// The threads that can run: a 64-bit word by rank, the highest rank in the top bit, kept as two
// halves so that one thread's bit is one load, one OR, one store.
class ReadySet {
public:
  // Where a rank's bit stands. Good as long as the set.
  struct Place {
    std::uint32_t* half = nullptr;
    std::uint32_t bit = 0;
  };

  constexpr Place place(unsigned rank) {
    return {rank < 32 ? &high_ : &low_, std::uint32_t{1} << (31 - rank % 32)};
  }
  static constexpr void insert(Place place) { *place.half |= place.bit; }
  static constexpr void erase(Place place) { *place.half &= ~place.bit; }
  static constexpr bool contains(Place place) { return (*place.half & place.bit) != 0; }

  // Highest rank in the set; kIdleRank when it is empty.
  constexpr unsigned first() const {
    if (high_ != 0) return static_cast<unsigned>(std::countl_zero(high_));
    return 32 + static_cast<unsigned>(std::countl_zero(low_));
  }

  // A thread comes in at `rank`: it and all below move down one place. The new place is not ready.
  constexpr void open_place(unsigned rank) {
    const std::uint64_t below = word() & from(rank);
    set_word((word() & ~from(rank)) | (below >> 1));
  }
  // The thread at `rank` goes: all below move up one place.
  constexpr void close_place(unsigned rank) {
    const std::uint64_t below = word() & (from(rank) >> 1);
    set_word((word() & ~from(rank)) | (below << 1));
  }

private:
  static constexpr std::uint64_t from(unsigned rank) { return ~std::uint64_t{0} >> rank; }
  constexpr std::uint64_t word() const { return (std::uint64_t{high_} << 32) | low_; }
  constexpr void set_word(std::uint64_t word) {
    high_ = static_cast<std::uint32_t>(word >> 32);
    low_ = static_cast<std::uint32_t>(word);
  }

  std::uint32_t high_ = 0;  // ranks 0–31
  std::uint32_t low_ = 0;   // ranks 32–63
};

}  // namespace robosync::kernel
