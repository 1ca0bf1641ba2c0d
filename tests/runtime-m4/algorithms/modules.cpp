#include "tests/runtime-m4/algorithms/modules.hpp"

namespace robosync::test {

Module::Module(const robosync_description& description, std::vector<std::int32_t> config,
               std::uint32_t period_ms)
    : description_(description), config_(std::move(config)) {
  const robosync_module& module = *description.module;
  for (std::size_t p = config_.size(); p < module.parameters; ++p)
    config_.push_back(module.ranges[p].usual);
  outputs_.assign(module.outputs, ROBOSYNC_UNKNOWN);
  state_.resize(module.state_bytes(config_.data()) / 8 + 1);
  scratch_.resize(module.scratch_bytes(config_.data()) / 8 + 1);
  module.init(state_.data(), config_.data(), period_ms);
}

std::string Module::shown(std::size_t place) const {
  const robosync_output& output = description_.outputs[place];
  const std::string name = output.name;
  if (output.label_count == 0) return name + " " + std::to_string(outputs_[place]);
  return name + " " + output.labels[outputs_[place] / ROBOSYNC_ONE];
}

std::string Module::put(std::initializer_list<std::int32_t> inputs) {
  const robosync_block block = {inputs.begin(), outputs_.data(), config_.data()};
  const std::uint32_t changed =
      description_.module->process(state_.data(), scratch_.data(), &block);
  std::string text;
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    if ((changed >> i & 1) != 0) text += (text.empty() ? "" : " ") + shown(i);
  return text;
}

}  // namespace robosync::test
