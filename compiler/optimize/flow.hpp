// Follows a response from its start to its end, and fills in what is proved of each of its
// expressions, and which of its writes can be made in place.
//
// Between two pauses a variable is what this response has set; a pause forgets that, for the frame
// is latched again. A loop begins with what its body can make of the variables: of one that every
// round raises by some amount, the rounds are counted; of all others anything is assumed that they
// can ever be.
#pragma once

#include <optional>

#include "compiler/optimize/expression_facts.hpp"

namespace robosync::compiler {

// What a response can make of each variable; nothing: it never writes it.
struct WriteFacts {
  std::vector<std::optional<Fact>> results;      // what its cell holds then
  std::vector<std::optional<Fact>> differences;  // of RAISE and LOWER: what is added
};

class Flow {
public:
  // `anytime`: what the variables can be whenever they are read.
  Flow(const ir::Program& program, const Robot& robot, const VariableFacts& anytime)
      : program_(program), robot_(robot), anytime_(anytime) {}

  // `entry`: what the variables can be when it starts.
  WriteFacts follow(ir::Block& response, const VariableFacts& entry, bool in_place);

private:
  enum class Owned : std::uint8_t { no, shifted, assigned };  // what was written in this run
  struct State {
    VariableFacts variables;
    std::vector<Owned> owned;
    // What the verifier takes for owned, which may be more; and what it had for owned when a loop
    // that pauses began: that is not computed in place before the first pause.
    std::vector<bool> held, barred;
  };
  // What one round of a loop does to a variable, if it only adds to it.
  struct Growth {
    bool written = false;
    bool regular = true;
    Fact step = fact_of(0);
  };
  using Growths = std::vector<Growth>;

  void block(ir::Block& statements, State& state);
  template <typename Node>
  void visit(Node& node, State& state);  // all others
  void visit(ir::Local& local, State& state);
  void visit(ir::Set& set, State& state);
  void visit(ir::WaitUntil& wait, State& state);
  void visit(ir::Follow& follow, State& state);
  void visit(ir::If& choice, State& state);
  void visit(ir::Repeat& repeat, State& state);
  void visit(ir::Pick& pick, State& state);

  // `may_run`: otherwise the block is only looked at, and counts for nothing.
  void branch(ir::Block& statements, State& state, bool may_run);
  void pause(State& state) const;
  // The way of `state` stands behind that of `before`.
  static void pass(const ir::Block& before, State& state);
  void forget_written(const ir::Block& body, State& state) const;
  void begin_resting(State& state) const;
  void counted(ir::Repeat& repeat, vm::Value times, State& state);
  void claim(ir::Repeat& repeat, State& head);
  State grown(const ir::Repeat& repeat, const State& before, const Growths& growths,
              vm::Value times) const;
  Growths measure(ir::Repeat& repeat, State head);
  void note_growth(const ir::Set& set);
  void note_sums(const ir::Block& response);
  void record(const ir::Set& set, const Fact& result);
  static State merged(const State& one, const State& other);
  Fact look(Expression& expression, const State& state) const {
    return annotate(expression, {robot_, state.variables, anytime_, locals_});
  }

  const ir::Program& program_;
  const Robot& robot_;
  const VariableFacts& anytime_;
  LocalFacts locals_;
  WriteFacts writes_;
  bool in_place_ = false;
  std::vector<bool> sums_;      // variables that a response raises or lowers more than once
  Growths* growths_ = nullptr;  // while a loop's body is only measured
  unsigned inner_loops_ = 0;    // in that body
  unsigned dead_ = 0;           // blocks around, that never run
};

}  // namespace robosync::compiler
