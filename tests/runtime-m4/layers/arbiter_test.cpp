// The arbiter against a model written from docs/language.md: sets and lists in place of
// masks, no shared code.
#include "runtime-m4/layers/arbiter.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using namespace robosync::layers;

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

// What the arbiter is told of the responses that run.
struct Table {
  explicit Table(std::size_t rules) : holdings(rules) {}

  Decision decide(const Claim& claim) const {
    return robosync::layers::decide(claim, holdings, running);
  }
  // What ProcessingLayer does with a decision, and nothing else.
  void apply(const Claim& claim, const Decision& decision) {
    for (const unsigned rule : decision.interrupted)
      running.erase(rule);
    if (!decision.wins) return;
    running.insert(claim.rule);
    const auto actuators = static_cast<ActuatorBits>(claim.actuators);
    holdings[claim.rule] = Holding{.actuators = actuators,
                                   .pending = actuators,
                                   .behavior = claim.behavior,
                                   .side = claim.side,
                                   .won_now = true};
  }
  bool disjoint() const {
    ActuatorMask seen = 0;
    for (const unsigned rule : running) {
      if ((seen & holdings[rule].actuators) != 0) return false;
      seen |= holdings[rule].actuators;
    }
    return true;
  }

  std::vector<Holding> holdings;
  RuleSet running;
};

void begin_step(Model& model, Table& table) {
  model.started_now.clear();
  for (Holding& holding : table.holdings)
    holding.won_now = false;
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
    Table table(kRules);
    const int steps = *rc::gen::inRange(1, 12);
    for (int step = 0; step < steps; ++step) {
      begin_step(model, table);
      for (std::uint8_t r = 0; r < kRules; ++r) {
        if (!*rc::gen::weightedElement<bool>({{1, true}, {2, false}})) continue;
        const auto mask = *rc::gen::inRange<ActuatorMask>(0, 1U << kActuators);
        const Side side = *rc::gen::element(Side::then, Side::otherwise);
        const Claim c = claim(r, behavior_of[r], mask, side);
        const Decision decision = table.decide(c);
        const auto expected = model.serve({r, behavior_of[r], side, as_set(mask)});
        RC_ASSERT(decision.wins == expected.wins);
        std::set<unsigned> interrupted;
        for (const unsigned rule : decision.interrupted)
          interrupted.insert(rule);
        RC_ASSERT(interrupted == expected.interrupted);
        table.apply(c, decision);
        RC_ASSERT(table.disjoint());
      }
      for (unsigned r = 0; r < kRules; ++r) {  // some responses finish
        if (!*rc::gen::arbitrary<bool>()) continue;
        table.running.erase(r);
        std::erase_if(model.running, [&](const Response& response) { return response.rule == r; });
      }
    }
  });
  CHECK(holds);
}

TEST_CASE("a loser learns which behaviour is in its way: the one of the highest priority") {
  Table table(4);
  table.apply(claim(0, 0, 0b001), {.interrupted = {}, .wins = true});
  table.apply(claim(1, 1, 0b010), {.interrupted = {}, .wins = true});
  const Decision decision = table.decide(claim(3, 2, 0b111));
  CHECK_FALSE(decision.wins);
  CHECK(decision.owner == 0);
  CHECK(decision.interrupted.empty());
}

TEST_CASE("a rule that runs already loses to its own behaviour") {
  Table table(3);
  table.apply(claim(2, 1, 0b1), {.interrupted = {}, .wins = true});
  table.holdings[2].won_now = false;
  const Decision decision = table.decide(claim(2, 1, 0b1));
  CHECK_FALSE(decision.wins);
  CHECK(decision.owner == 1);
  CHECK(decision.interrupted.empty());
}

TEST_CASE("responses without actuators never conflict") {
  Table table(2);
  table.apply(claim(0, 0, ~0U), {.interrupted = {}, .wins = true});
  const Decision decision = table.decide(claim(1, 1, 0));
  CHECK(decision.wins);
  CHECK(decision.interrupted.empty());
}
