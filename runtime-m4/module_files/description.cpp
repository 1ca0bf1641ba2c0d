#include "runtime-m4/module_files/description.hpp"

#include <algorithm>

namespace robosync::module_files {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_name(const std::string& text) {
  return !text.empty() && is_letter(text.front()) &&
         std::ranges::all_of(text, [](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

enum : std::uint8_t {
#define DIMENSION(name, unit, phrase) k_##name,
#include "vm/dimensions.def"
#undef DIMENSION
  kDimensions
};

}  // namespace

Description::Description(const Described& said) {
  judge(said);
  if (mistake_.empty()) copy(said);
}

Config Description::usual() const {
  Config config{};
  for (std::size_t i = 0; i < module_.parameters; ++i)
    config[i] = ranges_[i].usual;
  return config;
}

// --- copies ---

const char* Description::kept(const Name& name) {
  return texts_.emplace_back(name.data()).c_str();
}

void Description::copy(const Described& said) {
  words_.reserve(kMostWords);
  std::size_t word = 0;
  for (std::size_t i = 0; i < said.inputs; ++i)
    inputs_[i] = {kept(said.input_names[i]), said.input_units[i]};
  for (std::size_t i = 0; i < said.outputs; ++i) {
    const DescribedOutput& output = said.output[i];
    const char* const* const words = output.words != 0 ? words_.data() + words_.size() : nullptr;
    for (std::size_t w = 0; w < output.words; ++w)
      words_.push_back(kept(said.words[word++]));
    outputs_[i] = {kept(output.name), output.unit, output.least, output.most, words, output.words};
  }
  for (std::size_t i = 0; i < said.parameters; ++i) {
    parameters_[i] = {kept(said.parameter_names[i]), said.parameter_units[i]};
    ranges_[i] = said.ranges[i];
  }
  module_.inputs = said.inputs;
  module_.outputs = said.outputs;
  module_.parameters = said.parameters;
  module_.shortest_period_ms = said.shortest_period_ms;
  module_.longest_period_ms = said.longest_period_ms;
  module_.ranges = ranges_.data();
  in_c_ = {kept(said.name), &module_,        said.usual_period_ms,
           inputs_.data(),  outputs_.data(), parameters_.data()};
}

// --- is it as it must be? ---

void Description::add_mistake(const std::string& mistake) {
  if (mistake_.empty()) mistake_ = mistake;
}

void Description::judge_name(const std::string& what, const Name& name) {
  const std::string text = name.data();
  if (!is_name(text)) add_mistake("its " + what + " is called \"" + text + "\", which is no name");
}

void Description::judge_unit(const std::string& what, unsigned unit, bool may_be_any) {
  if (unit >= kDimensions && !(may_be_any && unit == ROBOSYNC_AS_INPUT))
    add_mistake("its " + what + " has a unit that is none: " + std::to_string(unit));
}

void Description::judge_output(const Described& said, const DescribedOutput& output) {
  const std::string what = std::string("output ") + output.name.data();
  judge_name("output", output.name);
  judge_unit(what, output.unit, false);
  if (output.least >= output.most && output.words != 1)
    add_mistake("the range of its " + what + " is empty");
  if (output.words != 0 && (output.unit != ROBOSYNC_NUMBER || output.least != 0 ||
                            output.most != (output.words - 1) * ROBOSYNC_ONE))
    add_mistake("its " + what + " has " + std::to_string(output.words) +
                " words, so it goes from 0 to " + std::to_string(output.words - 1) +
                " and has no unit");
  for (const DescribedOutput* other = said.output.data(); other != &output; ++other)
    if (std::string(other->name.data()) == output.name.data())
      add_mistake("it has two outputs " + std::string(output.name.data()));
}

void Description::judge(const Described& said) {
  judge_name("module", said.name);
  if (said.inputs == 0 || said.inputs > ROBOSYNC_MOST_INPUTS || said.outputs == 0 ||
      said.outputs > ROBOSYNC_MOST_OUTPUTS || said.parameters > ROBOSYNC_MOST_PARAMETERS)
    return add_mistake("it needs 1 to " + std::to_string(ROBOSYNC_MOST_INPUTS) + " inputs, 1 to " +
                       std::to_string(ROBOSYNC_MOST_OUTPUTS) + " outputs and at most " +
                       std::to_string(ROBOSYNC_MOST_PARAMETERS) + " parameters");
  if (said.shortest_period_ms == 0 || said.shortest_period_ms > said.usual_period_ms ||
      said.usual_period_ms > said.longest_period_ms)
    add_mistake("its usual period does not lie between its shortest and its longest one");
  std::size_t words = 0;
  for (std::size_t i = 0; i < said.inputs; ++i) {
    judge_name("input", said.input_names[i]);
    judge_unit("input", said.input_units[i], true);
  }
  for (std::size_t i = 0; i < said.outputs; ++i) {
    judge_output(said, said.output[i]);
    for (std::size_t w = 0; w < said.output[i].words && words < kMostWords; ++w)
      judge_name("word", said.words[words++]);
  }
  if (words >= kMostWords) add_mistake("it has too many words");
  for (std::size_t i = 0; i < said.parameters; ++i) {
    judge_name("parameter", said.parameter_names[i]);
    if (said.parameter_units[i] != ROBOSYNC_COUNT)
      judge_unit("parameter", said.parameter_units[i], true);
    const robosync_range& range = said.ranges[i];
    if (range.least > range.usual || range.usual > range.most)
      add_mistake("the usual value of its parameter " +
                  std::string(said.parameter_names[i].data()) + " is out of its range");
  }
}

}  // namespace robosync::module_files
