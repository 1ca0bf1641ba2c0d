// See thresholds.hpp.
//
// A channel qualifies if this holds for all rules that read it, in a condition or in a response:
//
// * In conditions it is only compared with constants.
// * Their conditions are steady: evaluated again with the same operands, they have the same result and no effect. So there are no
//   random numbers, divisions and events in them. FOR and MARGIN qualify: a rule says itself when their time has come.
// * No response of their behaviours polls, as WAIT UNTIL and FOLLOW do: any changed input of a behaviour makes it poll.
//
// Other responses read a channel when they run, but do not run because it has changed.
#include "runtime-m4/layers/thresholds.hpp"

#include <algorithm>
#include <array>

#include "runtime-m4/policy/concern.hpp"

namespace robosync::layers {
namespace {

using Words = std::span<const vm::Word>;

bool polls(const vm::Image& image, const vm::Rule& rule) {
  for (const std::uint16_t index : {rule.then_response, rule.else_response}) {
    if (index == vm::kNoIndex) continue;
    const vm::Response& response = image.responses[index];
    for (const vm::Word word : image.code.subspan(response.start, response.length))
      if (policy::uses(word, policy::kPolls)) return true;
  }
  return false;
}

bool is_steady(Words condition) {
  return std::ranges::all_of(condition,
                             [](vm::Word word) { return policy::uses(word, policy::kSteady); });
}

class Search {
public:
  explicit Search(const vm::Image& image) : image_(image) {}

  // The channels that do not qualify.
  ChannelMask others() {
    for (const vm::Behavior& behavior : image_.behaviors.subspan(policy::first_behavior(image_)))
      look_at(behavior);
    return others_;
  }

private:
  void look_at(const vm::Behavior& behavior) {
    bool any_polls = false;
    for (const vm::Rule& rule : image_.rules.subspan(behavior.first_rule, behavior.rule_count)) {
      look_at(behavior, rule);
      any_polls = any_polls || polls(image_, rule);
    }
    if (!any_polls) return;
    for (const std::uint8_t input :
         image_.inputs.subspan(behavior.first_input, behavior.input_count))
      exclude(input);
  }

  void look_at(const vm::Behavior& behavior, const vm::Rule& rule) {
    const auto exclude_input = [this](std::uint8_t input) { exclude(input); };
    const Words condition = image_.code.subspan(rule.condition_start, rule.condition_length);
    if (!is_steady(condition))
      return policy::each_input_of_rule(image_, behavior, rule, exclude_input);
    for (const vm::Word word : condition)
      if (!policy::uses(word, policy::kCompares))
        policy::each_input_of_word(image_, behavior, word, exclude_input);
  }

  void exclude(std::uint8_t input) {
    if (input < image_.channels.size()) others_ |= bit<ChannelMask>(input);
  }

  const vm::Image& image_;
  ChannelMask others_ = 0;
};

}  // namespace

void Thresholds::start(const vm::Image& image, Memory& memory) {
  constants_ = image.constants.data();
  runs_ = memory.take<policy::Part::thresholds, Run>();
  compared_ = memory.take<policy::Part::compared, std::uint8_t>().data();
  policy::each_comparison(image, [&](unsigned channel, std::uint8_t) { ++runs_[channel].end; });
  std::uint16_t next = 0;
  for (Run& run : runs_) {
    const std::uint16_t count = run.end;
    run.first = run.end = next;
    next = static_cast<std::uint16_t>(next + count);
  }
  policy::each_comparison(
      image, [&](unsigned channel, std::uint8_t constant) { insert(runs_[channel], constant); });
  each_bit(Search(image).others(), [&](unsigned channel) { runs_[channel].first = Run::kAny; });
}

// A run has at most as many constants as fit into the byte that names one.
void Thresholds::insert(Run& run, std::uint8_t constant) {
  const auto less = [this](std::uint8_t a, std::uint8_t b) {
    return constants_[a] < constants_[b];
  };
  std::uint8_t* const end = compared_ + run.end;
  std::uint8_t* const place = std::lower_bound(compared_ + run.first, end, constant, less);
  if (place != end && constants_[*place] == constants_[constant]) return;
  std::copy_backward(place, end, end + 1);
  *place = constant;
  ++run.end;
}

// A comparison has different results only if its constant lies between the readings or is one of them.
bool Thresholds::separate(unsigned channel, vm::Value from, vm::Value to) const {
  const vm::Value low = std::min(from, to);
  const vm::Value high = std::max(from, to);
  unsigned first = runs_[channel].first;
  if (first == Run::kAny || low == vm::kUnknown) return true;
  for (unsigned end = runs_[channel].end; first < end;) {
    const unsigned middle = (first + end) / 2;
    const vm::Value constant = constants_[compared_[middle]];
    if (constant < low) {
      first = middle + 1;
    } else if (constant > high) {
      end = middle;
    } else {
      return true;
    }
  }
  return false;
}

}  // namespace robosync::layers
