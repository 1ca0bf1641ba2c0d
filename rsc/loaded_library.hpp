// A shared library that is loaded only when a verb needs it, so that other verbs do not wait for it or require it.
#pragma once

namespace robosync::tool {

class LoadedLibrary {
public:
  // `file`: the library, such as "libsndfile.so.1"; `package`: its Debian package; `user`: what needs it, such as "rsc
  // bridge". All three are literals. Throws Failure (outside) if it is not installed.
  LoadedLibrary(const char* file, const char* package, const char* user);

  // Sets `function` to the library's function of this name. Throws Failure (outside) if there is none.
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
