// Sets of rules compared with std::set, with as many rules as a program may have, and at word boundaries.
#include <iterator>
#include <set>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "tests/runtime-m4/layers/owned_rule_set.hpp"

using robosync::layers::RuleBits;
using robosync::layers::RuleSet;
using robosync::test::OwnedRuleSet;

namespace {

std::vector<unsigned> members(const RuleSet& set) {
  std::vector<unsigned> all;
  set.each([&](unsigned rule) { all.push_back(rule); });
  return all;
}

template <unsigned kRules>
void check_same(const RuleSet& set, const std::set<unsigned>& model) {
  RC_ASSERT(members(set) == std::vector<unsigned>(model.begin(), model.end()));
  RC_ASSERT(set.empty() == model.empty());
  for (unsigned rule = 0; rule <= kRules; ++rule) {
    if (rule < kRules) RC_ASSERT(set.has(rule) == model.contains(rule));
    const auto next = model.lower_bound(rule);
    const unsigned first = next == model.end() ? RuleSet::kEnd : *next;
    RC_ASSERT(RuleSet::first_of(rule, set) == first);
    const auto after = next == model.end() ? next : std::next(next);
    const RuleSet::Two two = RuleSet::first_two_of(rule, set);
    RC_ASSERT(two.first == first);
    RC_ASSERT(two.second == (after == model.end() ? RuleSet::kEnd : *after));
  }
}

// A behaviour's rules in this set, and in this set or another; then only those of them that are in the other.
template <unsigned kRules>
void check_range(RuleSet& set, const RuleSet& other, unsigned first, unsigned end) {
  std::vector<unsigned> mine;
  std::vector<unsigned> either;
  std::vector<unsigned> expected_mine;
  std::vector<unsigned> expected_either;
  set.each_in({first, end}, [&](unsigned rule) { mine.push_back(rule); });
  set.each_in_either(other.bits(), {first, end}, [&](unsigned rule) { either.push_back(rule); });
  for (unsigned rule = first; rule < end; ++rule) {
    if (set.has(rule)) expected_mine.push_back(rule);
    if (set.has(rule) || other.has(rule)) expected_either.push_back(rule);
  }
  RC_ASSERT(mine == expected_mine);
  RC_ASSERT(either == expected_either);
  RC_ASSERT(set.has_any({first, end}) == !expected_mine.empty());
  const unsigned next = either.empty() ? RuleSet::kEnd : either.front();
  const unsigned found = RuleSet::first_of(first, set, other);
  RC_ASSERT((found < end ? found : RuleSet::kEnd) == next);

  std::set<unsigned> kept;
  for (const unsigned rule : members(set))
    if (rule < first || rule >= end || other.has(rule)) kept.insert(rule);
  set.keep_in({first, end}, other.bits());
  check_same<kRules>(set, kept);
}

template <unsigned kRules>
void behaves_like_a_set(const std::vector<std::uint16_t>& operations) {
  OwnedRuleSet words(kRules);
  OwnedRuleSet other_words(kRules);
  std::vector<RuleSet::Word> bits(robosync::policy::set_words(kRules));
  RuleBits other_bits(bits.data());
  RuleSet::Word other_summary = 0;
  RuleSet& set = *words;
  RuleSet& other = *other_words;
  std::set<unsigned> model;
  std::set<unsigned> other_model;
  for (const std::uint16_t operation : operations) {
    const unsigned rule = operation / 8 % kRules;
    switch (operation % 8) {
      case 0:
      case 1:
      case 2:
        set.insert(rule);
        model.insert(rule);
        break;
      case 3:
      case 4:
        set.put(rule, false);
        model.erase(rule);
        break;
      case 5:
        other.put(rule, true);
        other_bits.insert(rule);
        other_summary |= RuleSet::Word{1} << rule / RuleBits::kBits;
        other_model.insert(rule);
        break;
      case 6:
        set.insert_all(other_bits, other_summary);
        model.insert(other_model.begin(), other_model.end());
        break;
      default:
        if (rule % 4 != 0) break;  // rarely, or the set would always be empty
        set.clear();
        model.clear();
    }
  }
  check_same<kRules>(set, model);
  check_same<kRules>(other, other_model);
  const unsigned first = *rc::gen::inRange(0U, kRules);
  check_range<kRules>(set, other, first, *rc::gen::inRange(first, kRules + 1));
}

}  // namespace

TEST_CASE("a set of rules is a set") {
  CHECK(rc::check("of 1", behaves_like_a_set<1>));
  CHECK(rc::check("of 40", behaves_like_a_set<40>));
  CHECK(rc::check("of 64", behaves_like_a_set<64>));
  CHECK(rc::check("of 65", behaves_like_a_set<65>));
  CHECK(rc::check("of 1000", behaves_like_a_set<1000>));
  CHECK(rc::check("of 1024", behaves_like_a_set<1024>));
}

TEST_CASE("members may come and go while they are gone through") {
  OwnedRuleSet words(1000);
  RuleSet& set = *words;
  for (const unsigned rule : {3U, 31U, 32U, 500U})
    set.insert(rule);
  std::vector<unsigned> seen;
  set.each([&](unsigned rule) {
    seen.push_back(rule);
    if (rule == 31) {
      set.erase(3);
      set.erase(32);
      set.insert(999);
    }
  });
  CHECK(seen == std::vector<unsigned>{3, 31, 500, 999});
}

TEST_CASE("a set of no rules is empty") {
  RuleSet set;
  set.clear();
  CHECK(set.empty());
  CHECK(members(set).empty());
}

TEST_CASE("sets in one piece of memory do not touch each other") {
  constexpr unsigned kRules = 100;
  std::vector<RuleSet::Word> words(3 * robosync::policy::set_words(kRules));
  RuleSet sets[3];
  for (unsigned i = 0; i < 3; ++i)
    sets[i].start(robosync::layers::part_of(words, 3, i));
  for (unsigned rule = 0; rule < kRules; ++rule)
    sets[1].insert(rule);
  CHECK(sets[0].empty());
  CHECK(sets[2].empty());
  sets[0].insert(0);
  sets[2].insert(kRules - 1);
  sets[1].clear();
  CHECK(members(sets[0]) == std::vector<unsigned>{0});
  CHECK(members(sets[2]) == std::vector<unsigned>{kRules - 1});
}
