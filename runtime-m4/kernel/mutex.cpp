// Mutexes: see mutex.hpp. All held mutexes of all threads are one list from `held_`, the latest first.
// `ceiling_` is the highest of their ceilings; select_next() compares with it.
//
// A thread runs at running_rank_. Taking a mutex lowers that number, and a wake-up that is not above
// it requests no switch. This file handles several held mutexes; kernel.hpp takes and releases a
// single one. Bounded: loops go over the held mutexes.
#include "runtime-m4/kernel/mutex.hpp"

#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

void Kernel::acquire_another(Mutex& mutex) {
  port::OnlyLock lock(machine_);
  if (mutex.owner_ != nullptr) return stop(*running_);  // it ranks above the ceiling
  mutex.owner_ = running_;
  mutex.below_ = held_;
  mutex.not_alone_ = held_->not_alone_ = true;
  held_ = &mutex;
  ceiling_ = find_ceiling();
  running_rank_ = ceiling_;
}

void Kernel::release_one(Mutex& mutex) {
  port::OnlyLock lock(machine_);
  Mutex** link = &held_;
  while (*link != &mutex)
    link = &(*link)->below_;
  Mutex::take_out(*link);
  ceiling_ = find_ceiling();
  running_rank_ = rank_of_running();
  machine_.request_switch();  // at worst to itself
}

// For a thread that is stopped or removed.
void Kernel::release_all(const Thread& thread) {
  for (Mutex** link = &held_; *link != nullptr;) {
    if ((*link)->owner_ == &thread) {
      Mutex::take_out(*link);
    } else {
      link = &(*link)->below_;
    }
  }
  ceiling_ = find_ceiling();
}

std::uint8_t Kernel::find_ceiling() const {
  std::uint8_t ceiling = kIdleRank;
  for (const Mutex* mutex = held_; mutex != nullptr; mutex = mutex->below_)
    ceiling = std::min(ceiling, highest_of_[index(mutex->highest_)]);
  return ceiling;
}

// The running thread holds a mutex only if it holds the latest one: a thread that preempts a holder
// releases its own mutexes before the holder runs again.
std::uint8_t Kernel::rank_of_running() const {
  return held_ != nullptr && held_->owner_ == running_ ? ceiling_ : running_->rank_;
}

MutexGuard::MutexGuard(Kernel& kernel, Mutex& mutex) : kernel_(kernel), mutex_(mutex) {
  kernel_.acquire(mutex_);
}

MutexGuard::~MutexGuard() {
  kernel_.release(mutex_);
}

}  // namespace robosync::kernel
