// Policy of the scheduler: who outranks whom, and which ready thread runs. Pure: no machine, no
// state but the ready set. Every thread has a rank of its own, so there are no ties, no lists, and
// "who runs next" is two CLZ however many threads there are.
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstdint>

#include "runtime-m4/limits.hpp"

namespace robosync::kernel {

// kMaxThreads: limits.hpp.
inline constexpr std::uint8_t kIdleRank = kMaxThreads;  // what an empty ready set selects

// The paper's four categories, and the two kinds of threads around them. Inside one behaviour's
// priority, a later category of the four ranks higher: a decision reaches the actuator before new
// data is gathered. `safety` ranks above everything, `system` (the link) below everything.
enum class Category : std::uint8_t { system, sensor, processing, behavior, control, safety };
inline constexpr unsigned kCategories = 6;

// What a thread's behaviour is worth: `now` decides, and between equals `base`, the priority as it
// was written (adaptation.hpp says how the two come to differ). Behaviours have distinct bases, so
// two behaviours are never equal.
struct Priority {
  std::int8_t now = 0;
  std::int8_t base = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 sees a 0 in what it is defaulted to
  friend constexpr auto operator<=>(const Priority&, const Priority&) = default;
};

// A thread's place in the order as one number, below 2^kStandingBits: the higher outranks. Equals
// rank by age. What it was made of can be had of it again.
//
//   bits 22–21: 2 safety, 0 system, else 1 | 18–11: now + 128 | 10–3: base + 128 | 2–0: category
using Standing = std::uint32_t;
inline constexpr unsigned kStandingBits = 24;
constexpr Standing with_priority(Standing standing, Priority priority) {
  constexpr Standing kPriorityBits = 0xFFFF << 3;
  const auto now = static_cast<unsigned>(priority.now + 128);
  const auto base = static_cast<unsigned>(priority.base + 128);
  return (standing & ~kPriorityBits) | now << 11 | base << 3;
}
constexpr Standing standing(Category category, Priority priority) {
  const unsigned beyond = category == Category::safety ? 2 : category == Category::system ? 0 : 1;
  return with_priority(beyond << 21 | static_cast<unsigned>(category), priority);
}
constexpr Standing standing(Category category, std::int8_t priority) {
  return standing(category, Priority{priority, priority});
}
constexpr Category category_of(Standing standing) {
  return static_cast<Category>(standing & 7);
}
constexpr Priority priority_of(Standing standing) {
  const auto unbiased = [](Standing bits) {
    return static_cast<std::int8_t>(static_cast<int>(bits & 0xFF) - 128);
  };
  return {unbiased(standing >> 11), unbiased(standing >> 3)};
}
inline constexpr Standing kBelowAll = 0;

// The threads that can run: one bit each by rank, the highest rank in the top bit of the first
// word, so that one thread's bit is one load, one OR, one store. Two words hold 64 threads; where
// there are more (the large profile), the words are looked at in turn, which costs the selection
// two instructions a word and nothing else.
template <unsigned kWords>
class BasicReadySet {
public:
  // Where a rank's bit stands. Good as long as the set.
  struct Place {
    std::uint32_t* word = nullptr;
    std::uint32_t bit = 0;
  };

  constexpr Place place(unsigned rank) {
    return {&words_[rank / kBits], std::uint32_t{1} << (kBits - 1 - rank % kBits)};
  }
  static constexpr void insert(Place place) { *place.word |= place.bit; }
  static constexpr void erase(Place place) { *place.word &= ~place.bit; }
  // Two places change what is there. True if `b` was in the set.
  static constexpr bool exchange(Place a, Place b) {
    const std::uint32_t in_a = *a.word & a.bit;
    const std::uint32_t in_b = *b.word & b.bit;
    if ((in_a | in_b) == 0) return false;
    if ((in_a != 0) != (in_b != 0)) {
      *a.word ^= a.bit;
      *b.word ^= b.bit;
    }
    return in_b != 0;
  }
  static constexpr bool contains(Place place) { return (*place.word & place.bit) != 0; }

  // Highest rank in the set; the number of ranks when it is empty.
  constexpr unsigned first() const {
    for (unsigned w = 0; w + 1 < kWords; ++w)
      if (words_[w] != 0) [[likely]]
        return highest(w);
    return highest(kWords - 1);
  }

private:
  static constexpr unsigned kBits = 32;
  constexpr unsigned highest(unsigned w) const {
    return w * kBits + static_cast<unsigned>(std::countl_zero(words_[w]));
  }

  std::array<std::uint32_t, kWords> words_{};
};

using ReadySet = BasicReadySet<kMaxThreads / 32>;

}  // namespace robosync::kernel
