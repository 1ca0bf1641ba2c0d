// A set of rules: one bit each, and one word above that says which words of them are not empty.
//
// Going through the members costs the members, and next to nothing for the rules in between; an empty
// set, as most are in most steps, costs the look at one word.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "runtime-m4/limits.hpp"

namespace robosync::layers {

// The rules of a behaviour, which stand one behind the other.
struct RuleRange {
  unsigned first;
  unsigned end;
};

// The bits alone, for sets that are many and are only added to others.
template <unsigned kRules>
struct BasicRuleBits {
  using Word = std::uint32_t;
  static constexpr unsigned kBits = 32;
  static constexpr unsigned kWords = (kRules + kBits - 1) / kBits;

  void insert(unsigned rule) { words[rule / kBits] |= Word{1} << rule % kBits; }
  bool has(unsigned rule) const { return (words[rule / kBits] >> rule % kBits & 1) != 0; }

  std::array<Word, kWords> words{};
};

template <unsigned kRules>
class BasicRuleSet {
  using Bits = BasicRuleBits<kRules>;
  using Word = typename Bits::Word;
  static constexpr unsigned kBits = Bits::kBits;
  static constexpr unsigned kWords = Bits::kWords;
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

  [[gnu::always_inline]] void insert(unsigned rule) {
    words_[rule / kBits] |= bit(rule);
    summary_ |= bit(rule / kBits);
  }
  [[gnu::always_inline]] void erase(unsigned rule) {
    Word& word = words_[rule / kBits];
    word &= ~bit(rule);
    if (word == 0) summary_ &= ~bit(rule / kBits);
  }
  [[gnu::always_inline]] void put(unsigned rule, bool in) { in ? insert(rule) : erase(rule); }
  [[gnu::always_inline]] bool empty() const { return summary_ == 0; }
  [[gnu::always_inline]] bool has(unsigned rule) const {
    return (words_[rule / kBits] & bit(rule)) != 0;
  }

  void clear() {
    for_words(*this, [&](unsigned w) { words_[w] = 0; });
    summary_ = 0;
  }
  BasicRuleSet& operator|=(const Bits& others) {
    for (unsigned w = 0; w < kWords; ++w)
      if (others.words[w] != 0) {
        words_[w] |= others.words[w];
        summary_ |= bit(w);
      }
    return *this;
  }

  // Calls take(rule) for each member in `rules`, in order; take may erase it.
  template <class Take>
  void each_in(RuleRange rules, Take take) const {
    each_of(
        rules, [this](unsigned w) { return words_[w]; }, take);
  }
  // … for each that is in this set or in `other`.
  template <class Take>
  void each_in_either(const BasicRuleSet& other, RuleRange rules, Take take) const {
    each_of(
        rules, [&](unsigned w) { return words_[w] | other.words_[w]; }, take);
  }
  bool has_any(RuleRange rules) const { return from(rules.first) < rules.end; }

  // The first member that is not below `rule`; kEnd when there is none.
  [[gnu::always_inline]] unsigned from(unsigned rule) const {
    return empty() ? kEnd : find_from(rule);
  }

  [[gnu::always_inline]] Iterator begin() const { return {*this, from(0)}; }
  [[gnu::always_inline]] Iterator end() const { return {*this, kEnd}; }

private:
  static constexpr Word bit(unsigned index) { return Word{1} << index % kBits; }
  static unsigned lowest(unsigned w, Word word) {
    return w * kBits + static_cast<unsigned>(std::countr_zero(word));
  }

  template <class WordAt, class Take>
  static void each_of(RuleRange rules, WordAt word_at, Take take) {
    unsigned w = rules.first / kBits;
    Word inside = ~Word{0} << rules.first % kBits;
    for (; w * kBits < rules.end; ++w, inside = ~Word{0}) {
      for (Word left = word_at(w) & inside; left != 0; left &= left - 1) {
        const unsigned rule = lowest(w, left);
        if (rule >= rules.end) break;
        take(rule);
      }
    }
  }

  [[gnu::noinline]] unsigned find_from(unsigned rule) const {
    const unsigned w = rule / kBits;
    if (w >= kWords) return kEnd;
    if (const Word rest = words_[w] & ~Word{0} << rule % kBits; rest != 0) return lowest(w, rest);
    const Word later = summary_ & ~Word{1} << w;
    if (later == 0) return kEnd;
    const auto next = static_cast<unsigned>(std::countr_zero(later));
    return lowest(next, words_[next]);
  }

  template <class Each>
  static void for_words(const BasicRuleSet& set, Each each) {
    for (Word left = set.summary_; left != 0; left &= left - 1)
      each(static_cast<unsigned>(std::countr_zero(left)));
  }

  std::array<Word, kWords> words_{};
  Word summary_ = 0;  // bit w: word w is not 0
};

using RuleBits = BasicRuleBits<kMaxRules>;
using RuleSet = BasicRuleSet<kMaxRules>;

}  // namespace robosync::layers
