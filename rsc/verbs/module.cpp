// rsc module check FILE.c|FILE.so
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/modules/compiled.hpp"
#include "rsc/modules/trial.hpp"
#include "rsc/verb.hpp"
#include "runtime-m4/module_files/registry.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;

struct ModuleOptions {
  std::string action, file;
};

void print(const Finding& finding) {
  const bool kept = finding.broken.empty();
  std::cout << (kept ? "ok      " : "FAILED  ") << finding.promise << '\n';
  if (!kept) std::cout << "        " << finding.broken << '\n';
  std::cout << std::flush;
}

// For a compiled module, the C file next to it.
std::optional<std::string> source_of(const std::string& file) {
  const fs::path source = fs::path(file).replace_extension(".c");
  std::error_code error;
  if (!fs::exists(source, error)) return std::nullopt;
  return source.string();
}

// With the default, the lowest and the highest parameters: the first three configurations.
Finding try_cost(const std::string& source, const std::string& file, const WorkFolder& folder) {
  constexpr std::size_t kConfigs = 3, kPeriods = 3;
  const module_files::Loaded loaded = module_files::load(file);
  const robosync_module& module = *loaded.description->module;
  const std::vector<Try> tries = tries_for(*loaded.description);
  std::uint32_t most = 0;
  for (std::size_t config = 0; config < kConfigs; ++config) {
    const Try& one = tries[config * kPeriods];
    const std::uint32_t declared = module.cost(one.config.data());
    const std::uint32_t counted = count_instructions(source, one, module, folder);
    most = std::max(most, counted);
    if (counted > declared)
      return {"it costs no more than it states",
              fmt::format("a sample took {} instructions on the Cortex-M4, and its cost() is {}: "
                          "the robot would "
                          "give the module a lower rank, and then stop it",
                          counted, declared)};
  }
  return {fmt::format("it costs no more than it states: {} instructions on the Cortex-M4 at most",
                      most),
          ""};
}

// Messages show its own name, robot.json uses the file name.
void note_another_name(const std::string& file) {
  const std::string named = fs::path(file).stem().string();
  const robosync_description* const description = module_files::load(file).description;
  if (description != nullptr && description->name != named)
    std::cout << fmt::format(
        "note    it calls itself `{}`, but its file is `{}`: give both the same name\n",
        description->name, named);
}

// True if the module keeps every promise.
bool check(const std::string& file, const std::optional<std::string>& source,
           const WorkFolder& folder) {
  bool fine = true;
  for (const Finding& finding : try_module(file)) {
    print(finding);
    fine = fine && finding.broken.empty();
  }
  if (!fine) return false;
  note_another_name(file);
  if (!source || !can_count()) {
    std::cout << fmt::format(
        "not tested: its cost, and its use of floating point; this needs {}\n",
        source ? "arm-none-eabi-gcc and qemu-system-arm" : "its C file beside it");
    return true;
  }
  const bool floats = uses_floating_point(*source, folder);
  print({"it computes without floating point",
         floats ? "process() may give other outputs on the board than here" : ""});
  if (floats) return false;
  const Finding cost = try_cost(*source, file, folder);
  print(cost);
  return cost.broken.empty();
}

void run(const ModuleOptions& options) {
  if (options.action != "check")
    throw Failure(
        Exit::usage,
        fmt::format("`rsc module {}` does not exist; write `rsc module check`", options.action));
  std::error_code error;
  if (!fs::exists(options.file, error))
    throw Failure(Exit::outside, fmt::format("there is no file {}", options.file));
  const WorkFolder folder;
  const bool is_source = fs::path(options.file).extension() == ".c";
  const std::string file = is_source ? compile_for_here(options.file, folder) : options.file;
  if (!check(file, source_of(options.file), folder))
    throw Failure(Exit::program, fmt::format("{} breaks the rules for modules", options.file));
  std::cout << fmt::format("{} is a module that does what it declares, as far as it was tested\n",
                           options.file);
}

}  // namespace

void add_module(Options& options) {
  auto asked = std::make_shared<ModuleOptions>();
  options.argument("check", asked->action, "test the module against its declaration",
                   Options::Need::required);
  options.argument("FILE", asked->file, "the module: its C file, or compiled (.so)",
                   Options::Need::required);
  options.runs([asked] { run(*asked); });
}

}  // namespace robosync::tool
