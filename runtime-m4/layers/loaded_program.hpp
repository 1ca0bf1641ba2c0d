// The running program: its image, and what is worked out from it once, when it is loaded.
#pragma once

#include <array>
#include <cstdint>

#include "runtime-m4/kernel/scheduler.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "runtime-m4/layers/rule_set.hpp"
#include "runtime-m4/policy/threads.hpp"
#include "vm/image.hpp"
#include "vm/verifier.hpp"

namespace robosync::layers {

struct LoadedProgram {
  vm::Image image;
  std::array<InputMask, kMaxBehaviors> inputs{};  // that each behaviour reads
  // The rules that read or set each channel, each variable.
  std::array<RuleBits, kMaxChannels> readers_of_channel{};
  std::array<RuleBits, kMaxVariables> readers_of_variable{};
  std::array<std::uint8_t, kMaxRules> behavior_of{};  // by rule
  std::array<std::uint8_t, kMaxRules> truth_cell{};   // of a WATCH: where its truth is kept
  std::uint16_t safety_cells = 0;                     // of the frame of the SAFETY rules
  std::uint16_t safety_timer_words = 0;  // … and of their timers, which are the first

  // `image` is verified and fits().
  void load(const vm::Image& image);

  unsigned first_behavior() const { return policy::first_behavior(image); }
  RuleRange rules_of(unsigned behavior) const {
    const vm::Behavior& wiring = image.behaviors[behavior];
    return {wiring.first_rule, wiring.first_rule + 0U + wiring.rule_count};
  }
  bool is_variable(unsigned input) const { return input >= image.channels.size(); }
  unsigned variable_of(unsigned input) const {
    return input - static_cast<unsigned>(image.channels.size());
  }
  RuleBits& readers_of(unsigned input);
  InputMask bit_of(unsigned input) const {
    return is_variable(input) ? layers::inputs(0, bit<VariableMask>(variable_of(input)))
                              : bit<ChannelMask>(input);
  }

  // The behaviours that need a thread, the SAFETY rules among them. `index` is that of its sensor
  // (policy::kFedSensors: all that are fed), behaviour or actuator.
  BehaviorMask needing(kernel::Category category, unsigned index) const;

  // That a sensor's thread publishes.
  ChannelMask channels_of(unsigned sensor_thread) const;

private:
  void load_rules(unsigned behavior);
  void note_timers(const vm::Rule& rule);
};

// What the verifier's limits do not say: channels, variables, rules, threads and their stacks.
[[nodiscard]] vm::Verdict fits(const vm::Image& image);

// The name at `offset` of the strings, for reports; `otherwise` when there is none.
const char* name_of(const vm::Image& image, std::uint16_t offset, const char* otherwise);

}  // namespace robosync::layers
