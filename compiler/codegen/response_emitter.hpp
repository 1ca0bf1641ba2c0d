// A response to instructions. Each statement leaves the registers free; what has to last (counters
// of loops, what DEFINEs are given) is in locals of its own.
#pragma once

#include "compiler/codegen/parts.hpp"

namespace robosync::compiler {

struct ResponseCode {
  CodeDraft code;
  std::uint32_t actuators = 0;  // every actuator that it can command
};

// What does not fit is reported.
[[nodiscard]] ResponseCode emit_response(Parts& parts, const ir::Block& response);

// Is it known only on the robot what the variable will be?
[[nodiscard]] bool needs_clamping(const ir::Set& set);

}  // namespace robosync::compiler
