// What the terminal can do, and options that several verbs share.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "rsc/program.hpp"

namespace robosync::tool {

// Colour on stderr: only on a terminal, and never with NO_COLOR.
[[nodiscard]] bool color_on_stderr();
[[nodiscard]] bool stderr_is_terminal();

enum class Format { human, json };
void add_format_option(CLI::App& app, Format& format);
void add_port_option(CLI::App& app, std::string& port);
void add_config_option(CLI::App& app, std::string& config);
// --config, and -O0 or -O1.
void add_compile_options(CLI::App& app, CompileOptions& options);
void add_duration_option(CLI::App& app, const std::string& name,
                         std::optional<std::chrono::milliseconds>& duration,
                         const std::string& description);

}  // namespace robosync::tool
