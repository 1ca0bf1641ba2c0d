// See program.hpp. May rely on the verifier: behaviours stand from the highest priority down, their
// rules follow each other without gaps, as the channels of the sensors do.
#include "runtime-m4/layers/loaded_program.hpp"

#include "runtime-m4/policy/concern.hpp"
#include "vm/opcode_traits.hpp"
#include "vm/timers.hpp"

namespace robosync::layers {

void LoadedProgram::load(const vm::Image& loaded) {
  image = loaded;
  readers_of_channel.fill({});
  readers_of_variable.fill({});
  safety_cells = 0;
  safety_timer_words = 0;
  if (image.has_safety()) safety_cells = image.behaviors[vm::kSafetyBehavior].cells;
  for (unsigned b = 0; b < image.behaviors.size(); ++b) {
    const vm::Behavior& behavior = image.behaviors[b];
    inputs[b] = 0;
    for (const std::uint8_t input :
         image.inputs.subspan(behavior.first_input, behavior.input_count))
      inputs[b] |= bit_of(input);
    load_rules(b);
  }
}

// SAFETY rules are evaluated all together, whatever changes: nobody looks them up.
void LoadedProgram::load_rules(unsigned b) {
  const vm::Behavior& behavior = image.behaviors[b];
  unsigned cell = behavior.input_count + 0U + behavior.locals;
  for (unsigned r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count; ++r) {
    behavior_of[r] = static_cast<std::uint8_t>(b);
    if (image.rules[r].kind == vm::RuleKind::watch)
      truth_cell[r] = static_cast<std::uint8_t>(cell++);
    if (b >= first_behavior()) {
      policy::each_input_of_rule(image, behavior, image.rules[r],
                                 [&](std::uint8_t input) { readers_of(input).insert(r); });
    } else {
      note_timers(image.rules[r]);
    }
  }
}

RuleBits& LoadedProgram::readers_of(unsigned input) {
  return is_variable(input) ? readers_of_variable[variable_of(input)] : readers_of_channel[input];
}

// Of a SAFETY rule: its condition has them all. They are numbered as they stand in the code, and
// the code of the SAFETY rules stands first; so the last one ends what belongs to SAFETY.
void LoadedProgram::note_timers(const vm::Rule& rule) {
  for (const vm::Word word : image.code.subspan(rule.condition_start, rule.condition_length)) {
    if (vm::traits_of(word).operand(2) != vm::Operand::timer) continue;
    const vm::Timer& timer = image.timers[vm::operand_c(word)];
    safety_timer_words = static_cast<std::uint16_t>(timer.state + vm::timer_words(timer));
  }
}

BehaviorMask LoadedProgram::needing(kernel::Category category, unsigned index) const {
  const ChannelMask channels = category == kernel::Category::sensor ? channels_of(index) : 0;
  BehaviorMask needing = 0;
  for (unsigned b = 0; b < image.behaviors.size(); ++b)
    if (policy::needs(image, b, category, index, (inputs[b] & channels) != 0))
      needing |= bit<BehaviorMask>(b);
  return needing;
}

ChannelMask LoadedProgram::channels_of(unsigned sensor_thread) const {
  ChannelMask channels = 0;
  for (unsigned s = 0; s < image.sensors.size(); ++s) {
    const vm::Sensor& wiring = image.sensors[s];
    if (policy::thread_of(image, s) == sensor_thread)
      for (unsigned i = 0; i < wiring.channel_count; ++i)
        channels |= bit<ChannelMask>(wiring.first_channel + i);
  }
  return channels;
}

namespace {

// Words that a response without loops puts out at most.
std::size_t output_of(const vm::Image& image, std::uint16_t response) {
  const vm::Response& body = image.responses[response];
  std::size_t words = 0;
  for (const vm::Word word : image.code.subspan(body.start, body.length))
    words += vm::output_words(vm::traits_of(word).effect());
  return words;
}

vm::Verdict tables_fit(const vm::Image& image) {
  using vm::Refusal;
  using vm::Section;
  const auto refuse = [](Section section, std::size_t most) {
    return vm::Verdict{Refusal::too_many, section, static_cast<std::uint16_t>(most)};
  };
  if (image.channels.size() > kMaxChannels) return refuse(Section::channels, kMaxChannels);
  if (image.variables.size() > kMaxVariables) return refuse(Section::variables, kMaxVariables);
  if (image.rules.size() > kMaxRules) return refuse(Section::rules, kMaxRules);
  if (image.checks.size() > kMaxChecks) return refuse(Section::checks, kMaxChecks);
  std::size_t samples = 0;
  for (const vm::Check& check : image.checks)
    if (check.window > 1) samples += check.window;
  if (samples > kMaxSamples) return refuse(Section::checks, kMaxSamples);
  std::size_t fading = 0;
  for (const vm::Variable& variable : image.variables)
    if (variable.fade != 0) ++fading;
  if (fading > kMaxFading) return refuse(Section::variables, kMaxFading);
  std::size_t timer_words = 0;
  for (const vm::Timer& timer : image.timers)
    timer_words += vm::timer_words(timer);
  if (timer_words > kMaxTimerWords) return refuse(Section::timers, kMaxTimerWords);
  for (const vm::Rule& rule : image.rules)
    if (rule.kind == vm::RuleKind::safety &&
        output_of(image, rule.then_response) > kMaxSafetyOutput)
      return refuse(Section::responses, kMaxSafetyOutput);
  return {};
}

}  // namespace

vm::Verdict fits(const vm::Image& image) {
  using vm::Refusal;
  using vm::Section;
  const vm::Verdict tables = tables_fit(image);
  if (!tables.ok()) return tables;
  std::size_t sensors = 0;
  std::size_t fed_sensors = 0;
  for (const vm::Sensor& sensor : image.sensors)
    (policy::is_fed(sensor) ? fed_sensors : sensors) += 1;
  if (fed_sensors > 0) ++sensors;  // one thread for all
  std::size_t behaviors = image.behaviors.size();
  if (image.has_safety()) --behaviors;
  const std::size_t actuators = image.actuators.size();
  const std::size_t threads = sensors + behaviors + actuators;
  const std::size_t stacks =
      sensors * kSensorStack + behaviors * kBehaviorStack + actuators * kControlStack + kStepStack;
  if (threads + 1 > kMaxProgramThreads || stacks > kStackArena)
    return {Refusal::too_many, Section::header, static_cast<std::uint16_t>(threads)};
  return {};
}

const char* name_of(const vm::Image& image, std::uint16_t offset, const char* otherwise) {
  const std::string_view name = image.string(offset);
  return name.empty() ? otherwise : name.data();
}

}  // namespace robosync::layers
