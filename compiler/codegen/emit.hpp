// Emits a program as an image (vm/image.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/codegen/code.hpp"
#include "compiler/config/robot.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/ir/program.hpp"

namespace robosync::compiler {

struct EmitOptions {
  bool source_lines = true;  // keep the debug section
  std::uint32_t seed = 0;    // replaces the robot's; 0: the robot's is used
};

struct Emitted {
  std::vector<std::byte> image;  // empty if the program is too large for the format
  CodePool code;                 // maps each word of the image's code to its source
  std::vector<Span> rules;       // the source position of each rule of the image
};

// The same input gives the same bytes. Reports what does not fit the format (E0407); verify_image() tells whether a board would
// accept the image.
//
// `written`: the program as sema made it, which may be `program` itself. What it uses and reads stays in the image even if the
// optimiser removed it: devices keep their numbers, and a behaviour is evaluated in the same steps.
[[nodiscard]] Emitted emit(const ir::Program& program, const ir::Program& written,
                           const Robot& robot, EmitOptions options, Diagnostics& diagnostics);

}  // namespace robosync::compiler
