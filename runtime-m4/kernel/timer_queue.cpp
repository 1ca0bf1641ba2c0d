// The rare paths, built for size. The frequent ones are in the header.
#include "runtime-m4/kernel/timer_queue.hpp"

#include <bit>
#include <utility>

namespace robosync::kernel {

namespace {

void insert(Timer*& list, Timer& timer) {
  timer.next = list;
  timer.link = &list;
  if (list != nullptr) list->link = &timer.next;
  list = &timer;
}

// Ticks of one bucket of a wheel. width(kWheels) is how far the last wheel reaches.
constexpr std::uint32_t width(unsigned wheel) {
  return 1U << (wheel * TimerQueue::kDigitBits);
}

}  // namespace

void TimerQueue::place(Timer& timer, std::uint32_t now) {
  const std::uint32_t distance = timer.due - now;
  const std::uint32_t due = timer.due;
  unsigned wheel = 0;
  while (wheel < kWheels && distance >= width(wheel + 1))
    ++wheel;
  if (wheel == kWheels) return insert(beyond_, timer);
  const unsigned bucket = (due / width(wheel)) % kBuckets;
  occupied_[wheel] |= 1U << bucket;
  const std::uint32_t work = due & ~(width(wheel) - 1);
  if (wheel != 0 && work - now < next_move_ - now) next_move_ = work;
  if (work - now < next_work_ - now) next_work_ = work;
  insert(wheels_[wheel][bucket], timer);
}

void TimerQueue::note_move(std::uint32_t tick, std::uint32_t now) {
  if (tick - now < next_move_ - now) next_move_ = tick;
  if (tick - now < next_work_ - now) next_work_ = tick;
}

// Runs at most every 32 ticks and at least every 32,768, even if there is nothing to move. Timers due
// now get into the bucket that collect() empties next.
void TimerQueue::move_down(std::uint32_t now) {
  next_move_ = (now | (width(kWheels) - 1)) + 1;
  if (now % width(kWheels) == 0) place_again(beyond_, now);
  for (unsigned wheel = kWheels - 1; wheel > 0; --wheel) {
    const std::uint32_t bucket_ticks = width(wheel);
    const unsigned bucket = (now / bucket_ticks) % kBuckets;
    if (now % bucket_ticks == 0) {
      occupied_[wheel] &= ~(1U << bucket);
      place_again(wheels_[wheel][bucket], now);
    }
    if (occupied_[wheel] == 0) continue;
    const std::uint32_t behind = std::rotr(occupied_[wheel], static_cast<int>(bucket) + 1);
    const auto others = static_cast<std::uint32_t>(std::countr_zero(behind));
    note_move((now / bucket_ticks + 1 + others) * bucket_ticks, now);
  }
}

void TimerQueue::place_again(Timer*& bucket, std::uint32_t now) {
  Timer* timer = std::exchange(bucket, nullptr);
  while (timer != nullptr) {
    Timer* const next = timer->next;
    place(*timer, now);
    timer = next;
  }
}

bool TimerQueue::empty() const {
  for (const auto& wheel : wheels_) {
    for (const Timer* bucket : wheel) {
      if (bucket != nullptr) return false;
    }
  }
  return beyond_ == nullptr;
}

}  // namespace robosync::kernel
