// Turns a response into instructions. Each statement leaves the registers free. Values that must last (loop counters, arguments
// of DEFINEs) have their own locals.
#pragma once

#include "compiler/codegen/parts.hpp"

namespace robosync::compiler {

struct ResponseCode {
  CodeDraft code;
  std::uint32_t actuators = 0;  // every actuator that it can command
};

// Reports what does not fit.
[[nodiscard]] ResponseCode emit_response(Parts& parts, const ir::Block& response);

// True if the new value of the variable is not known before the program runs.
[[nodiscard]] bool needs_clamping(const ir::Set& set);

}  // namespace robosync::compiler
