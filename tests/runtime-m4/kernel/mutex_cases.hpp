// The guarantees of a mutex with a ceiling, as cases that run on the host (mutex_test.cpp) and on the
// board (firmware/mutex.cpp): the six in which priority inheritance goes wrong in other kernels
// (../docs/kernel.md), and a mutex whose holder is stopped.
#pragma once

#include <span>

#include "runtime-m4/kernel/kernel.hpp"

namespace mutex_cases {

// The environment of a case.
class Stage {
public:
  explicit Stage(robosync::kernel::Kernel& its_kernel) : kernel(its_kernel) {}
  // Starts thread `index` (0 … 3), above the one that runs the case; `entry` gets the stage.
  virtual robosync::kernel::Thread& start(unsigned index, robosync::kernel::Category category,
                                          std::int16_t priority, void (*entry)(void*)) = 0;
  virtual void run() = 0;  // until all threads wait or have ended

  robosync::kernel::Kernel& kernel;

protected:
  ~Stage() = default;
};

struct Case {
  const char* name;
  void (*run)(Stage& stage);
  const char* expected;  // what the threads note, in this order
};

inline constexpr std::size_t kCount = 9;
std::span<const Case, kCount> all();
// Runs a case; true if the threads' notes are as expected; otherwise `noted` has them.
bool passes(const Case& example, Stage& stage);
const char* noted();

}  // namespace mutex_cases
