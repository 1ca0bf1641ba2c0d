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
  std::uint32_t seed = 0;    // in the place of the robot's; 0: none
};

struct Emitted {
  std::vector<std::byte> image;  // empty when the program is too large for the format
  CodePool code;                 // knows what each word of the image's code comes from
  std::vector<Span> rules;       // where each rule of the image is written
};

// Same input, same bytes. What does not fit is reported (E0407); whether a board would take the image, verify_image() says.
//
// `written`: the program as sema made it, which may be `program` itself. What it uses and reads
// stays in the image, whatever the optimiser has left out: devices keep their numbers, and a
// behaviour is evaluated in the same steps.
[[nodiscard]] Emitted emit(const ir::Program& program, const ir::Program& written,
                           const Robot& robot, EmitOptions options, Diagnostics& diagnostics);

}  // namespace robosync::compiler
