#include "runtime-m4/kernel/timer_queue.hpp"

#include <bit>
#include <utility>

namespace robosync::kernel {

namespace {

void push(Timer*& list, Timer& timer) {
  timer.next = list;
  timer.link = &list;
  if (list != nullptr) list->link = &timer.next;
  list = &timer;
}

// Ticks of one bucket of a wheel.
constexpr std::uint32_t width(unsigned wheel, unsigned digit_bits) {
  return 1U << (wheel * digit_bits);
}

}  // namespace

void TimerQueue::arm(Timer& timer, std::uint32_t due, std::uint32_t now) {
  timer.due = due;
  place(timer, now);
}

void TimerQueue::place(Timer& timer, std::uint32_t now) {
  const std::uint32_t differing = timer.due ^ now;
  for (unsigned wheel = 0; wheel < kWheels; ++wheel) {
    const std::uint32_t bucket_ticks = width(wheel, kDigitBits);
    if (differing >= bucket_ticks * kBuckets) continue;
    const unsigned bucket = (timer.due / bucket_ticks) % kBuckets;
    push(wheels_[wheel][bucket], timer);
    occupied_[wheel] |= 1U << bucket;
    note_work(timer.due & ~(bucket_ticks - 1), now);
    return;
  }
  push(beyond_, timer);
  note_work((now | (width(kWheels, kDigitBits) - 1)) + 1, now);
}

void TimerQueue::note_work(std::uint32_t tick, std::uint32_t now) {
  if (tick - now < next_work_ - now) next_work_ = tick;
}

Timer* TimerQueue::collect() {
  const std::uint32_t now = next_work_;
  if (now % width(kWheels, kDigitBits) == 0) move_down(beyond_, now);
  for (unsigned wheel = kWheels - 1; wheel > 0; --wheel) {
    const std::uint32_t bucket_ticks = width(wheel, kDigitBits);
    if (now % bucket_ticks != 0) continue;
    const unsigned bucket = (now / bucket_ticks) % kBuckets;
    occupied_[wheel] &= ~(1U << bucket);
    move_down(wheels_[wheel][bucket], now);
  }
  const unsigned bucket = now % kBuckets;
  occupied_[0] &= ~(1U << bucket);
  Timer* const due = std::exchange(wheels_[0][bucket], nullptr);
  for (Timer* timer = due; timer != nullptr; timer = timer->next)
    timer->link = nullptr;
  next_work_ = find_work(now);
  return due;
}

void TimerQueue::move_down(Timer*& bucket, std::uint32_t now) {
  Timer* timer = std::exchange(bucket, nullptr);
  while (timer != nullptr) {
    Timer* const next = timer->next;
    place(*timer, now);
    timer = next;
  }
}

std::uint32_t TimerQueue::find_work(std::uint32_t now) const {
  for (unsigned wheel = 0; wheel < kWheels; ++wheel) {
    if (occupied_[wheel] == 0) continue;
    const std::uint32_t turn = width(wheel + 1, kDigitBits);
    const auto bucket = static_cast<std::uint32_t>(std::countr_zero(occupied_[wheel]));
    return (now & ~(turn - 1)) + bucket * width(wheel, kDigitBits);
  }
  if (beyond_ != nullptr) return (now | (width(kWheels, kDigitBits) - 1)) + 1;
  return now + kMaxTicks;
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
