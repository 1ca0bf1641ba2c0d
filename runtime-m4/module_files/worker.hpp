// The process of one module: the code that runs in it.
#pragma once

#include <string>

#include "runtime-m4/module_files/desk.hpp"

namespace robosync::module_files {

// Loads `path`, whose module is `name`. Then answers each byte on `line` with a byte, once the result is in `reply`, until
// the line is closed. `request` is read-only. For a process that has nothing else to do and no other file open.
[[noreturn]] void work(const std::string& path, const std::string& name, int line,
                       const Request& request, Reply& reply);

}  // namespace robosync::module_files
