// See budget.hpp.
#include "runtime-m4/layers/budget.hpp"

namespace robosync::layers {

namespace {

using kernel::Category;
using kernel::Thread;

// The highest behaviour that would run now. Threads that outrank it may be ready, too: this looks at the
// ticks at which setpoints and samples are due.
Thread* first_ready(const kernel::Kernel& kernel) {
  for (Thread* const thread : kernel.threads())
    if (thread->category() == Category::behavior && kernel.state(*thread) == Thread::State::ready)
      return thread;
  return nullptr;
}

}  // namespace

Thread* Budget::look(const kernel::Kernel& kernel) {
  Thread* const first = first_ready(kernel);
  if (first == nullptr) {
    forget();
    return nullptr;
  }
  const std::uint32_t run_time = kernel.run_time(*first);
  if (first != suspect_ || first->activations() != activations_) {
    suspect_ = first;
    activations_ = first->activations();
    run_time_ = run_time;
    return nullptr;
  }
  return run_time - run_time_ > counts_ ? first : nullptr;
}

}  // namespace robosync::layers
