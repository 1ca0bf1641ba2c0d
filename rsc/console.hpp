// Whom the tool talks to: a person at a terminal, or a program.
#pragma once

namespace robosync::tool {

// Colour on stderr: only on a terminal, and never with NO_COLOR.
[[nodiscard]] bool color_on_stderr();
[[nodiscard]] bool stderr_is_terminal();

enum class Format { human, json };

}  // namespace robosync::tool
