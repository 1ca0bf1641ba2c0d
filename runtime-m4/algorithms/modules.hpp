// The algorithm modules of the firmware, by their number in the image (modules.def).
#pragma once

#include <cstddef>

#include "runtime-m4/algorithms/robosync_module.h"

extern "C" {
#define MODULE(name, doc)                     \
  extern const robosync_module name##_module; \
  const robosync_description* name##_describe(uint32_t abi);
#include "runtime-m4/algorithms/modules.def"
#undef MODULE
}

namespace robosync::algorithms {

// Numbers from here on belong to modules in files. Only a computer has any, and each process numbers its own
// (module_files/registry.cpp; on a board: no_files.cpp).
inline constexpr std::size_t kFirstInFile = 128;
[[nodiscard]] const robosync_description* find_in_file(std::size_t number);

// The module, or null.
[[nodiscard]] const robosync_module* find_module(std::size_t number);

// Its names, or null. The firmware does not call this, and so contains no names.
[[nodiscard]] const robosync_description* find_description(std::size_t number);

}  // namespace robosync::algorithms
