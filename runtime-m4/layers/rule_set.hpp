// A set of rules: one bit each, and above many words one word that says which of them are not
// empty.
//
// Going through the members costs the members, and next to nothing for the rules in between.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "runtime-m4/limits.hpp"

namespace robosync::layers {

template <unsigned kRules>
class BasicRuleSet {
  using Word = std::uint32_t;
  static constexpr unsigned kBits = 32;
  static constexpr unsigned kWords = (kRules + kBits - 1) / kBits;
  static constexpr bool kSummarised = kWords > 2;  // two are looked at as fast as a summary
  static_assert(kWords <= kBits, "one summary word has one bit for each");

public:
  static constexpr unsigned kEnd = kWords * kBits;  // no rule has this number

  // A member, and on to the next. Members may come and go on the way: what counts is whether one is
  // there when its turn comes.
  class Iterator {
  public:
    Iterator(const BasicRuleSet& set, unsigned rule) : set_(set), rule_(rule) {}
    unsigned operator*() const { return rule_; }
    Iterator& operator++() {
      rule_ = set_.from(rule_ + 1);
      return *this;
    }
    bool operator!=(const Iterator& other) const { return rule_ != other.rule_; }

  private:
    const BasicRuleSet& set_;
    unsigned rule_;
  };

  void insert(unsigned rule) {
    words_[rule / kBits] |= bit(rule);
    if constexpr (kSummarised) summary_ |= bit(rule / kBits);
  }
  void erase(unsigned rule) {
    Word& word = words_[rule / kBits];
    word &= ~bit(rule);
    if constexpr (kSummarised)
      if (word == 0) summary_ &= ~bit(rule / kBits);
  }
  void put(unsigned rule, bool in) { in ? insert(rule) : erase(rule); }
  bool empty() const { return from(0) == kEnd; }
  bool has(unsigned rule) const { return (words_[rule / kBits] & bit(rule)) != 0; }

  void clear() {
    for_words(*this, [&](unsigned w) { words_[w] = 0; });
    summary_ = {};
  }
  BasicRuleSet& operator|=(const BasicRuleSet& other) {
    for_words(other, [&](unsigned w) { words_[w] |= other.words_[w]; });
    if constexpr (kSummarised) summary_ |= other.summary_;
    return *this;
  }

  // The first member that is not below `rule`; kEnd when there is none.
  unsigned from(unsigned rule) const {
    unsigned w = rule / kBits;
    if (w >= kWords) return kEnd;
    if (const Word rest = words_[w] & ~Word{0} << rule % kBits; rest != 0) return lowest(w, rest);
    w = next_word(w);
    return w == kWords ? kEnd : lowest(w, words_[w]);
  }

  Iterator begin() const { return {*this, from(0)}; }
  Iterator end() const { return {*this, kEnd}; }

private:
  static constexpr Word bit(unsigned index) { return Word{1} << index % kBits; }
  static unsigned lowest(unsigned w, Word word) {
    return w * kBits + static_cast<unsigned>(std::countr_zero(word));
  }

  // The first word behind `w` with a member; kWords when there is none.
  unsigned next_word(unsigned w) const {
    if constexpr (kSummarised) {
      const Word later = summary_ & ~Word{1} << w;
      return later == 0 ? kWords : static_cast<unsigned>(std::countr_zero(later));
    } else {
      do
        ++w;
      while (w < kWords && words_[w] == 0);
      return w;
    }
  }

  template <class Each>
  static void for_words(const BasicRuleSet& set, Each each) {
    if constexpr (kSummarised) {
      for (Word left = set.summary_; left != 0; left &= left - 1)
        each(static_cast<unsigned>(std::countr_zero(left)));
    } else {
      for (unsigned w = 0; w < kWords; ++w)
        each(w);
    }
  }

  std::array<Word, kWords> words_{};
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<kSummarised, Word, Nothing>
      summary_{};  // bit w: word w is not 0
};

using RuleSet = BasicRuleSet<kMaxRules>;

}  // namespace robosync::layers
