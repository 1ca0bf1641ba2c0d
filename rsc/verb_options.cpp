#include "rsc/verb_options.hpp"

#include <cstddef>

#include "rsc/quantity.hpp"

namespace robosync::tool {

void add_format_option(Options& options, Format& format) {
  options.choice(
      "--format", {"human", "json"},
      [&format](std::size_t index) { format = static_cast<Format>(index); }, "human or json");
}

void add_port_option(Options& options, std::string& port) {
  options.option("--port", "PORT", port,
                 "serial device, pty, unix:PATH or tcp:HOST:PORT (see `rsc ports`)",
                 Options::Need::required);
}

void add_config_option(Options& options, std::string& config) {
  options.option("--config", "FILE", config,
                 "configuration; else STEM.json, else robot.json beside it");
}

void add_compile_options(Options& options, CompileOptions& how) {
  add_config_option(options, how.config);
  options.choice(
      "-O", {"0", "1"}, [&how](std::size_t level) { how.optimize = level > 0; },
      "1: optimise (default), 0: translate as it is written");
}

void add_duration_option(Options& options, const std::string& name,
                         std::optional<std::chrono::milliseconds>& duration,
                         const std::string& description) {
  options.option(
      name, "TIME", [&duration](const std::string& text) { duration = parse_duration(text); },
      description);
}

}  // namespace robosync::tool
