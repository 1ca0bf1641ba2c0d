// Options that several verbs share.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rsc/console.hpp"
#include "rsc/options.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

void add_format_option(Options& options, Format& format);
void add_port_option(Options& options, std::string& port);
// --port, once, or once for each robot.
void add_ports_option(Options& options, std::vector<std::string>& ports);
// --key FILE, which signs orders to a robot that has an owner; empty if not given.
void add_key_option(Options& options, std::string& key);
void add_config_option(Options& options, std::string& config);
// --seed N for the random numbers; 0 if not given.
void add_seed_option(Options& options, std::uint32_t& seed);
// --color, for stderr.
void add_color_option(Options& options);
// --config, --color, --allow, --warn and --deny, and -O0 or -O1.
void add_compile_options(Options& options, CompileOptions& how);
// -q, --quiet.
void add_quiet_option(Options& options, bool& quiet, const std::string& description);
// Throws Failure (usage) if both options are given, which do not go together.
void refuse_pair(bool given, const char* one, const char* other);
// Throws Failure (usage) if `given`, an option that means nothing without the other one, is not null.
void refuse_alone(const char* given, const char* other);
void add_duration_option(Options& options, const std::string& name,
                         std::optional<std::chrono::milliseconds>& duration,
                         const std::string& description);

}  // namespace robosync::tool
