// A set of rules: one bit per rule, in words that the caller owns, and one summary word that says which
// of them are not empty. So there are at most policy::kMaxRules rules.
//
// Iterating costs time per member and next to nothing for the rules in between. An empty set, as most
// sets are in most steps, costs a look at one word.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::layers {

// The rules of a behaviour, which are consecutive.
struct RuleRange {
  unsigned first;
  unsigned end;
};

// The bits without the summary, for the many sets that are only added to others. Like a span, a copy
// refers to the same bits.
class RuleBits {
public:
  using Word = std::uint32_t;
  static constexpr unsigned kBits = 32;

  explicit RuleBits(Word* words) : words_(words) {}
  void insert(unsigned rule) { words_[rule / kBits] |= Word{1} << rule % kBits; }
  void erase(unsigned rule) { words_[rule / kBits] &= ~(Word{1} << rule % kBits); }
  bool has(unsigned rule) const { return (words_[rule / kBits] >> rule % kBits & 1) != 0; }
  // Empties the words that contain `rules`. Nobody needs their neighbours' bits in these words by then.
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

  RuleSet() = default;  // for no rules
  RuleSet(const RuleSet&) = delete;
  RuleSet& operator=(const RuleSet&) = delete;

  // Uses `words` from now on, all of which are 0: one bit per rule.
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
  // Bit r % 32 of word r / 32: rule r.
  std::span<const Word> words() const { return {words_, count_}; }

  void clear() {
    for (; summary_ != 0; summary_ &= summary_ - 1)
      words_[std::countr_zero(summary_)] = 0;
  }
  void insert_all(RuleRange rules) {
    for (unsigned rule = rules.first; rule < rules.end; ++rule)
      insert(rule);
  }
  // Both sets cover the same number of rules; bit w of `summary`: word w of the others is not 0.
  void insert_all(RuleBits others, Word summary) {
    summary_ |= summary;
    for (; summary != 0; summary &= summary - 1) {
      const auto w = static_cast<unsigned>(std::countr_zero(summary));
      words_[w] |= others.words_[w];
    }
  }

  // Calls take(rule) for each member, in order. take may add and remove members: a rule counts if it is
  // a member when its turn comes.
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
  // … for each in `rules`; take may erase the current one.
  template <class Take>
  void each_in(RuleRange rules, Take take) const {
    each_of(
        rules, [this](unsigned w) { return words_[w]; }, take);
  }
  // … for each in `rules` that is in this set or in the others.
  template <class Take>
  void each_in_either(RuleBits others, RuleRange rules, Take take) const {
    each_of(
        rules, [&](unsigned w) { return words_[w] | others.words_[w]; }, take);
  }
  bool has_any(RuleRange rules) const { return first_of(rules.first, *this) < rules.end; }
  // Of the members in `rules`, keeps only those that are in one of the others.
  template <class... Others>
  void keep_in(RuleRange rules, const Others&... others) {
    for (unsigned w = rules.first / kBits; w * kBits < rules.end; ++w) {
      words_[w] &= (others.words_[w] | ...) | ~inside(rules, w);
      if (words_[w] == 0) summary_ &= ~bit(w);
    }
  }
  RuleBits bits() const { return RuleBits(words_); }

  // The first member, at or above `rule`, of any of the sets, which all cover the same number of rules; kEnd if none.
  template <class... Others>
  static unsigned first_of(unsigned rule, const RuleSet& set, const Others&... others) {
    const unsigned w = rule / kBits;
    if (w >= set.count_) return kEnd;
    const Word rest = (set.words_[w] | ... | others.words_[w]) & ~Word{0} << rule % kBits;
    return rest != 0 ? lowest(w, rest) : first_after(w, set, others...);
  }
  // … and the one after it.
  struct Two {
    unsigned first;
    unsigned second;
  };
  template <class... Others>
  [[gnu::always_inline]] static Two first_two_of(unsigned rule, const RuleSet& set,
                                                 const Others&... others) {
    const unsigned first = first_of(rule, set, others...);
    if (first == kEnd) return {kEnd, kEnd};
    const unsigned w = first / kBits;
    const Word rest = (set.words_[w] | ... | others.words_[w]) & ~Word{1} << first % kBits;
    return {first, rest != 0 ? lowest(w, rest) : first_after(w, set, others...)};
  }

private:
  static constexpr unsigned kBits = RuleBits::kBits;
  static constexpr Word bit(unsigned index) { return Word{1} << index % kBits; }
  // … after those of word `w`.
  template <class... Others>
  static unsigned first_after(unsigned w, const RuleSet& set, const Others&... others) {
    if (w + 1 >= set.count_) return kEnd;
    const Word later = (set.summary_ | ... | others.summary_) & ~Word{1} << w;
    if (later == 0) return kEnd;
    w = static_cast<unsigned>(std::countr_zero(later));
    return lowest(w, (set.words_[w] | ... | others.words_[w]));
  }
  [[gnu::always_inline]] static unsigned lowest(unsigned w, Word word) {
    return w * kBits + static_cast<unsigned>(std::countr_zero(word));
  }
  // The bits of word `w` that are in `rules`; at least one is.
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
  std::uint32_t count_ = 0;  // number of words
};

// One of `count` equally long pieces of `words`, for several sets in one part.
inline std::span<RuleSet::Word> part_of(std::span<RuleSet::Word> words, std::size_t count,
                                        std::size_t place) {
  const std::size_t each = words.size() / count;
  return words.subspan(place * each, each);
}

}  // namespace robosync::layers
