// When it is the link's turn. That the step thread then waits for it: tests/e2e/test_crowded.py.
#include "runtime-m4/layers/link_share.hpp"

#include <catch2/catch.hpp>

#include "runtime-m4/policy/link_share.hpp"
#include "runtime-m4/policy/rules.hpp"

using namespace robosync;
using layers::LinkShare;

namespace {

constexpr std::uint32_t kCounts = 250'000;  // of the clock, between two checks

constexpr unsigned kChecks = policy::kLinkPeriodMs / policy::kSafetyPeriodMs;

// Looks at a thread with each check.
struct Checks {
  LinkShare share;
  LinkShare::Look look;

  // It could run at this check, and has run so much since the last one.
  bool ready(std::uint32_t ran) {
    look.run_time += ran;
    return next();
  }
  // It has waited, and nobody looked while it did.
  void waits() {
    ++look.activations;
    look.clock += kCounts;
  }
  bool next() {
    look.clock += kCounts;
    return share.is_due(look);
  }
  // So often, each time when it has run so much: how often it was its turn.
  unsigned turns(unsigned checks, std::uint32_t ran) {
    unsigned turns = 0;
    for (unsigned check = 0; check < checks; ++check)
      turns += ready(ran) ? 1U : 0U;
    return turns;
  }
};

}  // namespace

TEST_CASE("link share: it is its turn when it could run for a period, and has not") {
  Checks checks;
  CHECK(checks.turns(kChecks, 0) == 0);
  CHECK(checks.ready(0));
}

TEST_CASE("link share: one turn in a period, however long it is without") {
  Checks checks;
  checks.ready(0);
  CHECK(checks.turns(100 * kChecks, 0) == 100);
}

TEST_CASE("link share: who waited in between, or came to an end, has what it needs") {
  Checks checks;
  for (unsigned round = 0; round < 100; ++round) {
    CHECK(checks.turns(kChecks, 0) == 0);
    checks.waits();
  }
}

TEST_CASE("link share: a part of the time is enough, less is not") {
  constexpr std::uint32_t kPart = kCounts / policy::kLinkParts;
  Checks enough;
  CHECK(enough.turns(100, kPart) == 0);
  Checks less;
  less.ready(0);
  CHECK(less.turns(kChecks, kPart - 1) == 1);
  Checks once;
  CHECK(once.turns(kChecks, 0) == 0);
  CHECK(once.turns(1, kPart) == 0);
  CHECK(once.turns(kChecks - 1, 0) == 0);
  CHECK(once.ready(0));
}

TEST_CASE("link share: counts may wrap") {
  Checks checks;
  checks.look.clock = checks.look.run_time = UINT32_MAX - 100;
  CHECK(checks.turns(100, 200'000) == 0);
  checks.look.clock = checks.look.run_time = UINT32_MAX - 100;
  checks.ready(0);
  CHECK(checks.turns(kChecks, 100) == 1);
}

TEST_CASE("link share: where time stands still nobody is without") {
  LinkShare share;
  const LinkShare::Look look;
  for (unsigned check = 0; check < 100; ++check)
    CHECK_FALSE(share.is_due(look));
}
