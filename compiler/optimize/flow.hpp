// Follows a response from start to end. Fills in the facts of its expressions, and which of its writes can be made in place.
//
// Between two pauses, a variable has the value that this response set. A pause forgets it, because the frame is latched again. A
// loop begins with the values that its body can produce: if every round adds an amount to a variable, the rounds are counted; any
// other variable may have any value that it can ever have.
#pragma once

#include <optional>

#include "compiler/optimize/expression_facts.hpp"

namespace robosync::compiler {

// The values that a response can write to each variable; nullopt: it never writes it.
struct WriteFacts {
  std::vector<std::optional<Fact>> results;      // the value of the cell afterwards
  std::vector<std::optional<Fact>> differences;  // of RAISE and LOWER: the amount that is added
};

class Flow {
public:
  // `anytime`: facts that hold whenever a variable is read.
  Flow(const ir::Program& program, const Robot& robot, const VariableFacts& anytime)
      : program_(program), robot_(robot), anytime_(anytime) {}

  // `entry`: facts that hold when the response starts.
  WriteFacts follow(ir::Block& response, const VariableFacts& entry, bool in_place);

private:
  enum class Owned : std::uint8_t { no, shifted, assigned };  // how it was written in this run
  struct State {
    VariableFacts variables;
    std::vector<Owned> owned;
    // `held`: what the verifier considers owned, which may be more. `barred`: what was held when a loop that pauses began; such
    // variables are not computed in place before the first pause.
    std::vector<bool> held, barred;
  };
  // How one round of a loop changes a variable. `regular`: it only adds to it.
  struct Growth {
    bool written = false;
    bool regular = true;
    Fact step = fact_of(0);
  };
  using Growths = std::vector<Growth>;

  void block(ir::Block& statements, State& state);
  template <typename Node>
  void visit(Node& node, State& state);  // all other statements
  void visit(ir::Local& local, State& state);
  void visit(ir::Set& set, State& state);
  void visit(ir::WaitUntil& wait, State& state);
  void visit(ir::Follow& follow, State& state);
  void visit(ir::If& choice, State& state);
  void visit(ir::Repeat& repeat, State& state);
  void visit(ir::Pick& pick, State& state);

  // `may_run`: if false, facts are filled in, but writes in the block do not count.
  void branch(ir::Block& statements, State& state, bool may_run);
  void pause(State& state) const;
  // The path of `state` comes later in the code than `before`.
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
  Growths* growths_ = nullptr;  // set while a loop's body is only measured
  unsigned inner_loops_ = 0;    // in that body
  unsigned dead_ = 0;           // enclosing blocks that never run
};

}  // namespace robosync::compiler
