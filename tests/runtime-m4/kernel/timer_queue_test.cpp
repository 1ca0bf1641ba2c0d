// The timing wheel compared with a naive model: a list of due ticks that is searched.
#include "runtime-m4/kernel/timer_queue.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using robosync::kernel::Timer;
using robosync::kernel::TimerQueue;

namespace {

constexpr unsigned kTimers = 64;

struct Bench {
  TimerQueue queue;
  std::array<Timer, kTimers> timers;
  std::uint32_t now = 0;

  std::vector<const Timer*> model_due(std::uint32_t tick) const {
    std::vector<const Timer*> due;
    for (const Timer& timer : timers) {
      if (timer.armed() && timer.due == tick) due.push_back(&timer);
    }
    return due;
  }

  // Gets there as a queue does: from 0, in two parts, since due work is seen at most half the range of ticks ahead.
  void sleep_until_near_the_wrap() {
    for (const std::uint32_t tick : {0x7FFF'FF00U, 0xFFFF'FF00U}) {
      now = tick;
      while (queue.has_work(now))
        queue.collect();
    }
  }

  bool any_armed() const {
    return std::any_of(timers.begin(), timers.end(), [](const Timer& t) { return t.armed(); });
  }

  // Advances to the next tick of interest, at most `limit` ticks ahead, and checks what is due there.
  void advance(std::uint32_t limit) {
    const std::uint32_t step = std::min(limit, queue.next_work() - now);
    for (const Timer& timer : timers) {
      if (timer.armed()) RC_ASSERT(timer.due - now >= step);  // nothing due is skipped
    }
    now += step;
    if (!queue.has_work(now)) return;
    auto expected = model_due(now);
    std::vector<const Timer*> collected;
    for (Timer* due = queue.collect(); due != nullptr;)
      collected.push_back(&TimerQueue::take_first(due));
    std::sort(collected.begin(), collected.end());
    RC_ASSERT(collected == expected);
    RC_ASSERT(!queue.has_work(now));
    for (const Timer* t : collected)
      RC_ASSERT(!t->armed());
  }
};

}  // namespace

TEST_CASE("every timer is due at its tick, no sooner, no later") {
  const bool holds = rc::check([] {
    Bench bench;
    if (*rc::gen::arbitrary<bool>()) bench.sleep_until_near_the_wrap();
    const int steps = *rc::gen::inRange(1, 300);
    for (int i = 0; i < steps; ++i) {
      Timer& timer = bench.timers[*rc::gen::inRange(0U, kTimers)];
      const unsigned magnitude = *rc::gen::inRange(0U, 22U);
      switch (*rc::gen::inRange(0, 4)) {
        case 0:
          if (timer.armed()) TimerQueue::disarm(timer);
          break;
        case 1:
          bench.advance(*rc::gen::inRange(1U, 1U << magnitude << 1U));
          break;
        default: {
          if (timer.armed()) break;
          const std::uint32_t sleep = *rc::gen::inRange(1U, (2U << magnitude) + 1U);
          bench.queue.arm(timer, bench.now + sleep, bench.now);
        }
      }
      RC_ASSERT(bench.queue.empty() == !bench.any_armed());
    }
    while (!bench.queue.empty())
      bench.advance(TimerQueue::kMaxTicks);
  });
  CHECK(holds);
}

TEST_CASE("a timer is looked at a few times only, however long it sleeps and whoever else sleeps") {
  Bench bench;
  for (unsigned i = 0; i < kTimers; ++i)
    bench.queue.arm(bench.timers[i], 30'000 + i * 7, 0);
  unsigned collects = 0;
  while (!bench.queue.empty()) {
    bench.advance(TimerQueue::kMaxTicks);
    ++collects;
  }
  // One for the bucket of 1024 ticks, at most 14 buckets of 32, and each due tick.
  CHECK(collects <= 1 + 15 + kTimers);
}
