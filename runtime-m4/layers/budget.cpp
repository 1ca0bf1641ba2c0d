// See budget.hpp.
#include "runtime-m4/layers/budget.hpp"

namespace robosync::layers {

namespace {

using kernel::Category;
using kernel::Thread;

// The thread that would run now but for safety.
Thread* first_ready(const kernel::Kernel& kernel) {
  for (Thread* const thread : kernel.threads())
    if (thread->category() != Category::safety && kernel.state(*thread) == Thread::State::ready)
      return thread;
  return nullptr;
}

}  // namespace

Thread* Budget::look(const kernel::Kernel& kernel) {
  Thread* const first = first_ready(kernel);
  if (first == nullptr || first->category() != Category::behavior) {
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
  return run_time - run_time_ > kCounts ? first : nullptr;
}

}  // namespace robosync::layers
