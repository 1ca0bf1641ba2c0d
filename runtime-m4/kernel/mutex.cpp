// Mutexes: see mutex.hpp. All that are held, by whomever, are linked from `held_`, the latest
// first; `ceiling_` is the highest of their ceilings, and what select_next() compares with.
//
// The rank at which a thread runs is running_rank_. So to take a mutex is to lower that number, and
// a wake-up that is not above it asks for no switch. Here is what happens when several are held;
// one by itself is taken and given back in kernel.hpp. Bounded: loops go over what is held.
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

// When it will not give back what it holds.
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

// The running thread holds something if it holds the latest: who comes after it gives back first.
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
