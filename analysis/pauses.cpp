// See pauses.hpp. Before a pause can end again, either its response has begun anew and has reached
// it, or a loop has come round: the shortest of these ways counts, with all the waits on it.
#include "analysis/pauses.hpp"

#include <algorithm>
#include <vector>

#include "analysis/response_time.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "vm/opcode.hpp"

namespace robosync::analysis {
namespace {

constexpr unsigned kMostApart = 4;  // each becomes a source, with all that follows it

unsigned line_of(const vm::Image& image, std::size_t word) {
  unsigned line = 0;
  for (const vm::SourceLine& entry : image.source_lines)
    if (entry.word <= word) line = entry.line;
  return line;
}

}  // namespace

void Pauses::note(std::uint32_t ms) {
  least_ms = std::min(least_ms, ms);
  others_ms = std::min(others_ms, ms);
}

// The runtime sees to it that a round without a pause is not followed by the next one sooner than kLeastPauseMs.
void Pauses::note_end(std::uint64_t waited_ms) {
  const auto waited = static_cast<std::uint32_t>(std::min<std::uint64_t>(waited_ms, kNever));
  round_ms = std::min(round_ms, waited == 0 ? policy::kLeastPauseMs : waited);
}

void Pauses::note(const Pauses& other) {
  least_ms = std::min(least_ms, other.least_ms);
  others_ms = std::min(others_ms, other.others_ms);
  at_once += other.at_once;
  again_ms = std::min(again_ms, other.again_ms);
  round_ms = std::min(round_ms, other.round_ms);
  if (line == kNoLine) line = other.line;
}

bool Pauses::better_apart() const {
  return at_once != 0 && at_once <= kMostApart &&
         std::uint64_t{at_once} * others_ms + again_ms < std::uint64_t{again_ms} * others_ms;
}

Pauses pauses_of(const vm::Image& image, const vm::Behavior& behavior, const vm::Response& response,
                 const Ranges& inputs) {
  const auto code = image.code.subspan(response.start, response.length);
  Pauses pauses;
  std::vector<Instructions> waited(code.size());  // … in ms, on arrival there
  std::vector<Instructions> again(code.size());   // for those that may be over immediately; else 0
  for (Walk walk(image, behavior, code, inputs); walk.next(); walk.run()) {
    const std::size_t at = walk.at();
    const vm::Flow flow = vm::info_of(vm::opcode_of(code[at])).flow;
    waited[at] = walk.waited_ms();
    if (vm::always_pauses(flow)) {
      const std::uint32_t least = least_wait_ms(code[at], walk.cells());
      if (least > 1) {
        pauses.note(least);
      } else {
        pauses.least_ms = 1;
        ++pauses.at_once;
        again[at] = waited[at] + 1;
        if (pauses.line == Pauses::kNoLine && walk.cells()[vm::operand_a(code[at])].low <= 0)
          pauses.line = line_of(image, response.start + at);
      }
    }
    if (flow == vm::Flow::end) pauses.note_end(waited[at]);
    if (!vm::ends_loop(flow)) continue;
    const std::size_t begin = at + 1 - std::min<std::size_t>(vm::operand_wide(code[at]), at + 1);
    const Instructions round = std::max<Instructions>(waited[at] - waited[begin], 1);
    for (std::size_t i = begin; i < at; ++i)
      again[i] = std::min(again[i], round);
  }
  for (const Instructions ms : again)
    if (ms != 0)
      pauses.again_ms = static_cast<std::uint32_t>(std::min<Instructions>(pauses.again_ms, ms));
  return pauses;
}

}  // namespace robosync::analysis
