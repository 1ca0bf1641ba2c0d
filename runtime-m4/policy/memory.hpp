// The memory that a program needs on a board, computed from its image. Pure. The board lays out its
// memory with it (layers/memory.hpp) and refuses programs that do not fit; rsc reports the same earlier.
//
// A board has one block of memory for programs, its arena. It is filled from both ends:
//
//   | open parts | image | writable parts |    room for the next image    | closed parts |
//
// The behaviours' threads may read the open parts and the image. The MPU opens memory in eighths of
// powers of two (regions.hpp). So the writable parts begin and end at an eighth, and the region that
// covers the open parts may extend into the room, but never into the closed parts. The wasted bytes
// are counted, because the arena's address is known. Images are verified.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/policy/concern.hpp"
#include "runtime-m4/policy/regions.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "runtime-m4/policy/threads.hpp"
#include "vm/image.hpp"
#include "vm/opcode_traits.hpp"
#include "vm/timers.hpp"
#include "vm/verifier.hpp"

namespace robosync::policy {

// What a board provides for programs: stdlib/boards/NAME.json.
struct BoardMemory {
  std::uint32_t arena_begin = 0;  // its address
  std::uint32_t arena_bytes = 0;
  std::uint32_t step_budget = 0;  // M4 instructions of VM code in one step
};

// The safety monitor, the link and the step.
inline constexpr unsigned kFixedThreads = 3;

// Stacks, in bytes, including the guard. On every board they hold the deepest call path of the linked
// code plus the frame of an interrupt (tests/e2e/test_stack_depth.py).
inline constexpr std::uint32_t kSensorStack = 576;
inline constexpr std::uint32_t kStepStack = 704;
inline constexpr std::uint32_t kBehaviorStack = 320;  // no guard
inline constexpr std::uint32_t kControlStack = 512;
// An algorithm has its own region, for its module's data and stack, and more if its record says so. At least kModuleStack bytes of it
// are stack.
inline constexpr std::uint32_t kAlgorithmStack = 1024;
inline constexpr std::uint32_t kModuleStack = 768;
inline constexpr std::uint32_t kStackUnit = 64;  // of unprivileged stacks
// For SAFETY's bytecode, and the machine that runs it.
inline constexpr std::uint32_t kSafetyStack = 160;
inline constexpr std::uint32_t kSafetyMachine = 96;

inline constexpr std::uint32_t kFeeds = 40;  // readings that wait for their time
// Sets of rules that the triggers keep.
inline constexpr unsigned kTriggerSets = 3;
inline constexpr unsigned kRunningSets = 4;
inline constexpr unsigned kSides = 2;  // of a rule: DO and ELSE

// Words of a set of rules (layers/rule_set.hpp): one bit per rule.
constexpr std::uint32_t set_words(std::uint32_t rules) {
  return (rules + 31) / 32;
}
// Words of the set of rules that is kept per input. If it has several words, a summary word precedes
// them, which tells which of them are not 0.
constexpr std::uint32_t reader_words(std::uint32_t rules) {
  const std::uint32_t words = set_words(rules);
  return words > 1 ? 1 + words : words;
}

// The limits of the layers' masks and sets: the bits of a word (layers/messages.hpp), and 32 words
// under a summary word (layers/rule_set.hpp).
inline constexpr unsigned kMaxChannels = 32;
inline constexpr unsigned kMaxVariables = 32;
inline constexpr unsigned kMaxRules = 32 * 32;

// What memory.def counts in an image.
enum class Count : std::uint32_t {
  one,
  sensors,
  sensor_threads,
  algorithms,
  algorithm_bytes,  // of their regions, and of what lies between them
  channels,
  feeds,
  inputs,
  variables,
  fading,
  checks,
  samples,
  behaviors,
  behavior_threads,
  cells,
  timer_words,
  safety_cells,
  safety_timer_words,
  safety_output,
  safety_bytes,
  tripped_words,
  rules,
  watching_rules,  // all rules if one is a WATCH, otherwise none
  polling_rules,   // all rules if a response has a WAIT UNTIL or a FOLLOW, otherwise none
  delaying_rules,  // all rules if one has delays, otherwise none
  delays,
  comparisons,
  set_words,
  reader_words,
  actuators,
  commands,
  count_
};

class Counts {
public:
  constexpr std::uint32_t operator[](Count count) const { return counts_[place(count)]; }
  constexpr std::uint32_t& operator[](Count count) { return counts_[place(count)]; }
  constexpr std::uint32_t threads() const {
    return (*this)[Count::sensor_threads] + (*this)[Count::algorithms] +
           (*this)[Count::behavior_threads] + (*this)[Count::actuators] + kFixedThreads;
  }

private:
  static constexpr std::size_t place(Count count) { return static_cast<std::size_t>(count); }

  std::array<std::uint32_t, static_cast<std::size_t>(Count::count_)> counts_{1};
};

// Words of timer memory that SAFETY rules use. They are the first ones, because timers are numbered in
// the order of the code, and SAFETY's code comes first.
inline unsigned safety_timer_words(const vm::Image& image) {
  unsigned words = 0;
  const vm::Behavior& safety = image.behaviors[vm::kSafetyBehavior];
  for (const vm::Rule& rule : image.rules.subspan(safety.first_rule, safety.rule_count))
    for (const vm::Word word : image.code.subspan(rule.condition_start, rule.condition_length)) {
      if (vm::traits_of(word).operand(2) != vm::Operand::timer) continue;
      const vm::Timer& timer = image.timers[vm::operand_c(word)];
      words = timer.state + vm::timer_words(timer);
    }
  return words;
}

// Does a response wait for a condition?
inline bool polls(const vm::Image& image) {
  return std::ranges::any_of(image.code,
                             [](vm::Word word) { return vm::opcode_of(word) == vm::Opcode::poll; });
}

// SAFETY's bytecode writes to one window. The parts before it end at a multiple of kStackUnit.
constexpr regions::Fit safety_window(const Counts& counts) {
  return regions::fit_anywhere(kSafetyStack + kSafetyMachine +
                               4 * (counts[Count::safety_cells] +
                                    counts[Count::safety_timer_words] +
                                    counts[Count::safety_output]));
}
constexpr std::uint32_t safety_bytes(const Counts& counts) {
  const regions::Fit window = safety_window(counts);
  return window.bytes + std::max(window.alignment, kStackUnit) - kStackUnit;
}

inline void count_sensors(const vm::Image& image, Counts& counts) {
  std::uint32_t fed_channels = 0;
  std::uint32_t fed_sensors = 0;
  counts[Count::sensors] = static_cast<std::uint32_t>(image.sensors.size());
  counts[Count::channels] = static_cast<std::uint32_t>(image.channels.size());
  for (const vm::Sensor& sensor : image.sensors)
    if (is_algorithm(sensor)) {
      ++counts[Count::algorithms];
    } else if (is_fed(sensor)) {
      fed_channels += sensor.channel_count;
      ++fed_sensors;
    } else {
      ++counts[Count::sensor_threads];
    }
  if (counts[Count::algorithms] != 0) ++counts[Count::sensor_threads];  // one for all of them
  if (fed_sensors == 0) return;
  ++counts[Count::sensor_threads];  // one for all of them
  counts[Count::feeds] = std::max(kFeeds, fed_channels);
}

inline void count_variables(const vm::Image& image, Counts& counts) {
  counts[Count::variables] = static_cast<std::uint32_t>(image.variables.size());
  counts[Count::inputs] = counts[Count::channels] + counts[Count::variables];
  counts[Count::checks] = static_cast<std::uint32_t>(image.checks.size());
  for (const vm::Variable& variable : image.variables)
    if (variable.fade != 0) ++counts[Count::fading];
  for (const vm::Check& check : image.checks)
    if (check.window > 1) counts[Count::samples] += check.window;
}

inline void count_behaviors(const vm::Image& image, Counts& counts) {
  counts[Count::behaviors] = static_cast<std::uint32_t>(image.behaviors.size());
  counts[Count::behavior_threads] = counts[Count::behaviors];
  counts[Count::rules] = static_cast<std::uint32_t>(image.rules.size());
  counts[Count::set_words] = set_words(counts[Count::rules]);
  bool watches = false;
  for (const vm::Rule& rule : image.rules) {
    watches |= rule.kind == vm::RuleKind::watch;
    if (has_delays(rule)) ++counts[Count::delays];
  }
  if (watches) counts[Count::watching_rules] = counts[Count::rules];
  if (polls(image)) counts[Count::polling_rules] = counts[Count::rules];
  if (counts[Count::delays] != 0) counts[Count::delaying_rules] = counts[Count::rules];
  for (const vm::Behavior& behavior : image.behaviors)
    counts[Count::cells] += behavior.cells;
  for (const vm::Timer& timer : image.timers)
    counts[Count::timer_words] += vm::timer_words(timer);
  each_comparison(image, [&](unsigned, unsigned) { ++counts[Count::comparisons]; });
  if (!image.has_safety()) return;
  counts[Count::behavior_threads] -= 1;
  counts[Count::safety_cells] = image.behaviors[vm::kSafetyBehavior].cells;
  counts[Count::safety_timer_words] = safety_timer_words(image);
  counts[Count::safety_output] = vm::kMaxResponseOutput;
  counts[Count::safety_bytes] = safety_bytes(counts);
  counts[Count::tripped_words] = counts[Count::set_words];
  counts[Count::cells] -= counts[Count::safety_cells];
  counts[Count::timer_words] -= counts[Count::safety_timer_words];
}

// The regions of the algorithms lie at the arena's end, the first one highest, each where eighths of one region of the MPU cover
// exactly it. Calls place(sensor, address, bytes) for each; returns the address of the lowest.
template <class Place>
std::uint32_t place_algorithms(const vm::Image& image, const BoardMemory& board, Place place) {
  std::uint32_t end = board.arena_begin + board.arena_bytes;
  for (std::size_t s = 0; s < image.sensors.size(); ++s) {
    if (!is_algorithm(image.sensors[s])) continue;
    const regions::Seat seat =
        regions::highest_seat(end, kAlgorithmStack * (1U + image.sensors[s].room));
    place(s, seat.begin, seat.bytes);
    end = seat.begin;
  }
  return end;
}

inline void count(const vm::Image& image, Counts& counts) {
  count_sensors(image, counts);
  count_variables(image, counts);
  count_behaviors(image, counts);
  counts[Count::reader_words] = counts[Count::inputs] * reader_words(counts[Count::rules]);
  counts[Count::actuators] = static_cast<std::uint32_t>(image.actuators.size());
  counts[Count::commands] = vm::max_queued(counts[Count::actuators]);
}

// --- the parts ---

enum class Region : std::uint32_t { open, writable, closed };
enum class Whose : std::uint32_t {
  program,
  sensors,
  actuators,
  behaviors,
  rules,
  variables,
  algorithms,
  image,
  borders,  // what the MPU's eighths waste
  count_
};
inline constexpr std::size_t kWhose = static_cast<std::size_t>(Whose::count_);

enum class Part : std::uint8_t {
#define PART(name, region, whose, bytes, each, count, doc) name,
#include "runtime-m4/policy/memory.def"
#undef PART
  count_
};

inline constexpr std::uint32_t kThreadBytes = 72;

// Packed, because the table is also on the board.
struct PartInfo {
  Region region : 2;
  Whose whose : 4;
  std::uint32_t bytes : 12;  // of one, on the Cortex-M4
  std::uint32_t each : 8;
  Count count : 6;
};
static_assert(sizeof(PartInfo) == 4);
inline constexpr std::array<PartInfo, static_cast<std::size_t>(Part::count_)> kParts = {{
#define PART(name, region, whose, bytes, each, count, doc) \
  {Region::region, Whose::whose, bytes, each, Count::count},
#include "runtime-m4/policy/memory.def"
#undef PART
}};
constexpr const PartInfo& info_of(Part part) {
  return kParts[static_cast<std::size_t>(part)];
}

constexpr std::uint32_t count_of(Part part, const Counts& counts) {
  return info_of(part).each * counts[info_of(part).count];
}

// Rounds up to a multiple of `alignment`, a power of two.
constexpr std::uint32_t aligned(std::uint32_t bytes, std::uint32_t alignment) {
  return (bytes + alignment - 1) & ~(alignment - 1);
}
inline constexpr std::uint32_t kPartUnit = 8;
constexpr std::uint32_t bytes_of(Part part, const Counts& counts) {
  return aligned(info_of(part).bytes * count_of(part, counts), kPartUnit);
}

// --- what a program needs ---

struct Needs {
  Counts counts;
  std::uint32_t open = 0, image = 0;               // bytes, from the arena's beginning
  std::uint32_t writable_begin = 0, writable = 0;  // place in the arena, and bytes
  std::uint32_t closed = 0;                        // bytes, at the arena's end
  std::uint32_t total = 0;

  bool fit(const BoardMemory& board) const { return total <= board.arena_bytes; }
};

// Places the writable parts behind the image, in the finest window of two regions that covers them.
inline void place_writable(const BoardMemory& board, std::uint32_t bytes, Needs& needs) {
  const std::uint32_t from = board.arena_begin + needs.open + needs.image;
  for (unsigned bits = regions::kSmallest; bits < regions::kLargest; ++bits) {
    const std::uint32_t eighth = (1U << bits) / regions::kEighths;
    const std::uint32_t begin = aligned(from, eighth);
    needs.writable_begin = begin - board.arena_begin;
    needs.writable = aligned(bytes, eighth);
    if (regions::fits_window(begin, needs.writable, bits)) return;
  }
}

// The end in the arena of the region that covers the open parts and the image.
inline std::uint32_t end_of_cover(const BoardMemory& board, const Needs& needs) {
  const std::uint32_t end = board.arena_begin + needs.open + needs.image;
  const unsigned bits = regions::cover_bits(board.arena_begin, end);
  return aligned(end, (1U << bits) / regions::kEighths) - board.arena_begin;
}

inline void count_needs(const vm::Image& image, const BoardMemory& board, Needs& needs) {
  needs = {};
  count(image, needs.counts);
  needs.counts[Count::algorithm_bytes] =
      board.arena_begin + board.arena_bytes -
      place_algorithms(image, board, [](std::size_t, std::uint32_t, std::uint32_t) {});
  std::uint32_t writable = 0;
  for (std::size_t p = 0; p < kParts.size(); ++p) {
    const std::uint32_t bytes = bytes_of(static_cast<Part>(p), needs.counts);
    switch (kParts[p].region) {
      case Region::open:
        needs.open += bytes;
        break;
      case Region::writable:
        writable += bytes;
        break;
      case Region::closed:
        needs.closed += bytes;
        break;
    }
  }
  needs.image = aligned(image.header->total_length, kPartUnit);
  needs.closed = aligned(needs.closed, kStackUnit);
  place_writable(board, writable, needs);
  needs.total =
      std::max(needs.writable_begin + needs.writable, end_of_cover(board, needs)) + needs.closed;
}

// Whether the layers' masks and sets and the kernel can hold the program that `needs` was counted
// from, and whether it fits the board's memory.
inline vm::Verdict judge(const Needs& needs, const BoardMemory& board) {
  const auto refuse = [](vm::Section section, std::size_t most) {
    return vm::Verdict{vm::Refusal::too_many, section, static_cast<std::uint16_t>(most)};
  };
  const Counts& counts = needs.counts;
  if (counts[Count::channels] > kMaxChannels) return refuse(vm::Section::channels, kMaxChannels);
  if (counts[Count::variables] > kMaxVariables)
    return refuse(vm::Section::variables, kMaxVariables);
  if (counts[Count::rules] > kMaxRules) return refuse(vm::Section::rules, kMaxRules);
  if (counts.threads() > kMaxThreads) return refuse(vm::Section::header, kMaxThreads);
  if (!needs.fit(board)) return {vm::Refusal::no_room, vm::Section::header, 0};
  return {};
}

inline Needs needs_of(const vm::Image& image, const BoardMemory& board) {
  Needs needs;
  count_needs(image, board, needs);
  return needs;
}

// The bytes by what takes them, for reports.
inline std::array<std::uint32_t, kWhose> shares_of(const Needs& needs) {
  std::array<std::uint32_t, kWhose> shares{};
  const auto share = [&](Whose whose) -> std::uint32_t& {
    return shares[static_cast<std::size_t>(whose)];
  };
  std::uint32_t parts = needs.image;
  for (std::size_t p = 0; p < kParts.size(); ++p) {
    const std::uint32_t bytes = bytes_of(static_cast<Part>(p), needs.counts);
    share(kParts[p].whose) += bytes;
    parts += bytes;
  }
  share(Whose::image) = needs.image;
  share(Whose::borders) = needs.total - parts;
  return shares;
}

}  // namespace robosync::policy
