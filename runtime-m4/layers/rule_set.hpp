// A set of rules: one bit each, in words that belong to somebody else, and one word above that says
// which of them are not empty. So there are at most policy::kMaxRules.
//
// Going through the members costs the members, and next to nothing for the rules in between; an empty
// set, as most are in most steps, costs the look at one word.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::layers {

// The rules of a behaviour, which stand one behind the other.
struct RuleRange {
  unsigned first;
  unsigned end;
};

// The bits alone, for sets that are many and are only added to others. Like a span: who copies it
// has the same bits.
class RuleBits {
public:
  using Word = std::uint32_t;
  static constexpr unsigned kBits = 32;

  explicit RuleBits(Word* words) : words_(words) {}
  void insert(unsigned rule) { words_[rule / kBits] |= Word{1} << rule % kBits; }
  bool has(unsigned rule) const { return (words_[rule / kBits] >> rule % kBits & 1) != 0; }

private:
  friend class RuleSet;
  Word* words_;
};

class RuleSet {
public:
  using Word = RuleBits::Word;
  static constexpr unsigned kEnd = 0xFFFF'FFFF;  // no rule has this number

  // A member, and on to the next. Members may come and go on the way: what counts is whether one is
  // there when its turn comes.
  class Iterator {
  public:
    Iterator(const RuleSet& set, unsigned rule) : set_(set), rule_(rule) {}
    unsigned operator*() const { return rule_; }
    Iterator& operator++() {
      rule_ = set_.from(rule_ + 1);
      return *this;
    }
    bool operator!=(const Iterator& other) const { return rule_ != other.rule_; }

  private:
    const RuleSet& set_;
    unsigned rule_;
  };

  RuleSet() = default;  // of no rules
  RuleSet(const RuleSet&) = delete;
  RuleSet& operator=(const RuleSet&) = delete;

  // From now on it stands in `words`, all of which are 0: one bit a rule.
  void start(std::span<Word> words) {
    words_ = words.data();
    count_ = static_cast<std::uint32_t>(words.size());
    summary_ = 0;
  }

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
    for (; summary_ != 0; summary_ &= summary_ - 1)
      words_[std::countr_zero(summary_)] = 0;
  }
  // Both of as many rules.
  RuleSet& operator|=(RuleBits others) {
    for (unsigned w = 0; w < count_; ++w)
      if (others.words_[w] != 0) {
        words_[w] |= others.words_[w];
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
  void each_in_either(const RuleSet& other, RuleRange rules, Take take) const {
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
  static constexpr unsigned kBits = RuleBits::kBits;
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
    if (w >= count_) return kEnd;
    if (const Word rest = words_[w] & ~Word{0} << rule % kBits; rest != 0) return lowest(w, rest);
    const Word later = summary_ & ~Word{1} << w;
    if (later == 0) return kEnd;
    const auto next = static_cast<unsigned>(std::countr_zero(later));
    return lowest(next, words_[next]);
  }

  Word* words_ = nullptr;
  Word summary_ = 0;         // bit w: word w is not 0
  std::uint32_t count_ = 0;  // of the words
};

// One of `count` pieces of `words` that are equally long, for sets of which there are several.
inline std::span<RuleSet::Word> part_of(std::span<RuleSet::Word> words, std::size_t count,
                                        std::size_t place) {
  const std::size_t each = words.size() / count;
  return words.subspan(place * each, each);
}

}  // namespace robosync::layers
