// All that the behaviours' threads write, in one place: they run without privileges, and besides
// their stacks this is the only memory that they may write. Others read what stands here as they would
// read what comes from outside: numbers, of which none is an index or an address until it is
// checked.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/rule_set.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

// What is known of a rule's condition, and what follows from that (triggers.hpp).
enum class Truth : std::uint8_t { unknown, no, yes };
enum class Trigger : std::uint8_t { none, otherwise, then };
struct Judgement {
  Truth truth : 2 = Truth::unknown;
  Trigger trigger : 2 = Trigger::none;
  bool event : 1 = false;
  bool zero_divide : 1 = false;
};
static_assert(sizeof(Judgement) == 1);

// What came of a response that was run. All zero at first, so that it takes no flash. No bools: one
// that somebody has set to 2 is undefined behaviour where it is read.
struct Result {
  static constexpr std::uint8_t kBegan = 1;
  static constexpr std::uint8_t kWentOn = 2;  // in its behaviour's turn

  const vm::Word* next = nullptr;  // vm::Progress
  std::uint32_t wake = 0;
  vm::Pause pause = vm::Pause::ended;
  std::uint8_t zero_divide = 0;
  std::uint16_t rule = 0;      // whose response it was
  std::uint32_t assigned = 0;  // vm::Machine
  std::uint32_t shifted = 0;
  std::uint16_t words = 0;  // of the output
  std::uint8_t there = 0;   // there is a result, since the behaviour was released: kBegan, kWentOn
  std::uint8_t side = 0;    // … of which side of the rule
};

// Where it stands, for a program.
struct Workspace {
  void start(Memory& memory);

  std::span<std::uint32_t> cells;        // the behaviours' frames, one behind the other
  std::span<std::uint32_t> timer_words;  // states of their timers
  std::span<std::uint32_t> due;          // when it is to be evaluated again; of EVERY, the end
  std::span<Judgement> judgements;
  std::span<RuleBits::Word> noted;  // rules from whose evaluation in this turn something follows
  std::span<vm::Word> output;       // one response runs at a time, so one is enough
  Result* result = nullptr;
  // The behaviour that was released has done what it was released for.
  std::atomic<bool>* finished = nullptr;
};

}  // namespace robosync::layers
