// The robot of docs/language.md, read naively: a step in every millisecond, all rules in each step.
//
// It walks the analysed program (compiler/ir/program.hpp), not the syntax tree: the tree would
// mean to resolve names, units, USE, DEFINE and robot.json a second time. So what sema makes of a
// text (a LIMIT that becomes a SAFETY rule, a MARGIN that becomes a second comparison, the borders
// of bands, the part that is left of a fading FEELING) is believed here; tests/compiler/ is about
// that. Nothing of codegen, vm/ (but its names of kinds) or runtime-m4/ is used.
//
// What the language leaves open within one millisecond is as docs/kernel.md ranks threads: readings and
// SAFETY, then actuators of the most important behaviour that is there, the step, then all other
// actuators.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "tests/oracles/rsl/actuators.hpp"
#include "tests/oracles/rsl/response.hpp"

namespace robosync::oracle {

struct Reading {
  Millis at = 0;
  compiler::ChannelRef channel;
  std::int64_t value = 0;
};

class Interpreter {
public:
  Interpreter(const compiler::ir::Program& program, const compiler::Robot& robot,
              std::uint32_t seed, Trace& trace);

  // Readings in the order of their times. Everything up to `end`, that included.
  void run(const std::vector<Reading>& readings, Millis end);

private:
  struct Running {
    Response response;
    bool side = true;
    std::set<std::size_t> actuators;
    bool won_now = false;
    bool rests = false;  // a WHILE between two rounds: it has its actuators and does nothing
  };
  struct Waiting {
    bool side = true;
    Millis until = 0;
  };
  struct Rule {
    const compiler::ir::Rule* rule = nullptr;
    const compiler::ir::Behavior* behavior = nullptr;
    std::size_t rank = 0;  // of the behaviour, 0 the most important
    std::set<std::size_t> then_actuators, else_actuators;
    Truth last;  // known truth
    std::optional<Running> running;
    std::optional<Waiting> waiting;
    std::map<bool, Millis> started;  // last, by side
    std::optional<bool> ran_side;    // of the two, the last that ran
    // Its response began, or went on and waits again; or it was interrupted. Long ago if it has waited to its end.
    Millis ran = -kLeastPause;
    std::optional<Millis> due;  // the end of the period
  };
  struct Claim {
    std::size_t rule = 0;
    bool side = true;
    bool trigger = true;  // or tried again
  };
  struct Guard {
    const compiler::ir::Rule* rule = nullptr;
    std::set<compiler::ChannelRef> channels;  // that it reads
    bool tripped = false;
    Millis looked_at = 0;  // when it looked last whether they still report
  };

  void advance_actuators();
  void end_responses();
  [[nodiscard]] bool somebody_could_start() const;
  [[nodiscard]] bool somebody_could_go_on();
  void feed(const std::vector<Reading>& readings, std::size_t& next);
  void step();
  std::size_t take_turn(std::size_t first);
  void remember();
  void interrupt_halted();
  void look_at(std::size_t rule, std::vector<Claim>& claims);
  void trigger(std::size_t rule, bool side, std::vector<Claim>& claims);
  void look_at_when(std::size_t rule, std::vector<Claim>& claims);
  void look_at_while(std::size_t rule, std::vector<Claim>& claims);
  void look_at_every(std::size_t rule, std::vector<Claim>& claims);
  [[nodiscard]] bool cools(const Rule& rule, bool side) const;
  // The side that a rule would run, though it did not trigger now: a WHILE, one with an ELSE whose
  // side has not run yet, or one that is WAITING.
  [[nodiscard]] std::optional<bool> wish(std::size_t rule) const;
  void serve(const Claim& claim);
  // Who is in the way of a claim; empty if it wins. Fills those who lose.
  std::string in_the_way(const Claim& claim, std::vector<std::size_t>& losers) const;
  void interrupt(std::size_t rule, const std::string& by);
  void run_responses();
  void say(const Said& said);
  void carry_out(const Output& output);
  // Looks at all SAFETY rules, or at those that read one of `channels` and at what is due.
  void guard(bool all, const std::set<compiler::ChannelRef>& channels = {});
  void look_at(Guard& guard);

  void trip(Guard& guard, const Snapshot& readings);
  Surroundings around(std::size_t rule);
  [[nodiscard]] const std::set<std::size_t>& actuators(std::size_t rule, bool side) const;
  [[nodiscard]] std::set<std::size_t> halted() const;
  [[nodiscard]] static std::string name_of(const Rule& rule);

  const compiler::ir::Program& program_;
  Trace& trace_;
  std::vector<Chance> chances_;  // by rank
  Chance no_chance_;             // of SAFETY rules, which draw nothing
  Evaluator evaluator_;
  Inputs inputs_;
  Actuators actuators_;
  std::vector<Rule> rules_;
  std::vector<Guard> guards_;
  std::size_t actuator_count_;
  Moment now_;
  Moment guard_now_;
};

}  // namespace robosync::oracle
