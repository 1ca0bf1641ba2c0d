// A shared library that is loaded when a verb needs it, so that nobody else waits for it, or has to have it.
#pragma once

namespace robosync::tool {

class LoadedLibrary {
public:
  // `file`: of the library, as "libsndfile.so.1"; `package`: of Debian; `user`: what needs it, as "rsc bridge". All three are
  // literals. Throws Failure (outside) when it is not installed.
  LoadedLibrary(const char* file, const char* package, const char* user);

  // Points `function` to the library's function of this name. Throws Failure (outside) when it has none.
  template <typename Function>
  void find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(find_any(name));
  }

private:
  [[nodiscard]] void* find_any(const char* name) const;

  const char* file_;
  void* handle_;
};

}  // namespace robosync::tool
