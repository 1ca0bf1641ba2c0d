// Adaptive priorities compared with the formula in wide arithmetic, and the formula's guarantees for any
// numbers.
#include "runtime-m4/policy/adaptation.hpp"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using namespace robosync::policy;

namespace {

constexpr AdaptationRule kRule{.alpha = 2000, .window_ms = 10'000, .cap = 95};

AdaptationRule draw_rule() {
  return {.alpha = *rc::gen::arbitrary<std::uint16_t>(),
          .window_ms = *rc::gen::inRange<std::uint16_t>(1, UINT16_MAX),
          .cap = *rc::gen::inRange<std::int8_t>(1, 100)};
}

std::int8_t draw_base() {
  return *rc::gen::inRange<std::int8_t>(-64, 100);
}

int naive(int base, std::int64_t triggers, const AdaptationRule& rule) {
  const double seconds = rule.window_ms / 1000.0;
  const double raise = rule.alpha / 1000.0 * static_cast<double>(triggers) / seconds;
  const double reached = base + raise;
  if (base >= rule.cap) return base;
  return reached >= rule.cap ? rule.cap : base + static_cast<int>(raise + 1e-9);
}

}  // namespace

TEST_CASE("α·F/W: five triggers a second at α = 2 are worth ten") {
  CHECK(adapted(40, 50, kRule) == Priority{50, 40});
  CHECK(adapted(40, 0, kRule) == Priority{40, 40});
  CHECK(adapted(40, 4, kRule) == Priority{40, 40});  // 0.8: whole numbers, rounded down
  CHECK(adapted(40, 5, kRule) == Priority{41, 40});
}

TEST_CASE("the cap: nobody is raised beyond it, nobody is lowered to it") {
  CHECK(adapted(40, 60'000, kRule) == Priority{95, 40});
  CHECK(adapted(95, 60'000, kRule) == Priority{95, 95});
  CHECK(adapted(99, 60'000, kRule) == Priority{99, 99});
}

TEST_CASE("without α every behaviour keeps its base") {
  CHECK(adapted(40, 60'000, AdaptationRule{}) == Priority{40, 40});
}

TEST_CASE("the policy is the formula, whatever the numbers") {
  CHECK(rc::check([] {
    const AdaptationRule rule = draw_rule();
    const std::int8_t base = draw_base();
    const auto triggers = *rc::gen::arbitrary<TriggerCount>();
    const Priority result = adapted(base, triggers, rule);
    RC_ASSERT(result.now == naive(base, triggers, rule));
    RC_ASSERT(result.base == base);
  }));
}

TEST_CASE("more triggers never make a behaviour worth less, and none is beyond safety") {
  CHECK(rc::check([] {
    const AdaptationRule rule = draw_rule();
    const std::int8_t base = draw_base();
    const auto few = *rc::gen::arbitrary<TriggerCount>();
    const auto many = *rc::gen::inRange<int>(few, 65'536);
    const Priority calm = adapted(base, few, rule);
    const Priority busy = adapted(base, static_cast<TriggerCount>(many), rule);
    RC_ASSERT(busy >= calm);
    RC_ASSERT(standing(Category::control, busy) < standing(Category::safety, std::int8_t{-128}));
  }));
}

TEST_CASE("two behaviours are never equal, and equal triggers keep their order") {
  CHECK(rc::check([] {
    const AdaptationRule rule = draw_rule();
    const std::int8_t one = draw_base();
    const std::int8_t other = draw_base();
    RC_PRE(one < other);
    const auto triggers = *rc::gen::arbitrary<TriggerCount>();
    RC_ASSERT(adapted(one, triggers, rule) < adapted(other, triggers, rule));
    const auto others = *rc::gen::arbitrary<TriggerCount>();
    RC_ASSERT(adapted(one, triggers, rule) != adapted(other, others, rule));
  }));
}
