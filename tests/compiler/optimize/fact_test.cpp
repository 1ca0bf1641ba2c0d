// Facts about results, against the results of all values that the operands may have.
#include "compiler/ir/fact.hpp"

#include <functional>
#include <span>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/oracles/rsl/values.hpp"

using namespace robosync;
using namespace robosync::compiler;

namespace {

using vm::kUnknown;
using vm::kValueMax;
using vm::kValueMin;
using vm::Value;

// A fact, and values that it allows: its ends among them.
struct Case {
  Fact fact;
  std::vector<Value> values;
};

Case case_of(std::span<const Value> all, std::size_t from, std::size_t to, bool known) {
  const auto part = all.subspan(from, to + 1 - from);
  Case made{{known, true, all[from], all[to]}, {part.begin(), part.end()}};
  for (const Value value : made.values)
    made.fact.whole = made.fact.whole && value % vm::kScale == 0;
  if (!known) made.values.push_back(kUnknown);
  return made;
}

// Every interval between two of the values; `all` rises.
std::vector<Case> intervals(const std::vector<Value>& all) {
  std::vector<Case> cases;
  for (std::size_t from = 0; from < all.size(); ++from)
    for (std::size_t to = from; to < all.size(); ++to)
      cases.push_back(case_of(all, from, to, (from + to) % 3 != 0));
  return cases;
}

const std::vector<std::vector<Value>> kNumbers = {
    {-4, -3, -2, -1, 0, 1, 2, 3, 4},
    {-4000, -3000, -2000, -1000, 0, 1000, 2000, 3000, 251000},
    {kValueMin, kValueMin + 1, -1000000, -999, 0, 7, 1001, kValueMax - 1000, kValueMax},
    {-2147483000, -2147482000, -1000000, -1000, 0, 1000, 1000000, 2147482000, 2147483000}};

bool allows(const Fact& fact, Value value) {
  if (value == kUnknown) return !fact.known;
  return fact.lies_in(fact.low, fact.high) && value >= fact.low && value <= fact.high &&
         (!fact.whole || value % vm::kScale == 0);
}

using OfFacts = Fact (*)(const Fact&, const Fact&);
using OfValues = std::function<Value(Value, Value)>;

// How many facts are more than "some number".
std::size_t check_all(const char* name, OfFacts of_facts, const OfValues& of_values) {
  std::size_t useful = 0;
  for (const std::vector<Value>& numbers : kNumbers) {
    const std::vector<Case> cases = intervals(numbers);
    for (const Case& b : cases)
      for (const Case& c : cases) {
        const Fact fact = of_facts(b.fact, c.fact);
        if (fact.known && (fact.low > kValueMin || fact.high < kValueMax)) ++useful;
        for (const Value x : b.values)
          for (const Value y : c.values) {
            const Value value = of_values(x, y);
            if (allows(fact, value)) continue;
            CAPTURE(name, x, y, value, fact.known, fact.whole, fact.low, fact.high);
            FAIL("the fact does not allow the value");
          }
      }
  }
  return useful;
}

// A comparison of two numbers as a Value.
template <typename Relation>
OfValues comparing(Relation holds) {
  return [holds](Value b, Value c) {
    if (b == kUnknown || c == kUnknown) return kUnknown;
    return holds(b, c) ? vm::kTrue : vm::kFalse;
  };
}

}  // namespace

TEST_CASE("facts about sums, products, quotients and remainders hold") {
  CHECK(check_all("add", add, oracle::on_values(oracle::add)) > 1000);
  CHECK(check_all("subtract", subtract, oracle::on_values(oracle::subtract)) > 1000);
  CHECK(check_all("multiply", multiply, oracle::on_values(oracle::multiply)) > 1000);
  CHECK(check_all("divide", divide, oracle::on_values(oracle::divide)) > 500);
  CHECK(check_all("modulo", modulo, oracle::on_values(oracle::modulo)) > 1000);
}

TEST_CASE("facts about ABS, MIN, MAX and ROUND hold") {
  CHECK(check_all("minimum", minimum, oracle::on_values(oracle::lesser)) > 1000);
  CHECK(check_all("maximum", maximum, oracle::on_values(oracle::greater)) > 1000);
  CHECK(check_all("round", round_to, oracle::on_values(oracle::to_multiple)) > 100);
  check_all(
      "absolute", [](const Fact& b, const Fact&) { return absolute(b); },
      oracle::on_values([](oracle::Number b, oracle::Number) { return oracle::absolute(b); }));
}

TEST_CASE("facts about comparisons hold, and decide what can be decided") {
  check_all("<", is_less, comparing(std::less<>()));
  check_all("<=", is_not_greater, comparing(std::less_equal<>()));
  check_all("=", is_equal, comparing(std::equal_to<>()));
  const Fact low = known_between(-5, 4, false);
  const Fact high = known_between(5, 9, false);
  CHECK(is_less(low, high) == known_between(vm::kTrue, vm::kTrue, false));
  CHECK(is_less(high, low) == known_between(vm::kFalse, vm::kFalse, false));
  CHECK(is_equal(low, high).never_true());
  CHECK(is_equal(fact_of(7), fact_of(7)).is_constant());
  CHECK(!is_less(low, low).is_constant());
}

TEST_CASE("facts about three-valued truths hold") {
  const std::vector<std::vector<Value>> sets = {
      {vm::kTrue},           {vm::kFalse},           {vm::kTrue, vm::kFalse},
      {vm::kTrue, kUnknown}, {vm::kFalse, kUnknown}, {vm::kTrue, vm::kFalse, kUnknown}};
  const auto fact_for = [](const std::vector<Value>& values) {
    Fact fact{true, false, vm::kFalse, vm::kTrue};
    for (const Value value : values) {
      if (value == kUnknown)
        fact.known = false;
      else
        fact = {fact.known, false, std::min(fact.low, value), std::max(fact.high, value)};
    }
    return fact;
  };
  for (const auto& left : sets)
    for (const auto& right : sets)
      for (const Value b : left)
        for (const Value c : right) {
          CAPTURE(b, c);
          const oracle::Truth one = oracle::truth_of(b);
          const oracle::Truth other = oracle::truth_of(c);
          const auto value = [](oracle::Truth truth) { return oracle::value_of(truth); };
          CHECK(allows(logical_and(fact_for(left), fact_for(right)),
                       value(oracle::both(one, other))));
          CHECK(allows(logical_or(fact_for(left), fact_for(right)),
                       value(oracle::either(one, other))));
          CHECK(allows(logical_not(fact_for(left)), value(oracle::opposite(one))));
        }
}

TEST_CASE("what saturates is no whole number") {
  const Fact most = fact_of(2147483000);
  CHECK(most.whole);
  CHECK(!add(most, most).whole);
  CHECK(!sum_fits(most, most));
  CHECK(add(most, fact_of(0)).whole);
  CHECK(!multiply(most, fact_of(2000)).whole);
  CHECK(!product_fits(most, fact_of(2000)));
  CHECK(product_fits(fact_of(1000000), fact_of(1000000)));
}

TEST_CASE("clamping and repeated sums keep what they can") {
  CHECK(clamp(known_between(-3000, 9000, true), 0, 5000) == known_between(0, 5000, true));
  CHECK(!clamp(known_between(-3000, 9000, true), 0, 4500).whole);
  CHECK(clamp(known_between(-3000, 4000, true), -5001, 4500).whole);
  CHECK(sum_of_up_to(1000, known_between(0, 250000, true)) == known_between(0, 250000000, true));
  CHECK(sum_of_up_to(3, known_between(-2000, 1000, true)) == known_between(-6000, 3000, true));
  CHECK(sum_of_up_to(2147483, known_between(5000, 5000, true)).high == kValueMax);
  CHECK(!sum_of_up_to(2147483, known_between(5000, 5000, true)).whole);
}
