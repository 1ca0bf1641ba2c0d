// May assume POSIX. Promises nothing is coloured or animated where a program reads it.
#include "rsc/console.hpp"

#include <cstdlib>
#include <map>
#include <stdexcept>

#include <unistd.h>

#include "rsc/quantity.hpp"

namespace robosync::tool {

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

bool color_on_stderr() {
  const char* const off = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (off == nullptr || *off == '\0');
}

void add_format_option(CLI::App& app, Format& format) {
  static const std::map<std::string, Format> names{{"human", Format::human},
                                                   {"json", Format::json}};
  app.add_option("--format", format, "human or json")
      ->transform(CLI::Transformer(names))
      ->option_text("human|json");
}

void add_port_option(CLI::App& app, std::string& port) {
  app.add_option("--port", port, "serial device, pty, unix:PATH or tcp:HOST:PORT (see `rsc ports`)")
      ->required()
      ->option_text("PORT");
}

void add_config_option(CLI::App& app, std::string& config) {
  app.add_option("--config", config, "configuration; else STEM.json, else robot.json beside it")
      ->option_text("FILE");
}

void add_compile_options(CLI::App& app, CompileOptions& options) {
  add_config_option(app, options.config);
  app.add_option_function<int>(
         "-O", [&options](int level) { options.optimize = level > 0; },
         "1: optimise (default), 0: translate as it is written")
      ->check(CLI::Range(0, 1))
      ->option_text("0|1");
}

void add_duration_option(CLI::App& app, const std::string& name,
                         std::optional<std::chrono::milliseconds>& duration,
                         const std::string& description) {
  const auto parse = [&duration](const std::string& text) {
    try {
      duration = parse_duration(text);
    } catch (const std::invalid_argument& error) {
      throw CLI::ValidationError(error.what());
    }
  };
  app.add_option_function<std::string>(name, parse, description)->option_text("TIME");
}

}  // namespace robosync::tool
