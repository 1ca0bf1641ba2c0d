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
  void erase(unsigned rule) { words_[rule / kBits] &= ~(Word{1} << rule % kBits); }
  bool has(unsigned rule) const { return (words_[rule / kBits] >> rule % kBits & 1) != 0; }
  // Empties the words in which `rules` stand: of their neighbours' bits nobody needs any then.
  void clear_around(RuleRange rules) {
    for (unsigned w = rules.first / kBits; w * kBits < rules.end; ++w)
      words_[w] = 0;
  }

private:
  friend class RuleSet;
  Word* words_;
};

class RuleSet {
public:
  using Word = RuleBits::Word;
  static constexpr unsigned kEnd = 0xFFFF'FFFF;  // no rule has this number

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
  // Both of as many rules; bit w of `summary`: word w of the others is not 0.
  void insert_all(RuleBits others, Word summary) {
    summary_ |= summary;
    for (; summary != 0; summary &= summary - 1) {
      const auto w = static_cast<unsigned>(std::countr_zero(summary));
      words_[w] |= others.words_[w];
    }
  }

  // Calls take(rule) for each member, in order. Members may come and go on the way: what counts is
  // whether one is there when its turn comes.
  template <class Take>
  void each(Take take) const {
    for (Word left = summary_; left != 0;) {
      const auto w = static_cast<unsigned>(std::countr_zero(left));
      for (Word word = words_[w]; word != 0;) {
        const auto place = static_cast<unsigned>(std::countr_zero(word));
        take(w * kBits + place);
        word = words_[w] & ~Word{1} << place;
      }
      left = summary_ & ~Word{1} << w;
    }
  }
  // … for each in `rules`; take may erase it.
  template <class Take>
  void each_in(RuleRange rules, Take take) const {
    each_of(
        rules, [this](unsigned w) { return words_[w]; }, take);
  }
  // … for each in `rules` that is in this set or among the others.
  template <class Take>
  void each_in_either(RuleBits others, RuleRange rules, Take take) const {
    each_of(
        rules, [&](unsigned w) { return words_[w] | others.words_[w]; }, take);
  }
  bool has_any(RuleRange rules) const { return first_of(rules.first, *this) < rules.end; }
  // Of the members in `rules` only those stay that are in one of the others.
  template <class... Others>
  void keep_in(RuleRange rules, const Others&... others) {
    for (unsigned w = rules.first / kBits; w * kBits < rules.end; ++w) {
      words_[w] &= (others.words_[w] | ...) | ~inside(rules, w);
      if (words_[w] == 0) summary_ &= ~bit(w);
    }
  }
  RuleBits bits() const { return RuleBits(words_); }

  // The first member of any of the sets, all of as many rules, that is not below `rule`; kEnd when there is none.
  template <class... Others>
  static unsigned first_of(unsigned rule, const RuleSet& set, const Others&... others) {
    unsigned w = rule / kBits;
    if (w >= set.count_) return kEnd;
    const Word rest = (set.words_[w] | ... | others.words_[w]) & ~Word{0} << rule % kBits;
    if (rest != 0) return lowest(w, rest);
    const Word later = (set.summary_ | ... | others.summary_) & ~Word{1} << w;
    if (later == 0) return kEnd;
    w = static_cast<unsigned>(std::countr_zero(later));
    return lowest(w, (set.words_[w] | ... | others.words_[w]));
  }

private:
  static constexpr unsigned kBits = RuleBits::kBits;
  static constexpr Word bit(unsigned index) { return Word{1} << index % kBits; }
  [[gnu::always_inline]] static unsigned lowest(unsigned w, Word word) {
    return w * kBits + static_cast<unsigned>(std::countr_zero(word));
  }
  // The bits of word `w` that are in `rules`, of which one at least is.
  static Word inside(RuleRange rules, unsigned w) {
    const unsigned first = w * kBits;
    const Word from = first < rules.first ? ~Word{0} << rules.first % kBits : ~Word{0};
    return rules.end - first < kBits ? from & (bit(rules.end) - 1) : from;
  }
  template <class WordAt, class Take>
  static void each_of(RuleRange rules, WordAt word_at, Take take) {
    Word from = ~Word{0} << rules.first % kBits;
    for (unsigned w = rules.first / kBits; w * kBits < rules.end; ++w, from = ~Word{0}) {
      for (Word left = word_at(w) & from; left != 0; left &= left - 1) {
        const unsigned rule = lowest(w, left);
        if (rule >= rules.end) break;
        take(rule);
      }
    }
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
