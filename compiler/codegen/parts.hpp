// The inputs for the code of one behaviour, and the work that emitting it leaves to be done.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/codegen/code.hpp"
#include "compiler/codegen/tables.hpp"
#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

using LocalCells = std::map<std::size_t, Cell>;  // by ir::Local::number

// A time word in a response: a watch rule must evaluate it in every step.
struct Watch {
  Expression time_word;
  LocalCells locals;  // that the time word may read
  Cell truth;
  Source source;  // the statement with the time word
};

struct Parts {
  const ir::Program& program;
  const Tables& tables;
  Strings& strings;
  CodePool& pool;
  Timers& timers;
  Diagnostics& diagnostics;
  Frame frame{};                 // of the behaviour
  std::vector<Watch> watches{};  // of the behaviour, in the order of their cells

  // E0407: something does not fit on the robot.
  void too_large(std::string what, Span span) const {
    diagnostics.report(Code::E0407, std::move(what)).label(span);
  }
};

}  // namespace robosync::compiler
