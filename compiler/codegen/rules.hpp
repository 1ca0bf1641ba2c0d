// The sections of behaviours, rules, responses, modifiers, inputs, timers and code.
#pragma once

#include "compiler/codegen/code.hpp"
#include "compiler/codegen/tables.hpp"
#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

struct RuleSections {
  std::vector<vm::Behavior> behaviors;
  std::vector<vm::Modifiers> modifiers;
  std::vector<vm::Rule> rules;
  std::vector<Span> places;  // the source position of each rule
  std::vector<vm::Response> responses;
  std::vector<std::uint8_t> inputs;
  Timers timers;
  CodePool pool;
};

// Reports E0407 for what does not fit; then the sections must not be used. Adds names and texts to `strings`. `written`: the
// program before it was optimised. The inputs that a behaviour reads there still trigger its evaluation, so that it is evaluated
// in the same steps.
[[nodiscard]] RuleSections make_rules(const ir::Program& program, const ir::Program& written,
                                      const Tables& tables, Strings& strings,
                                      Diagnostics& diagnostics);

}  // namespace robosync::compiler
