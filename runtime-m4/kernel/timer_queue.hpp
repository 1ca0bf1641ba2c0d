// Sleeping threads by the tick at which they are due: a hierarchical timing wheel.
//
// Three wheels of 32 buckets (1, 32 and 1024 ticks wide) and one list for what lies beyond. A timer
// stands in the wheel of the highest base-32 digit in which its due tick differs from the current
// one, and moves down a wheel when that digit's time has come. Arming and disarming take constant
// time, and a timer moves at most three times in its life, so the cost of a sleep does not depend
// on how many others sleep. Most ticks do nothing: next_work() says when collect() is needed.
//
// Ticks wrap (32 bits); a timer is at most kMaxTicks away. The caller keeps others out.
#pragma once

#include <array>
#include <cstdint>

namespace robosync::kernel {

struct Timer {
  Timer* next = nullptr;
  Timer** link = nullptr;  // what points at this timer; null when it is not armed
  std::uint32_t due = 0;

  bool armed() const { return link != nullptr; }
};

class TimerQueue {
public:
  static constexpr std::uint32_t kMaxTicks = 0x7FFF'0000;

  // Arms a timer for `due`, 1 … kMaxTicks ticks after `now`. It must not be armed.
  void arm(Timer& timer, std::uint32_t due, std::uint32_t now);

  // Takes an armed timer out. Its bucket stays marked: at worst one collect() that finds nothing.
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

  // Does the work of tick next_work(), and returns the timers that are due then, disarmed and
  // linked by `next`. Call it until has_work() is false.
  Timer* collect();

  bool empty() const;

private:
  static constexpr unsigned kDigitBits = 5;
  static constexpr unsigned kBuckets = 1U << kDigitBits;
  static constexpr unsigned kWheels = 3;

  void place(Timer& timer, std::uint32_t now);
  void note_work(std::uint32_t tick, std::uint32_t now);
  void move_down(Timer*& bucket, std::uint32_t now);
  std::uint32_t find_work(std::uint32_t now) const;

  std::array<std::array<Timer*, kBuckets>, kWheels> wheels_{};
  std::array<std::uint32_t, kWheels> occupied_{};  // bit b: bucket b may hold a timer
  Timer* beyond_ = nullptr;
  std::uint32_t next_work_ = kMaxTicks;
};

}  // namespace robosync::kernel
