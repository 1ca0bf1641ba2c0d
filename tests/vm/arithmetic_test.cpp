// Arithmetic against the naive one of tests/oracles: saturation, rounding, unknown.
#include "vm/arithmetic.hpp"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "tests/oracles/rsl/values.hpp"

using namespace robosync::vm;
namespace oracle = robosync::oracle;

namespace {

const auto model_multiply = oracle::on_values(oracle::multiply);
const auto model_divide = oracle::on_values(oracle::divide);

// Known values of every size, and the ends of the range often.
rc::Gen<Value> known() {
  const auto of_any_size = rc::gen::map(
      rc::gen::pair(rc::gen::arbitrary<std::uint32_t>(), rc::gen::inRange(0, 32)), [](auto pair) {
        const auto size = static_cast<Value>((pair.first & INT32_MAX) >> pair.second % 31);
        return pair.first >> 31 != 0 ? -size : size;
      });
  const auto corner = rc::gen::element<Value>(0, 1, -1, 2, 499, 500, 501, -500, 999, 1000, 1001,
                                              1500, -1500, 65535, 65536, kValueMax, kValueMax - 1,
                                              kValueMin, kValueMin + 1, 1 << 30, -(1 << 30));
  return rc::gen::weightedOneOf<Value>({{4, of_any_size}, {1, corner}});
}

template <typename Operation, typename Model>
void agrees(Operation operation, Model model) {
  CHECK(rc::check([&] {
    for (int i = 0; i < 500; ++i) {
      const Value b = *known();
      const Value c = *known();
      const Value result = operation(b, c);
      RC_ASSERT(result == model(b, c));
      RC_ASSERT(result != kUnknown);
    }
  }));
}

}  // namespace

TEST_CASE("add and subtract are exact or saturate") {
  agrees(add, oracle::on_values(oracle::add));
  agrees(subtract, oracle::on_values(oracle::subtract));
  CHECK(add(kValueMin, -1) == kValueMin);
  CHECK(add(-1, kValueMin) == kValueMin);
  CHECK(subtract(kValueMin, 1) == kValueMin);
  CHECK(add(kValueMax, 1) == kValueMax);
}

TEST_CASE("multiply rounds the exact product half away from zero") {
  agrees(multiply, model_multiply);
  CHECK(multiply(1, 500) == 1);  // 0.001 * 0.5 = 0.0005
  CHECK(multiply(1, 499) == 0);
  CHECK(multiply(-1, 500) == -1);
  CHECK(multiply(100, 200) == 20);  // 0.1 * 0.2
  CHECK(multiply(kValueMax, kScale) == kValueMax);
  CHECK(multiply(kValueMin, kScale) == kValueMin);
  CHECK(multiply(kValueMax, kValueMin) == kValueMin);
}

TEST_CASE("divide rounds the exact quotient half away from zero") {
  agrees(divide, model_divide);
  CHECK(divide(kScale, 3 * kScale) == 333);
  CHECK(divide(2 * kScale, 3 * kScale) == 667);
  CHECK(divide(1, 2 * kScale) == 1);  // 0.0005
  CHECK(divide(-1, 2 * kScale) == -1);
  CHECK(divide(kValueMax, 1) == kValueMax);
  CHECK(divide(kValueMin, 1) == kValueMin);
  CHECK(divide(kValueMax, 0) == 0);
  CHECK(divide(0, 0) == 0);
}

TEST_CASE("divide by large divisors, where the estimate of the quotient is at its worst") {
  // Found by search: the second round's estimate is one too small.
  for (const auto& [b, c] : {std::pair{1649837425, 5303690},
                             {734066024, 22971508},
                             {2146971965, 4210719},
                             {2146668094, 4238737}}) {
    CHECK(divide(b, c) == model_divide(b, c));
    CHECK(divide(-b, c) == model_divide(-b, c));
  }
  CHECK(rc::check([] {
    for (int i = 0; i < 1000; ++i) {
      const Value b = kValueMax - *rc::gen::inRange(0, 1000000);
      const Value c = *rc::gen::inRange((1 << 22) - 100, (1 << 22) + 70000);
      RC_ASSERT(divide(b, c) == model_divide(b, c));
    }
  }));
}

TEST_CASE("multiply and divide are right around every multiple where they round or saturate") {
  const auto near = [](std::int64_t value, auto check) {
    for (std::int64_t v = value - 2; v <= value + 2; ++v)
      if (v >= kValueMin && v <= kValueMax) check(static_cast<Value>(v));
  };
  for (int shift = 0; shift < 31; ++shift) {
    const auto factor = static_cast<Value>(1U << shift);
    for (const std::int64_t quotient : {std::int64_t{1}, std::int64_t{125}, std::int64_t{65536},
                                        std::int64_t{kValueMax} / 2, std::int64_t{kValueMax}}) {
      near(quotient * kScale / factor, [&](Value b) {
        REQUIRE(multiply(b, factor) == model_multiply(b, factor));
        REQUIRE(multiply(-b, factor) == model_multiply(-b, factor));
      });
      near(quotient * factor / kScale, [&](Value b) {
        near(factor, [&](Value c) {
          REQUIRE(divide(b, c) == model_divide(b, c));
          REQUIRE(divide(b, -c) == model_divide(b, -c));
        });
      });
    }
  }
}

TEST_CASE("modulo has the sign of the divisor") {
  agrees(modulo, oracle::on_values(oracle::modulo));
  CHECK(modulo(370 * kScale, 360 * kScale) == 10 * kScale);
  CHECK(modulo(-10 * kScale, 360 * kScale) == 350 * kScale);
  CHECK(modulo(10, -3) == -2);
  CHECK(modulo(kValueMin, -1) == 0);
  CHECK(modulo(5, 0) == 0);
}

TEST_CASE("anything with unknown is unknown") {
  CHECK(rc::check([](void) {
    const Value other = *rc::gen::oneOf(known(), rc::gen::just(kUnknown));
    for (const auto operation : {add, subtract, +[](Value b, Value c) { return multiply(b, c); },
                                 +[](Value b, Value c) { return divide(b, c); },
                                 +[](Value b, Value c) { return modulo(b, c); }}) {
      RC_ASSERT(operation(kUnknown, other) == kUnknown);
      RC_ASSERT(operation(other, kUnknown) == kUnknown);
    }
  }));
  CHECK(negate(kUnknown) == kUnknown);
  CHECK(logical_not(kUnknown) == kUnknown);
}

TEST_CASE("negation and NOT") {
  CHECK(negate(kValueMax) == kValueMin);
  CHECK(negate(kValueMin) == kValueMax);
  CHECK(negate(0) == 0);
  CHECK(logical_not(kTrue) == kFalse);
  CHECK(logical_not(kFalse) == kTrue);
}

TEST_CASE("relations of known values, over the whole range") {
  CHECK(rc::check([] {
    for (int i = 0; i < 500; ++i) {
      const Value b = *known();
      const Value c = *rc::gen::oneOf(known(), rc::gen::just(b));
      RC_ASSERT(is_less(b, c) == truth(b < c));
      RC_ASSERT(is_greater(b, c) == truth(b > c));
      RC_ASSERT(is_not_less(b, c) == truth(b >= c));
      RC_ASSERT(is_not_greater(b, c) == truth(b <= c));
      RC_ASSERT(is_equal(b, c) == truth(b == c));
      RC_ASSERT(is_not_equal(b, c) == truth(b != c));
    }
  }));
}
