// See loaded_library.hpp.
#include "rsc/loaded_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "rsc/failure.hpp"

namespace robosync::tool {

LoadedLibrary::LoadedLibrary(const char* file, const char* package, const char* user)
    : file_(file), handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr)
    throw Failure(
        Exit::outside,
        fmt::format("{} needs {}, which is not installed: on Debian, `sudo apt install {}`", user,
                    file, package));
}

void* LoadedLibrary::find_any(const char* name) const {
  void* const found = dlsym(handle_, name);
  if (found == nullptr) throw Failure(Exit::outside, fmt::format("this {} has no {}", file_, name));
  return found;
}

}  // namespace robosync::tool
