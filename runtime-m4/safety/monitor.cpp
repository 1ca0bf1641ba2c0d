// See monitor.hpp.
#include "runtime-m4/safety/monitor.hpp"

#include <algorithm>

namespace robosync::safety {

bool Monitor::start() {
  return kernel_.add(thread_, {.name = "safety",
                               .category = kernel::Category::safety,
                               .priority = 0,
                               .entry = [](void* self) { static_cast<Monitor*>(self)->run(); },
                               .argument = this,
                               .stack = stack_});
}

void Monitor::run() {
  board_.watchdog_start();
  idle_us_ = static_cast<std::uint32_t>(idle_period(board_.watchdog_ms()));
  kernel::Time due = kernel_.now();
  kernel::Time rules_due = kernel::kForever;
  while (true) {
    const kernel::Events why = kernel_.wait(kNews | kProgram | kPerson, std::min(due, rules_due));
    bool look = why == kNews;  // a reading alone takes the short way
    if (!look) {
      if (why != 0) [[unlikely]] {
        if ((why & kPerson) != 0) supervised_.obey();
        if ((why & kProgram) != 0) {
          due = std::min(due, supervised_.began());  // the watchdog does not wait for a program
          rules_due = kernel::kForever;
          without_progress_ = 0;
        }
      }
      look = (why & kNews) != 0 || kernel_.now() >= std::min(due, rules_due);
    }
    if (look) rules_due = supervised_.look_at_rules();
    const kernel::Time now = kernel_.now();
    if (now < due) continue;
    check(now - due);
    due = next_after(due, now);
  }
}

// Periods are in program time, from the program's beginning on. Missed periods are skipped, never made up for.
kernel::Time Monitor::next_after(kernel::Time due, kernel::Time now) const {
  if (!supervised_.running()) return now + idle_us_;
  if (now < supervised_.began()) return std::min(supervised_.began(), now + idle_us_);
  const kernel::Time next = std::max(due, supervised_.began()) + kPeriod;
  return now < next ? next : next + ((now - next) / kPeriod + 1) * kPeriod;
}

void Monitor::check(kernel::Duration late) {
  const auto lateness = static_cast<std::uint32_t>(std::min<kernel::Duration>(late, UINT32_MAX));
  late_ = std::max(late_.load(std::memory_order_relaxed), lateness);
  checks_ += 1;
  const std::uint32_t progress = supervised_.progress();
  const bool alive = supervised_.resting() || progress != last_progress_;
  last_progress_ = progress;
  supervised_.hold_to_budgets(alive);
  supervised_.tend_outputs();
  without_progress_ = alive ? 0 : std::min(without_progress_ + 1, kChecksUntilHung);
  if (without_progress_ < kChecksUntilHung) {
    board_.watchdog_kick();
  } else {
    supervised_.halt(kChecksUntilHung * kPeriod);
  }
}

}  // namespace robosync::safety
