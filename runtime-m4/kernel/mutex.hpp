// A mutex for resources that take long to use, such as a bus. For a few words, Kernel::lock() is
// cheaper. Immediate priority ceiling: the holder runs at the rank of the highest thread that may
// ever want the mutex (the ceiling).
//
// So a thread never waits for a mutex: while one is held, no other thread that may want it runs; when
// such a thread runs, the mutex is free. There is no queue of waiters, no inheritance and no
// deadlock. A thread is delayed by at most one holder, before it starts.
//
// The users are the threads of a category, and any that rank below the highest of these. So the
// ceiling is known when a program is loaded, and stays right when threads change their ranks. A
// thread above the ceiling that tries to take a held mutex is stopped. The holder must not wait or
// sleep. It may hold several mutexes, and release them in any order. They are released for it when it
// is stopped (a fault) or removed.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime-m4/kernel/scheduler.hpp"

namespace robosync::kernel {

class Kernel;
class Thread;

class Mutex {
public:
  explicit constexpr Mutex(Category highest) : highest_(highest) {
    static_assert(offsetof(Mutex, owner_) == 0, "the context switch reads it (switch.S)");
  }
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;

  bool held() const { return owner_ != nullptr; }

private:
  friend class Kernel;

  // Removes the mutex that `link` points at from the list of held mutexes.
  static void take_out(Mutex*& link) {
    Mutex& mutex = *link;
    mutex.owner_ = nullptr;
    link = mutex.below_;
    mutex.below_ = nullptr;
    mutex.not_alone_ = false;
  }

  Thread* owner_ = nullptr;
  Mutex* below_ = nullptr;  // the latest mutex that was held when this one was taken
  Category highest_;
  bool not_alone_ = false;  // another mutex is held, or has been since this one was taken
};

// Holds a mutex for its own lifetime.  [thread]
class MutexGuard {
public:
  MutexGuard(Kernel& kernel, Mutex& mutex);
  ~MutexGuard();
  MutexGuard(const MutexGuard&) = delete;
  MutexGuard& operator=(const MutexGuard&) = delete;

private:
  Kernel& kernel_;
  Mutex& mutex_;
};

}  // namespace robosync::kernel
