// The C file of a module, compiled: for this computer, and for a Cortex-M4 in QEMU, where the instructions that it executes are counted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "rsc/modules/trial.hpp"

namespace robosync::tool {

// A folder that goes away with the object. Throws Failure (outside) when there can be none.
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

// NAME.so of NAME.c, in `folder`, where arithmetic that C leaves undefined stops it. Throws Failure (program) when the compiler
// refuses it; it has said why.
[[nodiscard]] std::string compile_for_here(const std::string& source, const WorkFolder& folder);

// Whether a cross compiler and QEMU are here.
[[nodiscard]] bool can_count();

// Does what a Cortex-M4 does for the C file need numbers with a fraction? Needs arm-none-eabi-gcc.
[[nodiscard]] bool uses_floating_point(const std::string& source, const WorkFolder& folder);

// The most instructions that one process() of the module in `source` executed, of all that these tries ask of it. Throws Failure
// (program) when it cannot be compiled for the Cortex-M4, or does not come to an end there.
[[nodiscard]] std::uint32_t count_instructions(const std::string& source, const Try& one,
                                               const robosync_module& module,
                                               const WorkFolder& folder);

}  // namespace robosync::tool
