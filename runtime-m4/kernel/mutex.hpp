// A mutex for threads that share what takes long to use, as a bus; for a few words, Kernel::lock()
// is cheaper. Immediate priority ceiling: whoever holds it runs at the rank of the highest thread
// that may ever want it (the ceiling).
//
// So a thread never waits for a mutex: while one is held, no thread that may want it is run; when
// such a thread runs, the mutex is free. There is no queue of waiters, no inheritance, no deadlock,
// and a thread is held up by one holder at most, before it starts.
//
// The users are the threads of a category, and any that rank below the highest of these; so the
// ceiling is known when a program is loaded, and stays right when threads change their ranks. A
// thread above the ceiling that comes upon a mutex which is held is stopped. The holder must not
// wait or sleep. It may hold several, and release them in any order. When it is stopped (a fault)
// or removed, what it held is free.
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

  // Takes what `link` points at out of those that are held.
  static void take_out(Mutex*& link) {
    Mutex& mutex = *link;
    mutex.owner_ = nullptr;
    link = mutex.below_;
    mutex.below_ = nullptr;
    mutex.not_alone_ = false;
  }

  Thread* owner_ = nullptr;
  Mutex* below_ = nullptr;  // what was held already when this one was taken
  Category highest_;
  bool not_alone_ = false;  // something else is held, or was, since it was taken
};

// Holds a mutex as long as it lives.  [thread]
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
