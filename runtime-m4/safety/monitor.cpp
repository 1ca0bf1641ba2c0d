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
  kernel::Time due = kernel_.now();
  kernel::Time rules_due = due;
  while (true) {
    kernel_.wait(kNews, std::min(due, rules_due));
    rules_due = supervised_.look_at_rules();
    const kernel::Time now = kernel_.now();
    if (now < due) continue;
    check(now - due);
    due += ((now - due) / kPeriod + 1) * kPeriod;
  }
}

void Monitor::check(kernel::Duration late) {
  const auto lateness = static_cast<std::uint32_t>(std::min<kernel::Duration>(late, UINT32_MAX));
  late_ = std::max(late_.load(std::memory_order_relaxed), lateness);
  checks_ += 1;
  const std::uint32_t progress = supervised_.progress();
  const bool alive = supervised_.resting() || progress != last_progress_;
  last_progress_ = progress;
  supervised_.hold_to_budgets(alive);
  without_progress_ = alive ? 0 : std::min(without_progress_ + 1, kChecksUntilHung);
  if (without_progress_ < kChecksUntilHung) {
    board_.watchdog_kick();
  } else {
    supervised_.halt(kChecksUntilHung * kPeriod);
  }
}

}  // namespace robosync::safety
