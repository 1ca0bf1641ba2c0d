// Files embedded in the tool for making and testing modules, so that it needs no other files.
#pragma once

#include <span>
#include <string_view>

#include "rsc/templates.hpp"

namespace robosync::tool {

// A template module, and a robot that uses it. "heartbeat" stands for the module's name.
[[nodiscard]] std::span<const TemplateFile> new_module_files();
// robosync_module.h.
[[nodiscard]] std::string_view module_header();
// count_on_m4.c.in.
[[nodiscard]] std::string_view counting_program();

}  // namespace robosync::tool
