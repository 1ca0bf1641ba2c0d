// When it is the link's turn. bench/answer.py and tests/e2e/test_crowded.py check that the step thread then waits for it, and
// that it answers in time.
#include "runtime-m4/layers/link_share.hpp"

#include <algorithm>
#include <optional>

#include <catch2/catch.hpp>

#include "runtime-m4/policy/link_share.hpp"

using namespace robosync;
using layers::LinkShare;

namespace {

constexpr std::uint32_t kCountsAMs = 25'000;
constexpr std::uint32_t kLightStep = 1'000;
constexpr std::uint32_t kHeavyStep = 100'000;  // the most that a board accepts

// A step thread that checks, between two passes, whether a link that is ready gets its turn.
struct Passes {
  LinkShare share;
  LinkShare::Look look;
  double ms = 0;

  explicit Passes(std::uint32_t step_cost) { share.start(step_cost); }

  void passes(double more_ms) {
    ms += more_ms;
    look.tick = static_cast<std::uint32_t>(ms);
    look.clock = static_cast<std::uint32_t>(ms * kCountsAMs);
  }
  void ran(double for_ms) { look.run_time += static_cast<std::uint32_t>(for_ms * kCountsAMs); }
  bool is_due() { return share.is_due(look); }
  // Checks each millisecond, of which the link has run for `part`. Returns after how many checks it is the link's turn.
  std::optional<unsigned> waits(double part = 0) {
    for (unsigned waited = 0; waited < 1000; ++waited) {
      if (is_due()) return waited;
      passes(1);
      ran(part);
    }
    return std::nullopt;
  }
  void takes_turn(double length) {
    const LinkShare::Look begin = look;
    passes(length);
    ran(length);
    ++look.activations;
    share.took(begin, look);
  }
};

unsigned patience_ms(std::uint32_t step_cost) {
  return (policy::link_patience_us(step_cost) + 999) / 1000;
}

}  // namespace

TEST_CASE("link share: short steps leave it time to wait, long ones none") {
  CHECK(Passes(kLightStep).waits() == patience_ms(kLightStep));
  CHECK(Passes(kHeavyStep).waits() == 0U);
}

TEST_CASE("link share: who came to an end in between has had time") {
  Passes passes(kLightStep);
  for (int round = 0; round < 100; ++round) {
    CHECK_FALSE(passes.is_due());
    passes.passes(patience_ms(kLightStep) - 1);
    CHECK_FALSE(passes.is_due());
    ++passes.look.activations;
    passes.passes(1);
  }
}

TEST_CASE("link share: who has more than a part of the time has enough, who has less waits") {
  constexpr double kPart = 1.0 / policy::kLinkParts;
  CHECK(Passes(kLightStep).waits(kPart * 1.1) == std::nullopt);
  CHECK(Passes(kLightStep).waits(kPart * 0.9) == patience_ms(kLightStep));
}

TEST_CASE("link share: a new program has the whole budget") {
  Passes passes(kHeavyStep);
  passes.takes_turn(policy::kLinkTurnMs);
  CHECK_FALSE(passes.is_due());
  passes.share.start(kHeavyStep);
  CHECK(passes.is_due());
}

TEST_CASE("link share: a twentieth of the time and no more, however short the turns are") {
  for (const double length : {0.05, 0.4, double{policy::kLinkTurnMs}}) {
    Passes passes(kHeavyStep);
    double taken = 0;
    while (passes.ms < 5'000) {
      REQUIRE(passes.waits());
      taken += length;
      passes.takes_turn(length);
    }
    CHECK(taken <= passes.ms / policy::kLinkParts + policy::kLinkTurnMs);
    CHECK(taken >=
          passes.ms / (2 * policy::kLinkParts) * std::min(1.0, length * policy::kLinkParts));
  }
}

TEST_CASE("link share: counts may wrap") {
  Passes passes(kHeavyStep);
  passes.takes_turn(policy::kLinkTurnMs);
  passes.look.tick += 171'800;  // the clock shows hardly any time, since it has wrapped
  CHECK(passes.is_due());
  Passes light(kLightStep);
  light.look.run_time = UINT32_MAX - 100;
  CHECK_FALSE(light.is_due());
  light.passes(1);
  light.ran(0.5);
  CHECK(light.waits() == patience_ms(kLightStep));
}

TEST_CASE("link share: where time stands still it is nobody's turn") {
  Passes passes(kLightStep);
  for (unsigned check = 0; check < 100; ++check)
    CHECK_FALSE(passes.is_due());
}

TEST_CASE("link share: two passes and an answer fit into the time for an answer") {
  constexpr double kSlowest = 12'500;  // instructions a millisecond
  for (std::uint32_t cost = 0; cost <= kHeavyStep; cost += 500) {
    const std::uint32_t patience_us = policy::link_patience_us(cost);
    if (patience_us != 0)
      CHECK(patience_us / 1000.0 + 2 * cost / kSlowest + 1 <= policy::kAnswerMs + 0.001);
  }
}
