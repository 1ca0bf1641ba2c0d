// What the tool has with it to make and to try modules: so it needs nothing beside itself.
#pragma once

#include <span>
#include <string_view>

#include "rsc/templates.hpp"

namespace robosync::tool {

// A module to begin with, and a robot that uses it. Where they say "heartbeat", its name belongs.
[[nodiscard]] std::span<const TemplateFile> new_module_files();
// robosync_module.h.
[[nodiscard]] std::string_view module_header();
// count_on_m4.c.in.
[[nodiscard]] std::string_view counting_program();

}  // namespace robosync::tool
