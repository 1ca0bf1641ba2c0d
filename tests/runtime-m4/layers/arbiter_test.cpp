// The arbiter compared with a model written from docs/language.md: sets and lists instead of
// masks, no shared code.
#include "runtime-m4/layers/arbiter.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "runtime-m4/sim/arena.hpp"

using namespace robosync::layers;
using robosync::policy::Count;

namespace {

constexpr unsigned kRules = 8;
constexpr unsigned kActuators = 5;

struct Response {
  unsigned rule;
  unsigned behavior;  // lower is more important
  Side side;
  std::set<unsigned> actuators;
};

std::set<unsigned> as_set(ActuatorMask mask) {
  std::set<unsigned> set;
  for (unsigned a = 0; a < 32; ++a)
    if ((mask >> a & 1) != 0) set.insert(a);
  return set;
}

// The robot as the language describes it: an actuator has one owner at a time.
class Model {
public:
  std::vector<Response> running;
  std::set<unsigned> started_now;

  struct Outcome {
    std::set<unsigned> interrupted;
    bool wins;
  };

  Outcome serve(const Response& claim) {
    Outcome outcome{{}, false};
    if (const Response* own = of_rule(claim.rule); own != nullptr) {
      if (own->side == claim.side) return outcome;  // ignored while running
      end(claim.rule, outcome);                     // the other side was chosen
    }
    std::set<unsigned> losers;
    for (const unsigned actuator : claim.actuators) {
      const Response* owner = owner_of(actuator);
      if (owner == nullptr) continue;
      const bool lower = owner->behavior > claim.behavior;
      const bool own_earlier =
          owner->behavior == claim.behavior && started_now.count(owner->rule) == 0;
      if (!lower && !own_earlier) return outcome;  // not the whole set: no start
      losers.insert(owner->rule);
    }
    for (const unsigned rule : losers)
      end(rule, outcome);
    running.push_back(claim);
    started_now.insert(claim.rule);
    outcome.wins = true;
    return outcome;
  }

private:
  const Response* of_rule(unsigned rule) const {
    for (const Response& response : running)
      if (response.rule == rule) return &response;
    return nullptr;
  }
  const Response* owner_of(unsigned actuator) const {
    for (const Response& response : running)
      if (response.actuators.count(actuator) != 0) return &response;
    return nullptr;
  }
  void end(unsigned rule, Outcome& outcome) {
    std::erase_if(running, [&](const Response& response) { return response.rule == rule; });
    outcome.interrupted.insert(rule);
  }
};

// Applies a decision as ProcessingLayer does, and nothing else.
struct Table {
  Table() {
    robosync::policy::Needs needs;
    needs.counts[Count::rules] = kRules;
    needs.counts[Count::set_words] = robosync::policy::set_words(kRules);
    memory.lay_out(needs);
    arbiter.start(behavior_of, memory);
  }

  robosync::sim::Arena arena;
  robosync::layers::Memory memory{arena.bytes(), arena.board()};
  std::array<std::uint8_t, kRules> behavior_of{};
  Arbiter arbiter;

  std::set<unsigned> ended_by(const Claim& claim, const Decision& decision) const {
    std::set<unsigned> ended;
    arbiter.running().each([&](unsigned rule) {
      if (arbiter.ends(claim, decision, rule)) ended.insert(rule);
    });
    return ended;
  }
  void apply(const Claim& claim, const Decision& decision) {
    for (const unsigned rule : ended_by(claim, decision))
      arbiter.end(rule);
    behavior_of[claim.rule] = claim.behavior;
    if (decision.wins()) arbiter.give(claim);
  }
  void serve(const Claim& claim) { apply(claim, arbiter.decide(claim)); }

  // Each actuator has one owner, and the owned actuators are those that a response holds.
  bool is_sound() const {
    ActuatorMask seen = 0;
    bool sound = true;
    arbiter.running().each([&](unsigned rule) {
      sound = sound && (seen & arbiter.holding(rule).actuators) == 0;
      seen |= arbiter.holding(rule).actuators;
    });
    return sound && seen == arbiter.owned();
  }
};

void begin_step(Model& model, Table& table) {
  model.started_now.clear();
  table.arbiter.end_step();
}

Claim claim(std::uint8_t rule, std::uint8_t behavior, ActuatorMask actuators,
            Side side = Side::then) {
  return {.rule = rule, .behavior = behavior, .side = side, .actuators = actuators};
}

}  // namespace

TEST_CASE("the arbiter decides as the language says, over many steps") {
  const bool holds = rc::check("same outcomes as the model", [] {
    // Rules belong to behaviours in order, as in an image.
    std::vector<std::uint8_t> behavior_of(kRules);
    std::uint8_t behavior = 0;
    for (unsigned r = 0; r < kRules; ++r) {
      if (r > 0 && *rc::gen::arbitrary<bool>()) ++behavior;
      behavior_of[r] = behavior;
    }
    Model model;
    Table table;
    const int steps = *rc::gen::inRange(1, 12);
    for (int step = 0; step < steps; ++step) {
      begin_step(model, table);
      for (std::uint8_t r = 0; r < kRules; ++r) {
        if (!*rc::gen::weightedElement<bool>({{1, true}, {2, false}})) continue;
        const auto mask = *rc::gen::inRange<ActuatorMask>(0, 1U << kActuators);
        const Side side = *rc::gen::element(Side::then, Side::otherwise);
        const Claim c = claim(r, behavior_of[r], mask, side);
        const Decision decision = table.arbiter.decide(c);
        const auto expected = model.serve({r, behavior_of[r], side, as_set(mask)});
        RC_ASSERT(decision.wins() == expected.wins);
        RC_ASSERT(decision.wins() || !table.arbiter.surely_wins(r, side, mask));
        RC_ASSERT(table.ended_by(c, decision) == expected.interrupted);
        table.apply(c, decision);
        RC_ASSERT(table.is_sound());
      }
      for (unsigned r = 0; r < kRules; ++r) {  // some responses finish
        if (!*rc::gen::arbitrary<bool>()) continue;
        if (table.arbiter.runs(r)) table.arbiter.end(r);
        std::erase_if(model.running, [&](const Response& response) { return response.rule == r; });
      }
    }
  });
  CHECK(holds);
}

TEST_CASE("a loser learns which behaviour is in its way: the one of the highest priority") {
  Table table;
  table.serve(claim(0, 0, 0b001));
  table.serve(claim(1, 1, 0b010));
  const Claim late = claim(3, 2, 0b111);
  const Decision decision = table.arbiter.decide(late);
  CHECK_FALSE(decision.wins());
  CHECK(decision.owner == 0);
  CHECK(table.ended_by(late, decision).empty());
}

TEST_CASE("a rule that runs already loses to its own behaviour, and runs on") {
  Table table;
  table.serve(claim(2, 1, 0b1));
  table.arbiter.end_step();
  const Claim again = claim(2, 1, 0b1);
  const Decision decision = table.arbiter.decide(again);
  CHECK(decision.outcome == Outcome::ignored);
  CHECK(decision.owner == 1);
  CHECK(table.ended_by(again, decision).empty());
  CHECK_FALSE(table.arbiter.surely_wins(2, Side::then, 0b1));
  CHECK(table.arbiter.surely_wins(2, Side::otherwise, 0b1));
}

TEST_CASE("what was won in this step is not lost in it to the same behaviour") {
  Table table;
  table.serve(claim(1, 1, 0b1));
  CHECK_FALSE(table.arbiter.decide(claim(2, 1, 0b1)).wins());
  table.arbiter.end_step();
  CHECK(table.arbiter.decide(claim(2, 1, 0b1)).wins());
}

TEST_CASE("nobody gets what is halted, and the claim loses to who has halted it") {
  Table table;
  table.arbiter.note_halted(0b10);
  const Decision decision = table.arbiter.decide(claim(0, 3, 0b11));
  CHECK_FALSE(decision.wins());
  CHECK(decision.owner == Decision::kHalter);
  CHECK(table.arbiter.decide(claim(0, 3, 0b01)).wins());
}

TEST_CASE("nor does a rule get what is halted from its own other side") {
  Table table;
  table.serve(claim(2, 1, 0b1));
  table.arbiter.end_step();
  table.arbiter.note_halted(0b1);
  const Decision decision = table.arbiter.decide(claim(2, 1, 0b1, Side::otherwise));
  CHECK_FALSE(decision.wins());
  CHECK(decision.owner == Decision::kHalter);
  CHECK_FALSE(table.arbiter.surely_wins(2, Side::otherwise, 0b1));
}

TEST_CASE("responses without actuators never conflict") {
  Table table;
  table.serve(claim(0, 0, ~0U));
  const Claim other = claim(1, 1, 0);
  const Decision decision = table.arbiter.decide(other);
  CHECK(decision.wins());
  CHECK(table.ended_by(other, decision).empty());
}
