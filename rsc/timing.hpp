// What a program costs on the board: instructions per step, rule by rule, and memory.
//
// The verifier's own pass counts the instructions in the image (vm/cost.hpp); they are not cycles.
// Images must be verified.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/report.hpp"
#include "rsc/board.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"
#include "runtime-m4/policy/memory.hpp"
#include "vm/cost.hpp"
#include "vm/image.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {

struct RuleTiming {
  std::size_t number = 0;  // in the image
  vm::RuleKind kind{};
  std::uint16_t line = 0;
  vm::RuleCost cost;
  bool else_is_worst = false;
  std::uint16_t response_line = 0;  // of the worse response; 0: none, or not known
};

struct BehaviorTiming {
  std::string_view name;  // empty: a rule outside a BEHAVIOR
  int priority = 0;       // vm::kSafetyPriority: the SAFETY rules
  std::vector<RuleTiming> rules;
  std::uint32_t step = 0;       // instructions
  std::size_t frame_bytes = 0;  // of its cells
  std::size_t stack_bytes = 0;  // of its thread; 0: the safety monitor runs it on its own
};

// How much the program takes of what the board has.
struct Share {
  std::string_view what, unit;
  std::size_t used = 0, limit = 0;
};

struct Timing {
  std::vector<BehaviorTiming> behaviors;  // in the order of the source, as their rules
  std::vector<SectionSize> sections;      // of the image that rsc upload sends
  Share step;
  std::vector<Share> memory;
};

[[nodiscard]] Timing timing_of(const vm::Image& image,
                               const policy::BoardMemory& board = board_memory());

// For people, whole lines. `file` names the program.
[[nodiscard]] std::string timing_text(const Timing& timing, const std::string& file);
[[nodiscard]] Json timing_json(const Timing& timing, const std::string& file);

// As response_report() takes it: the priority that the program's behaviours may adapt to; 0: none.
[[nodiscard]] int cap_of(const vm::Image& image);

// The response times: a table, whole lines, and the same as JSON.
[[nodiscard]] std::string response_text(const analysis::ResponseReport& report);
[[nodiscard]] Json response_json(const analysis::ResponseReport& report);
// Why the board cannot keep up with a program: what is too much, then what costs most, and how to fix it.
struct Overload {
  std::string what;  // empty: it can
  std::vector<std::string> why;
};
[[nodiscard]] Overload overload_of(const analysis::ResponseReport& report);

// What is wrong with a program whose step costs more than `budget`: the rules that cost most with their
// lines, and what would make them cheaper.
[[nodiscard]] std::string too_costly_text(const vm::Image& image, std::uint32_t budget);
// Why the board would refuse the program: one of those, or the verifier's reason with its place.
[[nodiscard]] std::string refusal_text(const vm::Image& image, const vm::Verdict& verdict,
                                       const policy::BoardMemory& board = board_memory());

}  // namespace robosync::tool
