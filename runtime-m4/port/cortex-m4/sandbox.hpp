// Lets a thread with privileges run a function without them, in the midst of its own work: with one window of memory
// that it may write, its stack included. sandbox.S is how.
//
// Only for the thread of the highest rank, which no other comes between: the core's rights are not part of what a switch
// keeps of a thread with privileges. One sandbox is in use at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::port {

class Sandbox {
public:
  // Reads what threads without privileges may read, or may write (Areas). What it returns is not to be believed.
  using Function = std::int32_t (*)(void*, const void*, void*);

  // The window must be one of two regions of the MPU (policy::regions::finest_window), else nothing is open. The stack
  // ends at `stack_top`, inside of it, aligned to 8.
  void set(std::span<std::byte> window, std::byte* stack_top, Function function);
  // An access to anything else is a fault of the calling thread; so is an exception in it.
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
