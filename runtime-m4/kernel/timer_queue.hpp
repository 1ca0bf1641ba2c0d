// Sleeping threads by the tick at which they are due: a hierarchical timing wheel.
//
// There are three wheels of 32 buckets (1, 32 and 1024 ticks wide), and one list for timers beyond
// their reach. A timer is in the first wheel that reaches its due tick, and moves down a wheel when
// the time of its bucket begins; a sleep of less than 32 ticks never moves. Arming and disarming take
// constant time, and a timer moves at most three times in its life, so the cost of a sleep does not
// depend on how many other threads sleep. Most ticks do nothing: next_work() tells when collect() is
// needed.
//
// Ticks wrap (32 bits); a timer is at most kMaxTicks away. The caller does the locking.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

namespace robosync::kernel {

struct Timer {
  Timer* next = nullptr;
  Timer** link = nullptr;  // the pointer that points at this timer; null if it is not armed
  std::uint32_t due = 0;

  bool armed() const { return link != nullptr; }
};

class TimerQueue {
public:
  static constexpr std::uint32_t kMaxTicks = 0x7FFF'0000;
  static constexpr unsigned kDigitBits = 5;
  static constexpr unsigned kBuckets = 1U << kDigitBits;
  static constexpr unsigned kWheels = 3;

  // Arms a timer for `due`, 1 … kMaxTicks ticks after `now`. It must not be armed.
  void arm(Timer& timer, std::uint32_t due, std::uint32_t now) {
    timer.due = due;
    place(timer, now);
  }

  // Removes an armed timer. Its bucket stays marked, so one later collect() may find nothing.
  static void disarm(Timer& timer) {
    *timer.link = timer.next;
    if (timer.next != nullptr) timer.next->link = timer.link;
    timer.link = nullptr;
  }

  // The first tick at which there may be something to do: at or before the first due tick.
  std::uint32_t next_work() const { return next_work_; }
  // True when `now` has reached next_work().
  bool has_work(std::uint32_t now) const {
    return static_cast<std::int32_t>(now - next_work_) >= 0;
  }

  // Does the work of tick next_work(), and returns the list of the timers that are due then; take
  // them one by one with take_first(). Call it until has_work() is false.
  Timer* collect();
  // Removes and disarms the first timer of the list `due`.
  static Timer& take_first(Timer*& due) {
    Timer& first = *due;
    due = first.next;
    first.link = nullptr;
    return first;
  }

  bool empty() const;

private:
  void place(Timer& timer, std::uint32_t now);
  void note_move(std::uint32_t tick, std::uint32_t now);
  [[gnu::noinline]] void move_down(std::uint32_t now);
  void place_again(Timer*& bucket, std::uint32_t now);

  std::array<std::array<Timer*, kBuckets>, kWheels> wheels_{};
  std::array<std::uint32_t, kWheels> occupied_{};  // bit b: bucket b may hold a timer
  Timer* beyond_ = nullptr;
  // When timers of the upper wheels move next, at the latest when those of `beyond_` do.
  std::uint32_t next_move_ = 1U << (kWheels * kDigitBits);
  std::uint32_t next_work_ = next_move_;
};

inline Timer* TimerQueue::collect() {
  if (next_work_ == next_move_) [[unlikely]]
    move_down(next_work_);
  const std::uint32_t now = next_work_;
  const unsigned bucket = now % kBuckets;
  const std::uint32_t others = occupied_[0] & ~(1U << bucket);
  occupied_[0] = others;
  std::uint32_t wait = next_move_ - now;
  if (others != 0) {
    const std::uint32_t behind = std::rotr(others, static_cast<int>(bucket));
    wait = std::min(wait, static_cast<std::uint32_t>(std::countr_zero(behind)));
  }
  next_work_ = now + wait;
  return std::exchange(wheels_[0][bucket], nullptr);
}

}  // namespace robosync::kernel
