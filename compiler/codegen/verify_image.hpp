// The robot's own verifier looks at an image before anybody can send it; what it refuses is said in
// the words of the program.
#pragma once

#include "compiler/codegen/emit.hpp"

namespace robosync::compiler {

// Reports what the robot would refuse: E0407, where the program is too large for it; E0499, which
// is a mistake of the compiler. True if nothing.
[[nodiscard]] bool verify_image(const Emitted& emitted, Diagnostics& diagnostics);

}  // namespace robosync::compiler
