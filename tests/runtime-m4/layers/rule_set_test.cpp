// Sets of rules against std::set, in the sizes of both profiles and at the edges of words.
#include "runtime-m4/layers/rule_set.hpp"

#include <set>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using robosync::layers::BasicRuleSet;

namespace {

template <unsigned kRules>
std::vector<unsigned> members(const BasicRuleSet<kRules>& set) {
  std::vector<unsigned> all;
  for (const unsigned rule : set)
    all.push_back(rule);
  return all;
}

template <unsigned kRules>
void check_same(const BasicRuleSet<kRules>& set, const std::set<unsigned>& model) {
  RC_ASSERT(members(set) == std::vector<unsigned>(model.begin(), model.end()));
  RC_ASSERT(set.empty() == model.empty());
  for (unsigned rule = 0; rule <= kRules; ++rule) {
    if (rule < kRules) RC_ASSERT(set.has(rule) == model.contains(rule));
    const auto next = model.lower_bound(rule);
    RC_ASSERT(set.from(rule) == (next == model.end() ? BasicRuleSet<kRules>::kEnd : *next));
  }
}

template <unsigned kRules>
void behaves_like_a_set(const std::vector<std::uint16_t>& operations) {
  BasicRuleSet<kRules> set;
  BasicRuleSet<kRules> other;
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
        other_model.insert(rule);
        break;
      case 6:
        set |= other;
        model.insert(other_model.begin(), other_model.end());
        break;
      default:
        if (rule % 4 != 0) break;  // not so often that nothing is ever in it
        set.clear();
        model.clear();
    }
  }
  check_same(set, model);
  check_same(other, other_model);
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
  BasicRuleSet<1000> set;
  for (const unsigned rule : {3U, 31U, 32U, 500U})
    set.insert(rule);
  std::vector<unsigned> seen;
  for (const unsigned rule : set) {
    seen.push_back(rule);
    if (rule == 31) {
      set.erase(3);
      set.erase(32);
      set.insert(999);
    }
  }
  CHECK(seen == std::vector<unsigned>{3, 31, 500, 999});
}

TEST_CASE("forty rules take two words") {
  CHECK(sizeof(BasicRuleSet<40>) == 8);
  CHECK(sizeof(BasicRuleSet<1000>) == 33 * 4);
}
