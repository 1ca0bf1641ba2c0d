// Lets a privileged thread call a function that runs unprivileged. The function may write one window of memory, which
// includes its stack. sandbox.S implements it.
//
// Only for the thread of the highest rank, which no other thread preempts: a switch does not save CONTROL for a privileged
// thread. One sandbox is in use at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::port {

class Sandbox {
public:
  // May read what unprivileged threads may read or write (Areas). Do not trust its result.
  using Function = std::int32_t (*)(void*, const void*, void*);

  // The window must fit two regions of the MPU (policy::regions::finest_window), else nothing is open. The stack ends at
  // `stack_top`, inside the window, aligned to 8.
  void set(std::span<std::byte> window, std::byte* stack_top, Function function);
  // Any other access is a fault of the calling thread; so is an exception in the function.
  std::int32_t call(void* first, const void* second, void* third) const;

private:
  // sandbox.S loads these in this order: base and size of the MPU's regions 5 and 6.
  std::uint32_t lower_base_ = 0, lower_size_ = 0, upper_base_ = 0, upper_size_ = 0;
  std::byte* stack_top_ = nullptr;
  Function function_ = nullptr;
};

}  // namespace robosync::port

extern "C" std::int32_t robosync_call_in_sandbox(void* first, const void* second, void* third,
                                                 const robosync::port::Sandbox* sandbox);

namespace robosync::port {

inline std::int32_t Sandbox::call(void* first, const void* second, void* third) const {
  return robosync_call_in_sandbox(first, second, third, this);
}

}  // namespace robosync::port
