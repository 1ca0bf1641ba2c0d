// Which ready thread runs. Pure: depends on no machine, and the ready set is its only state. Every thread has a rank of its own,
// so there are no ties and no lists. Finding the next thread costs a test per word and one CLZ, however many threads are ready.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "runtime-m4/policy/standing.hpp"

namespace robosync::kernel {

using policy::kMaxThreads;
inline constexpr std::uint8_t kIdleRank = kMaxThreads;  // what an empty ready set selects

// Which thread outranks which is policy (policy/standing.hpp); the kernel keeps and obeys it.
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

// The ready threads: one bit per rank, the highest rank in the top bit of the first word. Setting a
// bit takes one load, one OR and one store. The words are checked in turn, which costs the selection
// two instructions a word and adds nothing to a wake-up.
template <unsigned kWords>
class BasicReadySet {
public:
  // The place of a rank's bit. Valid as long as the set exists.
  struct Position {
    std::uint32_t* word = nullptr;
    std::uint32_t bit = 0;
  };

  constexpr Position position(unsigned rank) {
    return {&words_[rank / kBits], std::uint32_t{1} << (kBits - 1 - rank % kBits)};
  }
  static constexpr void insert(Position position) { *position.word |= position.bit; }
  static constexpr void erase(Position position) { *position.word &= ~position.bit; }
  // Swaps the bits at two positions.
  static constexpr void exchange(Position a, Position b) {
    const std::uint32_t in_a = *a.word & a.bit;
    const std::uint32_t in_b = *b.word & b.bit;
    if ((in_a | in_b) == 0 || (in_a != 0 && in_b != 0)) return;
    *a.word ^= a.bit;
    *b.word ^= b.bit;
  }
  static constexpr bool contains(Position position) { return (*position.word & position.bit) != 0; }

  // The highest rank in the set; the number of ranks if it is empty.
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
