// Which ready thread runs. No machine, no state but the ready set. Every thread has a rank of its own, so there are no ties, no lists, and
// "who runs next" is two CLZ however many threads there are.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "runtime-m4/policy/standing.hpp"

namespace robosync::kernel {

using policy::kMaxThreads;
inline constexpr std::uint8_t kIdleRank = kMaxThreads;  // what an empty ready set selects

// Who outranks whom is policy (policy/standing.hpp); here it is kept and obeyed.
using policy::Category;
using policy::category_of;
using policy::kBelowAll;
using policy::kCategories;
using policy::kStandingBits;
using policy::Priority;
using policy::priority_of;
using policy::Standing;
using policy::standing;
using policy::with_priority;

// The threads that can run: one bit each by rank, the highest rank in the top bit of the first
// word, so that one thread's bit is one load, one OR, one store. The words are looked at in turn, which
// costs the selection two instructions a word and nothing else.
template <unsigned kWords>
class BasicReadySet {
public:
  // Where a rank's bit stands. Good as long as the set.
  struct Position {
    std::uint32_t* word = nullptr;
    std::uint32_t bit = 0;
  };

  constexpr Position position(unsigned rank) {
    return {&words_[rank / kBits], std::uint32_t{1} << (kBits - 1 - rank % kBits)};
  }
  static constexpr void insert(Position position) { *position.word |= position.bit; }
  static constexpr void erase(Position position) { *position.word &= ~position.bit; }
  // Two positions change what is there. True if `b` was in the set.
  static constexpr bool exchange(Position a, Position b) {
    const std::uint32_t in_a = *a.word & a.bit;
    const std::uint32_t in_b = *b.word & b.bit;
    if ((in_a | in_b) == 0) return false;
    if ((in_a != 0) != (in_b != 0)) {
      *a.word ^= a.bit;
      *b.word ^= b.bit;
    }
    return in_b != 0;
  }
  static constexpr bool contains(Position position) { return (*position.word & position.bit) != 0; }

  // Highest rank in the set; the number of ranks when it is empty.
  [[gnu::always_inline]] constexpr unsigned first() const { return first_from<0>(); }

private:
  static constexpr unsigned kBits = 32;
  template <unsigned kWord>
  [[gnu::always_inline]] constexpr unsigned first_from() const {
    if constexpr (kWord + 1 < kWords)
      if (words_[kWord] == 0) [[unlikely]]
        return first_from<kWord + 1>();
    return kWord * kBits + static_cast<unsigned>(std::countl_zero(words_[kWord]));
  }

  std::array<std::uint32_t, kWords> words_{};
};

using ReadySet = BasicReadySet<kMaxThreads / 32>;

}  // namespace robosync::kernel
