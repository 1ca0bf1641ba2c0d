#include "rsc/modules/trial.hpp"

#include <algorithm>
#include <optional>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime-m4/module_files/description.hpp"
#include "runtime-m4/module_files/process.hpp"

namespace robosync::tool {
namespace {

using module_files::Config;
using module_files::Inputs;
using module_files::Outputs;
using module_files::Process;
using module_files::Sizes;
using module_files::State;

constexpr std::size_t kSamples = 400;  // in each try

// --- inputs ---

std::vector<Config> configs_for(const robosync_description& names) {
  const robosync_module& module = *names.module;
  Config usual{}, least{}, most{};
  for (std::size_t p = 0; p < module.parameters; ++p) {
    usual[p] = module.ranges[p].usual;
    least[p] = module.ranges[p].least;
    most[p] = module.ranges[p].most;
  }
  std::vector<Config> configs = {usual, least, most};
  for (std::size_t p = 0; p < module.parameters; ++p)
    for (const std::int32_t end : {least[p], most[p]}) {
      Config one = usual;
      one[p] = end;
      configs.push_back(one);
    }
  return configs;
}

// A quarter each: noise of a few units, jumps between two levels, random values, and the extremes of the number range.
Inputs draw(std::mt19937& random, std::size_t place) {
  Inputs inputs{};
  for (std::int32_t& input : inputs) {
    const auto drawn = static_cast<std::uint32_t>(random());
    const std::int32_t any = std::max(static_cast<std::int32_t>(drawn), INT32_MIN + 1);
    switch (place * 4 / kSamples) {
      case 0:
        input = any % 20'000;
        break;
      case 1:
        input = place / 8 % 2 == 0 ? 0 : 5000 + any % 500;
        break;
      case 2:
        input = any;
        break;
      default:
        input = drawn % 2 == 0 ? INT32_MAX : INT32_MIN + 1;
    }
  }
  return inputs;
}

// --- promises ---

class Trial {
public:
  explicit Trial(const std::string& file)
      : file_(file), module_(file), description_(module_.described()) {}

  std::vector<Finding> run() {
    std::string wrong = module_.trouble();
    if (wrong.empty()) wrong = description_.mistake();
    add("it can be loaded, and describes itself", wrong);
    if (!wrong.empty()) return findings_;
    tries_ = tries_for(description_.in_c());
    add("it fits in the memory there is, and states its cost", mistake_in_sizes());
    if (ended()) return findings_;
    add("it stays in its memory, and returns", mistake_in_runs());
    if (ended()) return findings_;
    add("its outputs are in range, and it reports those that changed", outputs_);
    add("it gives the same outputs every time, whatever its scratch held", mistake_in_repeating());
    return findings_;
  }

private:
  void add(const std::string& promise, const std::string& broken) {
    findings_.push_back({promise, broken});
  }
  bool ended() const { return !module_.trouble().empty() || !findings_.back().broken.empty(); }

  std::string shown(const Try& one) const {
    const robosync_description& names = description_.in_c();
    std::vector<std::string> parts;
    for (std::size_t p = 0; p < names.module->parameters; ++p)
      parts.push_back(fmt::format("{} {}", names.parameters[p].name, one.config[p] / 1000.0));
    return fmt::format("every {} ms{}{}", one.period_ms, parts.empty() ? "" : ", with ",
                       fmt::join(parts, ", "));
  }

  std::string mistake_in_sizes() {
    for (const Try& one : tries_) {
      Sizes sizes, again;
      if (!module_.measure(one.config, sizes) || !module_.measure(one.config, again))
        return module_.trouble() + " (" + shown(one) + ")";
      const std::uint64_t bytes = (std::uint64_t{sizes.state} + 7) / 8 * 8 + sizes.scratch;
      if (bytes > ROBOSYNC_MOST_BYTES)
        return fmt::format("state and scratch come to {} bytes, more than {} ({})", bytes,
                           std::uint32_t{ROBOSYNC_MOST_BYTES}, shown(one));
      if (sizes.cost == 0) return "its cost() is 0 (" + shown(one) + ")";
      if (sizes.state != again.state || sizes.scratch != again.scratch || sizes.cost != again.cost)
        return "it gives another answer when asked again (" + shown(one) + ")";
    }
    return "";
  }

  std::string mistake_in_runs() {
    for (const Try& one : tries_) {
      if (!run(module_, one, 0)) return module_.trouble() + " (" + shown(one) + ")";
    }
    return "";
  }

  // Its outputs after each sample; nothing if it ended early. The first error in them is noted.
  std::optional<std::vector<Outputs>> run(Process& module, const Try& one,
                                          std::uint8_t scratch_holds) {
    std::vector<Outputs> left;
    State state{};
    Outputs outputs{};
    std::fill_n(outputs.begin(), description_.module().outputs, ROBOSYNC_UNKNOWN);
    if (!module.init(one.config, one.period_ms, state)) return std::nullopt;
    for (const Inputs& inputs : one.samples) {
      const Outputs before = outputs;
      std::uint32_t changed = 0;
      if (!module.process(one.config, inputs, state, outputs, changed, scratch_holds))
        return std::nullopt;
      if (changed == ROBOSYNC_FAILED) break;  // allowed
      left.push_back(outputs);
      const std::string wrong = mistake_in_outputs(before, outputs, changed);
      if (outputs_.empty() && !wrong.empty())
        outputs_ = fmt::format("{} ({}, sample {}, inputs in thousandths: {})", wrong, shown(one),
                               left.size(), shown(inputs));
    }
    return left;
  }

  std::string shown(const Inputs& inputs) const {
    return fmt::format(
        "{}", fmt::join(inputs.begin(), inputs.begin() + description_.module().inputs, ", "));
  }

  std::string mistake_in_outputs(const Outputs& before, const Outputs& after,
                                 std::uint32_t changed) const {
    const robosync_description& names = description_.in_c();
    for (std::size_t i = 0; i < names.module->outputs; ++i) {
      const robosync_output& output = names.outputs[i];
      const bool has_changed = before[i] != after[i];
      if (has_changed && after[i] != ROBOSYNC_UNKNOWN &&
          (after[i] < output.least || after[i] > output.most))
        return fmt::format("{} is {}, outside its range of {} to {}", output.name,
                           after[i] / 1000.0, output.least / 1000.0, output.most / 1000.0);
      if (output.label_count != 0 && after[i] != ROBOSYNC_UNKNOWN && after[i] % ROBOSYNC_ONE != 0)
        return fmt::format("{} has words, and {} is not one of them", output.name,
                           after[i] / 1000.0);
      if (has_changed && (changed >> i & 1) == 0)
        return fmt::format("{} changed, and process() did not report it", output.name);
    }
    if (changed >> names.module->outputs != 0)
      return "process() reports a change of an output that does not exist";
    return "";
  }

  // In another process, from last to first, with different scratch content.
  std::string mistake_in_repeating() {
    Process other(file_);
    for (auto one = tries_.rbegin(); one != tries_.rend(); ++one) {
      const auto first = run(module_, *one, 0x00);
      const auto second = run(other, *one, 0xff);
      if (!first || !second) return module_.trouble() + other.trouble() + " (" + shown(*one) + ")";
      const auto [a, b] = std::ranges::mismatch(*first, *second);
      if (a == first->end()) continue;
      const auto place = static_cast<std::size_t>(a - first->begin());
      return fmt::format("sample {} gave other outputs when it was tried again ({})", place + 1,
                         shown(*one));
    }
    return "";
  }

  std::string file_;
  Process module_;
  module_files::Description description_;
  std::vector<Try> tries_;
  std::string outputs_;  // the first error in the outputs
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Try> tries_for(const robosync_description& names) {
  std::mt19937 random(1);
  std::vector<Try> tries;
  for (const Config& config : configs_for(names))
    for (const std::uint32_t period :
         {std::uint32_t{names.module->shortest_period_ms}, std::uint32_t{names.usual_period_ms},
          std::uint32_t{names.module->longest_period_ms}}) {
      Try one{config, period, {}};
      for (std::size_t i = 0; i < kSamples; ++i)
        one.samples.push_back(draw(random, i));
      tries.push_back(std::move(one));
    }
  return tries;
}

std::vector<Finding> try_module(const std::string& file) {
  return Trial(file).run();
}

}  // namespace robosync::tool
