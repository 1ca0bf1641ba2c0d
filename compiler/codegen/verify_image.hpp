// Runs the robot's own verifier on an image before it can be sent, and explains a refusal in terms of the program.
#pragma once

#include "compiler/codegen/emit.hpp"

namespace robosync::compiler {

// Reports why the robot would refuse the image: E0407 if the program is too large for it; E0499 for a bug in the compiler. True
// if the image is accepted.
[[nodiscard]] bool verify_image(const Emitted& emitted, Diagnostics& diagnostics);

}  // namespace robosync::compiler
