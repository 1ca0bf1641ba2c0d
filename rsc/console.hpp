// What the terminal can do, and options that several verbs share.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "rsc/options.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

// Colour on stderr: only on a terminal, and never with NO_COLOR.
[[nodiscard]] bool color_on_stderr();
[[nodiscard]] bool stderr_is_terminal();

enum class Format { human, json };
void add_format_option(Options& options, Format& format);
void add_port_option(Options& options, std::string& port);
void add_config_option(Options& options, std::string& config);
// --config, and -O0 or -O1.
void add_compile_options(Options& options, CompileOptions& how);
void add_duration_option(Options& options, const std::string& name,
                         std::optional<std::chrono::milliseconds>& duration,
                         const std::string& description);

}  // namespace robosync::tool
