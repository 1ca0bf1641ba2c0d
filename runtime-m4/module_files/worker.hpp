// The process of one module: what runs in it.
#pragma once

#include <string>

#include "runtime-m4/module_files/desk.hpp"

namespace robosync::module_files {

// Loads `path`, whose module is `name`, and answers a byte on `line` by one, whenever what was asked for lies in `reply`, until
// the line is closed. `request` cannot be written to. In a process that has nothing else to do and no other file open.
[[noreturn]] void work(const std::string& path, const std::string& name, int line,
                       const Request& request, Reply& reply);

}  // namespace robosync::module_files
