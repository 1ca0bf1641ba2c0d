// What a rule may do and when, and which rule gives way.
#include "runtime-m4/policy/rules.hpp"

#include <array>

#include <catch2/catch.hpp>

using namespace robosync;

TEST_CASE("no period is shorter than a millisecond") {
  CHECK(policy::period_ms(0) == 1);
  CHECK(policy::period_ms(-5) == 1);
  CHECK(policy::period_ms(250) == 250);
  CHECK(policy::milliseconds_of(-5) == 0);
  CHECK(policy::sample_period_ms(vm::Check{}) == 1);
}

TEST_CASE("a WHILE claims again, and a rule that waits for its actuators") {
  std::array<vm::Modifiers, 2> modifiers{};
  modifiers[0].cooldown = 100;
  modifiers[1].waiting = 100;
  vm::Image image;
  image.modifiers = modifiers;
  vm::Rule rule{};
  rule.kind = vm::RuleKind::when;
  rule.modifiers = vm::kNoModifiers;
  CHECK(policy::modifiers_of(image, rule).cooldown == 0);
  CHECK_FALSE(policy::claims_again(image, rule));
  rule.modifiers = 0;
  CHECK(policy::modifiers_of(image, rule).cooldown == 100);
  CHECK_FALSE(policy::claims_again(image, rule));
  rule.modifiers = 1;
  CHECK(policy::claims_again(image, rule));
  rule = {};
  rule.kind = vm::RuleKind::while_;
  rule.modifiers = vm::kNoModifiers;
  CHECK(policy::claims_again(image, rule));
}

TEST_CASE("a trigger takes from its own behaviour and lower ones, a retry from lower ones only") {
  CHECK(policy::may_take(3, 3, false));
  CHECK(policy::may_take(3, 4, false));
  CHECK_FALSE(policy::may_take(3, 2, false));
  CHECK_FALSE(policy::may_take(3, 3, true));
  CHECK(policy::may_take(3, 4, true));
  CHECK_FALSE(policy::may_take(3, 2, true));
}
