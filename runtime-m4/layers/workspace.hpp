// All that the behaviours' threads write, in one place. They run unprivileged, and besides their stacks
// this is the only memory that they may write. Others treat its contents like outside input: numbers,
// none of which is used as an index or an address before it is checked.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/rule_set.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

// What is known of a rule's condition, and what follows from it (triggers.hpp).
enum class Truth : std::uint8_t { unknown, no, yes };
enum class Trigger : std::uint8_t { none, otherwise, then };
struct Judgement {
  Truth truth : 2 = Truth::unknown;
  Trigger trigger : 2 = Trigger::none;
  bool event : 1 = false;
  bool zero_divide : 1 = false;
};
static_assert(sizeof(Judgement) == 1);

// The outcome of a response. All zero at first, so that it takes no flash. No bools: reading a bool
// that a thread has set to 2 is undefined behaviour.
struct Result {
  static constexpr std::uint8_t kBegan = 1;
  static constexpr std::uint8_t kWentOn = 2;  // in its behaviour's turn

  const vm::Word* next = nullptr;  // vm::Progress
  std::uint32_t wake = 0;
  vm::Pause pause = vm::Pause::ended;
  std::uint8_t zero_divide = 0;
  std::uint16_t rule = 0;      // whose response it was
  std::uint32_t assigned = 0;  // as in vm::Machine
  std::uint32_t shifted = 0;
  std::uint16_t words = 0;  // of the output
  std::uint8_t there = 0;   // kBegan or kWentOn: there is a result of this release
  std::uint8_t side = 0;    // … of which side of the rule
};

// The parts of the workspace, for a program.
struct Workspace {
  void start(Memory& memory);

  std::span<std::uint32_t> cells;        // the behaviours' frames, in order
  std::span<std::uint32_t> timer_words;  // states of their timers
  std::span<std::uint32_t> due;  // when to evaluate a rule again; for EVERY, the end of its period
  std::span<Judgement> judgements;
  std::span<RuleBits::Word> noted;  // rules whose evaluation in this turn has consequences
  std::span<vm::Word> output;       // one response runs at a time, so one is enough
  Result* result = nullptr;
  // The released behaviour has finished its task.
  std::atomic<bool>* finished = nullptr;
};

}  // namespace robosync::layers
