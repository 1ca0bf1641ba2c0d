// See workspace.hpp.
#include "runtime-m4/layers/workspace.hpp"

namespace robosync::layers {

void Workspace::start(Memory& memory) {
  using policy::Part;
  cells = memory.take<Part::cells, std::uint32_t>();
  timer_words = memory.take<Part::timer_words, std::uint32_t>();
  due = memory.take<Part::due, std::uint32_t>();
  noted = memory.take<Part::noted, RuleBits::Word>();
  judgements = memory.take_zero<Part::judgements, Judgement>();
  output = memory.take<Part::output, vm::Word>();
  result = memory.take_zero<Part::result, Result>().data();
  finished = memory.take_zero<Part::finished, std::atomic<bool>>().data();
}

}  // namespace robosync::layers
