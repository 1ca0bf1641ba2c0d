// May assume POSIX. Promises that output read by a program is not coloured or
// animated.
#include "rsc/console.hpp"

#include <cstdlib>

#include <unistd.h>

namespace robosync::tool {

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

namespace {
Color chosen = Color::automatic;
}

void choose_color(Color color) {
  chosen = color;
}

bool color_on_stderr() {
  if (chosen != Color::automatic) return chosen == Color::always;
  const char* const off = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (off == nullptr || *off == '\0');
}

}  // namespace robosync::tool
