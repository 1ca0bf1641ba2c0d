// When a request takes its turn. That the step thread then waits for the link, and that it answers in time: bench/answer.py.
#include "runtime-m4/layers/link_turns.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "runtime-m4/policy/link_share.hpp"

using namespace robosync;
using layers::LinkTurns;

namespace {

constexpr std::uint32_t kCountsAMs = 25'000;
constexpr std::uint32_t kLightStep = 1'000;
constexpr std::uint32_t kHeavyStep = 100'000;  // the most that a board accepts

// A step thread that looks between two passes, and a link that hears only in its turns.
struct Passes {
  LinkTurns turns;
  double ms = 0;

  explicit Passes(std::uint32_t step_cost) { turns.start(step_cost); }

  LinkTurns::Now now() const {
    return {.time = kernel::milliseconds(static_cast<std::uint32_t>(ms)),
            .clock = static_cast<std::uint32_t>(ms * kCountsAMs)};
  }
  // Looks every millisecond: after how many it was time.
  unsigned waits_for_turn() {
    for (unsigned waited = 0; waited < 1000; ++waited, ms += 1)
      if (turns.waits() && turns.is_time(now())) return waited;
    return 1000;
  }
  void take_turn(double length) {
    const LinkTurns::Now begin = now();
    turns.has_heard(turns.asked());
    ms += length;
    turns.took(begin, now());
  }
};

}  // namespace

TEST_CASE("link turns: nobody waits who was not asked, or has done what it was asked") {
  Passes passes(kLightStep);
  CHECK_FALSE(passes.turns.waits());
  const std::uint32_t before = passes.turns.asked();
  passes.turns.ask();
  CHECK(passes.turns.waits());
  passes.turns.has_heard(before);  // it was asked while it was at work
  CHECK(passes.turns.waits());
  passes.turns.has_heard(passes.turns.asked());
  CHECK_FALSE(passes.turns.waits());
}

TEST_CASE("link turns: what one program left unheard is not the next one's matter") {
  Passes passes(kLightStep);
  passes.turns.ask();
  passes.turns.start(kLightStep);
  CHECK_FALSE(passes.turns.waits());
}

TEST_CASE("link turns: short steps leave time to wait, long ones none") {
  Passes light(kLightStep);
  light.turns.ask();
  CHECK(light.waits_for_turn() == (policy::link_patience_us(kLightStep) + 999) / 1000);
  Passes heavy(kHeavyStep);
  heavy.turns.ask();
  CHECK(heavy.waits_for_turn() == 0);
}

TEST_CASE("link turns: a wait begins anew when the link has heard") {
  Passes passes(kLightStep);
  const std::uint32_t patience = policy::link_patience_us(kLightStep) / 1000;
  for (int round = 0; round < 3; ++round) {
    passes.turns.ask();
    CHECK(passes.turns.waits());
    CHECK_FALSE(passes.turns.is_time(passes.now()));
    passes.ms += patience - 1;
    passes.turns.ask();  // more of the same
    CHECK_FALSE(passes.turns.is_time(passes.now()));
    passes.turns.has_heard(passes.turns.asked());  // the program left it some time
    passes.ms += 1;
  }
}

TEST_CASE("link turns: a twentieth of the time and no more, however short the turns are") {
  for (const double length : {0.05, 0.4, 2.0}) {
    Passes passes(kHeavyStep);
    double taken = 0;
    const double until = 5'000;
    while (passes.ms < until) {
      passes.turns.ask();
      passes.waits_for_turn();
      taken += length;
      passes.take_turn(length);
    }
    CHECK(taken <= passes.ms / policy::kLinkParts + policy::kLinkTurnMs);
    CHECK(taken >=
          passes.ms / (2 * policy::kLinkParts) * std::min(1.0, length * policy::kLinkParts));
  }
}

TEST_CASE("link turns: after a long pause the clock may have wrapped") {
  Passes passes(kHeavyStep);
  passes.turns.ask();
  passes.take_turn(policy::kLinkTurnMs);
  LinkTurns::Now later = passes.now();
  later.time += kernel::milliseconds(171'800);
  CHECK(passes.turns.has_budget(later));
}

TEST_CASE("link turns: two passes and an answer fit into the time for an answer") {
  constexpr std::uint32_t kSlowest = 12'500;  // instructions a millisecond
  for (std::uint32_t cost = 0; cost <= kHeavyStep; cost += 500) {
    const std::uint32_t patience_us = policy::link_patience_us(cost);
    if (patience_us != 0)
      CHECK(patience_us / 1000.0 + 2.0 * cost / kSlowest + 1 <= policy::kAnswerMs + 0.001);
  }
}
