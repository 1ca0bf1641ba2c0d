// The language server on stdin and stdout.
#pragma once

#include <cstddef>

namespace robosync::tool::lsp {

// Serves until the editor ends it or the line is closed. Returns the exit code: 0 after `shutdown`,
// or if nothing was started, else 1.
[[nodiscard]] int serve(int in, int out);

}  // namespace robosync::tool::lsp
