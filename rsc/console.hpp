// Whether the tool's output goes to a person at a terminal or to a program.
#pragma once

namespace robosync::tool {

enum class Color { automatic, always, never };
// Applies to everything printed from now on.
void choose_color(Color color);
// Whether stderr is coloured: as chosen; automatic means on a terminal, unless NO_COLOR
// is set.
[[nodiscard]] bool color_on_stderr();
[[nodiscard]] bool stderr_is_terminal();

enum class Format { human, json };

}  // namespace robosync::tool
