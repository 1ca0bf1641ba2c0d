// See adaptation.hpp. May rely on the verifier: a window is never 0, and priorities fit in a byte.
#include "runtime-m4/layers/adaptation.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace robosync::layers {

using kernel::Priority;

void Adaptation::start(Memory& memory) {
  triggers_ = memory.take<policy::Part::trigger_counts, policy::TriggerCount>();
  end_ = kNever;
}

void Adaptation::count(const LoadedProgram& program, unsigned behavior, std::uint32_t now) {
  if (program.image.adaptations.empty()) return;
  policy::TriggerCount& triggers = triggers_[behavior];
  if (triggers != policy::kMostTriggers) ++triggers;
  if (end_ == kNever) end_ = end_after(program, now);
}

std::uint32_t Adaptation::end_after(const LoadedProgram& program, std::uint32_t now) {
  const std::uint32_t window = program.image.adaptations.front().window_ms;
  return now - now % window + window;
}

void Adaptation::turn(const LoadedProgram& program, ProgramThreads& threads, Trace& trace,
                      std::uint32_t now) {
  if (end_ == kNever || !reached(end_, now)) return;
  const bool counted = rank(program, threads, trace);
  end_ = counted ? end_after(program, now) : kNever;
}

// The SAFETY rules count as a behaviour without triggers. Every thread is ranked again, in the
// order of age, so equals keep their original order.
bool Adaptation::rank(const LoadedProgram& program, ProgramThreads& threads, Trace& trace) {
  const policy::AdaptationRule rule = policy::adaptation_of(program.image);
  const std::int8_t idle = policy::idle_priority(program.image);
  const auto worth = [&](unsigned b) {
    const auto base = static_cast<std::int8_t>(program.image.behaviors[b].priority);
    return policy::adapted(base, triggers_[b], rule);
  };
  threads.rank([&](const kernel::Thread& thread, unsigned index) {
    Priority highest{idle, idle};
    for (BehaviorMask left = program.needing(thread.category(), index); left != 0; left &= left - 1)
      highest = std::max(highest, worth(static_cast<unsigned>(std::countr_zero(left))));
    const bool changes = thread.category() == kernel::Category::behavior && end_ != kNever &&
                         thread.priority() != highest;
    if (changes) trace.emit(link::EventKind::priority, trace.now(), index, 0, highest.now);
    return highest;
  });
  unsigned counted = 0;
  for (policy::TriggerCount& triggers : triggers_)
    counted |= std::exchange(triggers, policy::TriggerCount{0});
  return counted != 0;
}

}  // namespace robosync::layers
