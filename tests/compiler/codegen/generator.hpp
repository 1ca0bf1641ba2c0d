// Random programs of every kind of rule and statement, such as sema lets through: every loop
// without a constant count waits in each round.
#pragma once

#include <random>

#include "tests/compiler/build.hpp"

namespace robosync::compiler::testing {

struct Taste {
  bool chance = true;      // RANDOM and PICK ONE
  bool surprise = true;    // RANDOM in conditions: how often those are looked at is left open
  bool time_words = true;  // in conditions and in responses
  unsigned depth = 4;      // of blocks in blocks
};

class Generator {
public:
  Generator(std::uint32_t seed, Taste taste) : random_(seed), taste_(taste) {}

  ir::Program program();
  ir::Block response();
  // Those that the statements use.
  static std::vector<ir::Variable> variables();

private:
  unsigned below(unsigned end) {
    return std::uniform_int_distribution<unsigned>(0, end - 1)(random_);
  }
  bool often(unsigned percent) { return below(100) < percent; }
  E number_expression(unsigned depth);
  E condition(unsigned depth);
  E timed(unsigned depth);
  ir::Rule rule();
  ir::Rule safety_rule();
  ir::Block block(unsigned depth);
  ir::Statement statement(unsigned depth);
  ir::Statement simple();
  ir::Statement compound(unsigned depth);
  ir::Repeat repeat(unsigned depth);
  ir::Statement numbered(std::uint16_t number, ir::Statement statement);
  std::vector<ir::Argument> arguments();

  std::mt19937 random_;
  Taste taste_;
  bool in_condition_ = false;
  std::vector<std::size_t> locals_;  // in scope
  std::size_t next_local_ = 0;
  std::uint16_t next_line_ = 1;
};

}  // namespace robosync::compiler::testing
