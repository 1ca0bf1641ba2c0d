// See companion_modules.hpp.
#include "rsc/companion_modules.hpp"

#include <algorithm>
#include <vector>

namespace robosync::tool {
namespace {

using compiler::AlgorithmModule;

// Builds the list from the lines; each belongs to the latest MODULE.
struct Lines {
  std::vector<AlgorithmModule> modules;

  void module(const char* name, const char* device, std::uint16_t usual, std::uint16_t shortest,
              std::uint16_t longest) {
    AlgorithmModule& next = modules.emplace_back();
    next.name = name;
    next.device = device;
    next.usual_period_ms = usual;
    next.shortest_period_ms = shortest;
    next.longest_period_ms = longest;
  }
  void output(const char* name, vm::Dimension dimension, vm::Value low, vm::Value high) {
    modules.back().outputs.push_back({name, dimension, low, high, {}});
  }
  void one_of(const char* name, const char* word) {
    modules.back().outputs.push_back({name, vm::Dimension::number, 0, 0, {word}});
  }
  void word(const char* word) {
    auto& output = modules.back().outputs.back();
    output.labels.emplace_back(word);
    output.max += vm::kScale;
  }
  void words(const char* name, const char* word) {
    modules.back().outputs.push_back({name, vm::Dimension::number, 0, 0, {word}, true});
  }
  void taught(const char* name, const char* word) {
    modules.back().outputs.push_back({name, vm::Dimension::number, 0, 0, {word}, false, true});
  }
  void parameter(const char* name, vm::Dimension dimension, vm::Value usual, vm::Value low,
                 vm::Value high) {
    modules.back().parameters.push_back({name, dimension, usual, low, high});
  }
};

std::vector<AlgorithmModule> all_modules() {
  Lines lines;
#define MODULE(name, device, usual, shortest, longest, doc) \
  lines.module(#name, #device, usual, shortest, longest);
#define OUTPUT(name, dimension, low, high) lines.output(#name, vm::Dimension::dimension, low, high);
#define ONE_OF(name, word) lines.one_of(#name, #word);
#define HUE(name, from) lines.word(#name);
#define WORDS(name, word) lines.words(#name, #word);
#define TAUGHT(name, word) lines.taught(#name, #word);
#define PARAMETER(name, dimension, usual, low, high, doc) \
  lines.parameter(#name, vm::Dimension::dimension, usual, low, high);
#include "companion/modules.def"
#undef MODULE
#undef OUTPUT
#undef ONE_OF
#undef HUE
#undef WORDS
#undef TAUGHT
#undef PARAMETER
  return lines.modules;
}

}  // namespace

std::span<const AlgorithmModule> companion_modules() {
  static const std::vector<AlgorithmModule> modules = all_modules();
  return modules;
}

std::string_view doc_of_companion_module(std::string_view name) {
#define MODULE(module, device, usual, shortest, longest, doc) \
  if (name == #module) return doc;
#define OUTPUT(...)
#define ONE_OF(...)
#define HUE(...)
#define WORDS(...)
#define TAUGHT(...)
#define PARAMETER(...)
#include "companion/modules.def"
#undef MODULE
#undef OUTPUT
#undef ONE_OF
#undef HUE
#undef WORDS
#undef TAUGHT
#undef PARAMETER
  return {};
}

}  // namespace robosync::tool
