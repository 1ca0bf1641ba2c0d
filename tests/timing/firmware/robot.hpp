// A program on the board without the runtime around it: its frames, timer memory and the places
// where its responses wait, so that every entry into the VM can be counted by itself.
//
// A step is what the step budget is about: the conditions of all rules, then of each rule that does
// something, one response, from its start or from where it waits. Images must be verified, and have
// at most kMostRules rules.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tests/timing/firmware/block.hpp"
#include "vm/image.hpp"
#include "vm/interpreter.hpp"

namespace robosync::timing {

class Robot {
public:
  static constexpr std::size_t kMostRules = 1024;

  // The program starts: nothing is known, variables have their first values.
  void start(const vm::Image& image);

  [[nodiscard]] std::size_t inputs() const {
    return image_.channels.size() + image_.variables.size();
  }
  void set_input(std::size_t input, vm::Value value) { inputs_[input] = value; }

  // The first half of a step, at program time `now`.
  void evaluate(std::uint32_t now);
  // The second half: for each rule in turn, skip() or respond().
  void skip(std::size_t rule);
  void respond(std::size_t rule, Run run);

  [[nodiscard]] bool has(std::size_t rule, Run run) const;

private:
  void latch(std::size_t behavior, std::uint32_t now);

  vm::Image image_;
  std::array<vm::Value, vm::kMaxInputs> inputs_;
  std::array<vm::Value, vm::kMaxBehaviors*(vm::kMaxCells + std::size_t{1})> cells_;
  std::array<std::uint32_t, 4096> timer_memory_;
  std::array<vm::Machine, vm::kMaxBehaviors> machines_;
  std::array<std::uint8_t, kMostRules> behavior_of_;
  std::array<const vm::Word*, kMostRules> places_;  // where its response waits, or null
  std::array<vm::Word, vm::kMaxResponseOutput> output_;
};

}  // namespace robosync::timing
