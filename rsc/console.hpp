// Whom the tool talks to: a person at a terminal, or a program.
#pragma once

namespace robosync::tool {

enum class Color { automatic, always, never };
// For all that is said from now on.
void choose_color(Color color);
// Colour on stderr: as chosen; automatic is only on a terminal, and never with NO_COLOR.
[[nodiscard]] bool color_on_stderr();
[[nodiscard]] bool stderr_is_terminal();

enum class Format { human, json };

}  // namespace robosync::tool
