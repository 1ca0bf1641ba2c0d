// See loaded_program.hpp. May rely on the verifier: behaviours are in order from the highest priority down; their
// rules follow each other without gaps, and so do the sensors' channels.
#include "runtime-m4/layers/loaded_program.hpp"

#include "runtime-m4/policy/concern.hpp"

namespace robosync::layers {

void LoadedProgram::load(const vm::Image& loaded, Memory& memory) {
  using policy::Part;
  image = loaded;
  inputs = memory.take<Part::behavior_inputs, InputMask>();
  reader_words_ = memory.take<Part::readers, RuleSet::Word>();
  reader_stride_ = policy::reader_words(static_cast<std::uint32_t>(image.rules.size()));
  behavior_of = memory.take<Part::behavior_of, std::uint8_t>();
  truth_cell = memory.take<Part::truth_cells, std::uint8_t>();
  for (unsigned b = 0; b < image.behaviors.size(); ++b) {
    const vm::Behavior& behavior = image.behaviors[b];
    for (const std::uint8_t input :
         image.inputs.subspan(behavior.first_input, behavior.input_count))
      inputs[b] |= bit_of(input);
    load_rules(b);
  }
}

// SAFETY rules are all evaluated together, whatever changes, so they need no readers.
void LoadedProgram::load_rules(unsigned b) {
  const vm::Behavior& behavior = image.behaviors[b];
  unsigned cell = behavior.input_count + 0U + behavior.locals;
  for (unsigned r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count; ++r) {
    behavior_of[r] = static_cast<std::uint8_t>(b);
    if (image.rules[r].kind == vm::RuleKind::watch)
      truth_cell[r] = static_cast<std::uint8_t>(cell++);
    if (b >= first_behavior())
      policy::each_input_of_rule(image, behavior, image.rules[r],
                                 [&](std::uint8_t input) { note_reader(input, r); });
  }
}

void LoadedProgram::note_reader(unsigned input, unsigned rule) {
  RuleSet::Word* const words = &reader_words_[input * reader_stride_];
  const bool several = reader_stride_ > 1;
  RuleBits(words + (several ? 1 : 0)).insert(rule);
  if (several) RuleBits(words).insert(rule / RuleBits::kBits);
}

BehaviorMask LoadedProgram::needing(kernel::Category category, unsigned index) const {
  ChannelMask channels = 0;
  if (category == kernel::Category::sensor) channels = channels_of(index);
  if (category == kernel::Category::algorithm) channels = channels_of(policy::kAlgorithms);
  BehaviorMask needing = 0;
  for (unsigned b = 0; b < image.behaviors.size(); ++b)
    if (policy::needs(image, b, category, index, (inputs[b] & channels) != 0))
      needing |= bit<BehaviorMask>(b);
  return needing;
}

ChannelMask LoadedProgram::channels_of(unsigned sensor_thread) const {
  ChannelMask channels = 0;
  policy::each_channel_of_thread(image, sensor_thread,
                                 [&](unsigned c) { channels |= bit<ChannelMask>(c); });
  return channels;
}

const char* name_of(const vm::Image& image, std::uint16_t offset, const char* otherwise) {
  const std::string_view name = image.string(offset);
  return name.empty() ? otherwise : name.data();
}

}  // namespace robosync::layers
