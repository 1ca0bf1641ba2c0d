#include "rsc/algorithm_modules.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "companion/words_file.hpp"
#include "rsc/companion_modules.hpp"
#include "runtime-m4/algorithms/judge.hpp"
#include "runtime-m4/algorithms/own_words.h"
#include "runtime-m4/module_files/registry.hpp"

namespace robosync::tool {
namespace {

// The types of vm/ as robosync_module.h writes them in C.
constexpr std::uint8_t number_of(vm::Dimension dimension) {
  return static_cast<std::uint8_t>(dimension);
}
static_assert(ROBOSYNC_NUMBER == number_of(vm::Dimension::number) &&
              ROBOSYNC_SECONDS == number_of(vm::Dimension::duration) &&
              ROBOSYNC_PERCENT == number_of(vm::Dimension::percent) &&
              ROBOSYNC_HERTZ == number_of(vm::Dimension::frequency) &&
              ROBOSYNC_G == number_of(vm::Dimension::acceleration) &&
              ROBOSYNC_DECIBEL == number_of(vm::Dimension::loudness) &&
              ROBOSYNC_MICROTESLA == number_of(vm::Dimension::magnetic_field));
static_assert(ROBOSYNC_ONE == vm::kScale && ROBOSYNC_UNKNOWN == vm::kUnknown);

std::optional<vm::Dimension> dimension(std::uint8_t unit) {
  if (unit == ROBOSYNC_AS_INPUT) return std::nullopt;
  if (unit == ROBOSYNC_COUNT) return vm::Dimension::number;
  return static_cast<vm::Dimension>(unit);
}

// In kilobytes besides the first one, with the usual parameters.
std::uint8_t room_of(const robosync_module& module,
                     const std::vector<compiler::ModuleParameter>& parameters) {
  std::vector<std::int32_t> usual;
  usual.reserve(parameters.size());
  for (const compiler::ModuleParameter& parameter : parameters)
    usual.push_back(parameter.usual);
  const std::uint32_t bytes =
      algorithms::scratch_at(module, usual.data()) + module.scratch_bytes(usual.data());
  if (bytes <= ROBOSYNC_MOST_BYTES) return 0;
  return static_cast<std::uint8_t>((bytes - ROBOSYNC_MOST_BYTES + ROBOSYNC_ROOM - 1) /
                                   ROBOSYNC_ROOM);
}

compiler::AlgorithmModule described(const robosync_description& description) {
  const robosync_module& module = *description.module;
  compiler::AlgorithmModule result;
  result.name = description.name;
  for (std::size_t i = 0; i < module.inputs; ++i)
    result.inputs.push_back({description.inputs[i].name, dimension(description.inputs[i].unit)});
  for (std::size_t i = 0; i < module.outputs; ++i) {
    const robosync_output& output = description.outputs[i];
    result.outputs.push_back({output.name,
                              static_cast<vm::Dimension>(output.unit),
                              output.least,
                              output.most,
                              {output.labels, output.labels + output.label_count}});
    if (module.learns == 0 || output.label_count == 0) continue;
    result.outputs.back().is_taught = true;
    result.outputs.back().max = (output.label_count - 1) * vm::kScale;
  }
  for (std::size_t i = 0; i < module.parameters; ++i) {
    const robosync_parameter& parameter = description.parameters[i];
    const robosync_range& range = module.ranges[i];
    result.parameters.push_back({parameter.name, dimension(parameter.unit), range.usual,
                                 range.least, range.most, parameter.unit == ROBOSYNC_COUNT});
  }
  result.shortest_period_ms = module.shortest_period_ms;
  result.longest_period_ms = module.longest_period_ms;
  result.usual_period_ms = description.usual_period_ms;
  if (module.learns != 0) {
    result.room = room_of(module, result.parameters);
    result.most_constants = ROBOSYNC_MOST_CONSTANTS;
  }
  return result;
}

std::vector<compiler::AlgorithmModule> all() {
  std::vector<compiler::AlgorithmModule> modules;
  while (const robosync_description* next = algorithms::find_description(modules.size()))
    modules.push_back(described(*next));
  return modules;
}

compiler::ModuleInFile in_file(const std::string& path) {
  static compiler::AlgorithmModule last;
  const module_files::Loaded loaded = module_files::load(path);
  if (loaded.description == nullptr) return {nullptr, 0, loaded.why_not};
  last = described(*loaded.description);
  return {&last, static_cast<std::uint8_t>(loaded.number), ""};
}

compiler::WordsInFile words_in_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return {{}, "is not there"};
  if (!std::filesystem::is_regular_file(path, error))
    return {{}, "is not a file"};  // a pipe, which would block
  std::string text(companion::kLargestFile + 1, '\0');
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) return {{}, "cannot be read"};
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  companion::ReadWords read = companion::read_words(text);
  if (!read.trouble.empty())
    return {{}, "cannot be used: line " + std::to_string(read.line) + ": " + read.trouble};
  compiler::WordsInFile found;
  for (companion::TaughtWord& word : read.words)
    found.words.push_back(std::move(word.name));
  found.constants = companion::constants_of(read.words);
  return found;
}

}  // namespace

compiler::AlgorithmModules algorithm_modules() {
  static const std::vector<compiler::AlgorithmModule> modules = all();
  return {modules, in_file, companion_modules(), words_in_file};
}

analysis::Instructions module_cost(const vm::Image& image, const vm::Sensor& algorithm) {
  return algorithms::module_of(algorithm).cost(algorithms::config_of(image, algorithm));
}

std::string module_troubles() {
  std::string text;
  for (const std::string& trouble : module_files::troubles())
    text += (text.empty() ? "" : "\n") + trouble;
  return text;
}

}  // namespace robosync::tool
