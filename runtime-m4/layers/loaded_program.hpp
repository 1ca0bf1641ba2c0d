// The running program: its image, and what is computed from it once, when it is loaded.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/kernel/scheduler.hpp"
#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "runtime-m4/layers/rule_set.hpp"
#include "runtime-m4/policy/threads.hpp"
#include "vm/image.hpp"
#include "vm/verifier.hpp"

namespace robosync::layers {

struct LoadedProgram {
  vm::Image image;
  std::span<InputMask> inputs;          // what each behaviour reads
  std::span<std::uint8_t> behavior_of;  // by rule
  std::span<std::uint8_t> truth_cell;  // of a WATCH, if there is one: the cell that holds its truth

  // `image` is verified, and `memory` is laid out for it.
  void load(const vm::Image& image, Memory& memory);

  // Adds the rules that read or set an input.
  void add_readers_of(unsigned input, RuleSet& rules) const {
    RuleSet::Word* const words = reader_words_.data() + input * reader_stride_;
    if (reader_stride_ > 1) {
      rules.insert_all(RuleBits(words + 1), words[0]);
    } else if (reader_stride_ != 0 && words[0] != 0) {
      rules.insert_all(RuleBits(words), 1);
    }
  }

  unsigned first_behavior() const { return policy::first_behavior(image); }
  RuleRange rules_of(unsigned behavior) const {
    const vm::Behavior& wiring = image.behaviors[behavior];
    return {wiring.first_rule, wiring.first_rule + 0U + wiring.rule_count};
  }
  bool is_variable(unsigned input) const { return input >= image.channels.size(); }
  unsigned variable_of(unsigned input) const {
    return input - static_cast<unsigned>(image.channels.size());
  }
  InputMask bit_of(unsigned input) const {
    return is_variable(input) ? layers::inputs(0, bit<VariableMask>(variable_of(input)))
                              : bit<ChannelMask>(input);
  }

  // The behaviours that need a thread, including the SAFETY rules. `index` is that of its sensor
  // (policy::kFedSensors: all that are fed; policy::kAlgorithms), behaviour or actuator.
  BehaviorMask needing(kernel::Category category, unsigned index) const;

  // The channels whose readers need this sensor thread.
  ChannelMask channels_of(unsigned sensor_thread) const;

private:
  void load_rules(unsigned behavior);
  void note_reader(unsigned input, unsigned rule);

  std::span<RuleSet::Word> reader_words_;  // by input (policy::reader_words())
  std::size_t reader_stride_ = 0;
};

// The name at `offset` of the strings, for reports; `otherwise` if there is none.
const char* name_of(const vm::Image& image, std::uint16_t offset, const char* otherwise);

}  // namespace robosync::layers
