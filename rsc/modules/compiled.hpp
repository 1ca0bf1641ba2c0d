// Compiles the C file of a module for this computer, and for a Cortex-M4 in QEMU, which counts its instructions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "rsc/modules/trial.hpp"

namespace robosync::tool {

// A temporary folder that is removed with the object. Throws Failure (outside) if it cannot be made.
class WorkFolder {
public:
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

// Compiles NAME.c to NAME.so in `folder`; arithmetic that C leaves undefined traps. Throws Failure (program) if the compiler
// rejects it; it has printed the reason.
[[nodiscard]] std::string compile_for_here(const std::string& source, const WorkFolder& folder);

// Whether a cross compiler and QEMU are installed.
[[nodiscard]] bool can_count();

// Does the C file use floating point on a Cortex-M4? Needs arm-none-eabi-gcc.
[[nodiscard]] bool uses_floating_point(const std::string& source, const WorkFolder& folder);

// The most instructions that one process() call of the module in `source` executes on the samples of `one`. Throws Failure
// (program) if it does not compile for the Cortex-M4, or does not end there.
[[nodiscard]] std::uint32_t count_instructions(const std::string& source, const Try& one,
                                               const robosync_module& module,
                                               const WorkFolder& folder);

}  // namespace robosync::tool
