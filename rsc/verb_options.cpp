#include "rsc/verb_options.hpp"

#include <charconv>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "compiler/config/robot.hpp"
#include "rsc/failure.hpp"
#include "rsc/quantity.hpp"

namespace robosync::tool {

void add_format_option(Options& options, Format& format) {
  options.choice(
      "--format", {"human", "json"},
      [&format](std::size_t index) { format = static_cast<Format>(index); }, "human or json");
}

namespace {
constexpr const char* kWhatAPortIs =
    "serial device, pty, unix:PATH or tcp:HOST:PORT (see `rsc ports`)";
}

void add_port_option(Options& options, std::string& port) {
  options.option("--port", "PORT", port, kWhatAPortIs, Options::Need::required);
}

void add_ports_option(Options& options, std::vector<std::string>& ports) {
  options.options(
      "--port", "PORT", [&ports](const std::string& port) { ports.push_back(port); },
      std::string(kWhatAPortIs) + "; repeat it for several robots", Options::Need::required);
}

void add_key_option(Options& options, std::string& key) {
  options.option("--key", "FILE", key,
                 "key of the robot's owner; else robosync/key in your config folder");
}

void add_config_option(Options& options, std::string& config) {
  options.option("--config", "FILE", config,
                 "configuration; else STEM.json, else robot.json beside it");
}

void add_seed_option(Options& options, std::uint32_t& seed) {
  options.option(
      "--seed", "N",
      [&seed](const std::string& text) {
        const char* const end = text.data() + text.size();
        const auto read = std::from_chars(text.data(), end, seed);
        if (read.ec != std::errc{} || read.ptr != end || seed == 0 || seed > compiler::kMaxSeed)
          throw std::invalid_argument("a seed is a whole number from 1 to " +
                                      std::to_string(compiler::kMaxSeed));
      },
      "seed of RANDOM and PICK ONE; else as robot.json says");
}

void add_color_option(Options& options) {
  options.choice(
      "--color", {"auto", "always", "never"},
      [](std::size_t index) { choose_color(static_cast<Color>(index)); },
      "colour of messages: auto (default) on a terminal, unless NO_COLOR is set");
}

namespace {

void add_lint_option(Options& options, const std::string& name, compiler::LintLevel level,
                     compiler::LintLevels& lints, const std::string& description) {
  const auto take = [level, &lints](const std::string& word) {
    const auto code = compiler::find_lint(word);
    if (code)
      lints.levels[*code] = level;
    else if (level == compiler::LintLevel::deny && word == "warnings")
      lints.deny_warnings = true;
    else
      throw std::invalid_argument("`" + word + "` is not a lint; they begin with W, such as W0203");
  };
  options.options(name, "CODE", take, description);
}

void add_lint_options(Options& options, compiler::LintLevels& lints) {
  using compiler::LintLevel;
  add_lint_option(options, "--allow", LintLevel::allow, lints, "do not report this lint (W0203)");
  add_lint_option(options, "--warn", LintLevel::warn, lints, "report this lint as a warning");
  add_lint_option(options, "--deny", LintLevel::deny, lints,
                  "report this lint as an error; warnings: all of them");
}

}  // namespace

void add_compile_options(Options& options, CompileOptions& how) {
  add_config_option(options, how.config);
  add_color_option(options);
  add_lint_options(options, how.lints);
  options.choice(
      "-O", {"0", "1"}, [&how](std::size_t level) { how.optimize = level > 0; },
      "1: optimise (default), 0: translate as written");
}

void add_quiet_option(Options& options, bool& quiet, const std::string& description) {
  options.flag("-q,--quiet", quiet, description);
}

void refuse_pair(bool given, const char* one, const char* other) {
  if (given) throw Failure(Exit::usage, fmt::format("{} and {} do not go together", one, other));
}

void refuse_alone(const char* given, const char* other) {
  if (given != nullptr) throw Failure(Exit::usage, fmt::format("{} goes with {}", given, other));
}

void add_duration_option(Options& options, const std::string& name,
                         std::optional<std::chrono::milliseconds>& duration,
                         const std::string& description) {
  options.option(
      name, "TIME", [&duration](const std::string& text) { duration = parse_duration(text); },
      description);
}

}  // namespace robosync::tool
