// May assume POSIX. Promises nothing is coloured or animated where a program reads it.
#include "rsc/console.hpp"

#include <cstdlib>

#include <unistd.h>

namespace robosync::tool {

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

bool color_on_stderr() {
  const char* const off = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (off == nullptr || *off == '\0');
}

}  // namespace robosync::tool
