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

// A thread's place in the order as one number: the higher outranks. Equals rank by age.
constexpr std::int32_t standing(Category category, Priority priority) {
  constexpr std::int32_t kBeyondAnyPriority = 1 << 24;
  const std::int32_t level = std::int32_t{priority.now} * 256 + priority.base;
  const std::int32_t place = level * 8 + static_cast<std::int32_t>(category);
  if (category == Category::safety) return place + kBeyondAnyPriority;
  if (category == Category::system) return place - kBeyondAnyPriority;
  return place;
}
constexpr std::int32_t standing(Category category, std::int8_t priority) {
  return standing(category, Priority{priority, priority});
}

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
  static constexpr void toggle(Place place) { *place.word ^= place.bit; }
  static constexpr bool contains(Place place) { return (*place.word & place.bit) != 0; }

  // Highest rank in the set; the number of ranks when it is empty.
  constexpr unsigned first() const {
    for (unsigned w = 0; w + 1 < kWords; ++w)
      if (words_[w] != 0) [[likely]]
        return highest(w);
    return highest(kWords - 1);
  }

  // A thread comes in at `rank`: it and all below move down one place. The new place is not ready.
  constexpr void open_place(unsigned rank) {
    const unsigned first = rank / kBits;
    for (unsigned w = kWords - 1; w > first; --w)
      words_[w] = words_[w] >> 1 | words_[w - 1] << (kBits - 1);
    words_[first] = (words_[first] & ~from(rank)) | (words_[first] & from(rank)) >> 1;
  }
  // The thread at `rank` goes: all below move up one place.
  constexpr void close_place(unsigned rank) {
    const unsigned first = rank / kBits;
    words_[first] = (words_[first] & ~from(rank)) | (words_[first] & from(rank) >> 1) << 1;
    for (unsigned w = first + 1; w < kWords; ++w) {
      words_[w - 1] |= words_[w] >> (kBits - 1);
      words_[w] <<= 1;
    }
  }

private:
  static constexpr unsigned kBits = 32;
  static constexpr std::uint32_t from(unsigned rank) { return ~std::uint32_t{0} >> rank % kBits; }
  constexpr unsigned highest(unsigned w) const {
    return w * kBits + static_cast<unsigned>(std::countl_zero(words_[w]));
  }

  std::array<std::uint32_t, kWords> words_{};
};

using ReadySet = BasicReadySet<kMaxThreads / 32>;

}  // namespace robosync::kernel
