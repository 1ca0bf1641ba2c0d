// Which thread outranks which: a thread's standing, computed from its category and its priority.
// Pure. The kernel ranks threads by it, and analysis/ derives from it which thread may preempt which.
#pragma once

#include <compare>
#include <cstdint>

namespace robosync::policy {

// The maximum number of threads: one bit each in the kernel's ready set.
inline constexpr unsigned kMaxThreads = 96;

// The paper's four categories, that of algorithms, and two around them. Within one behaviour's priority, a later category
// ranks higher. `safety` ranks above everything, `system` (the link) below everything, and `control` above the rest of a
// program, whatever its behaviour's priority. So the step of a given time knows what each actuator has done by that time;
// otherwise unrelated behaviours would change what the robot does.
enum class Category : std::uint8_t {
  system,
  sensor,
  algorithm,
  processing,
  behavior,
  control,
  safety
};
inline constexpr unsigned kCategories = 7;

// The priority of a thread's behaviour. `now` decides; between equals, `base` does, the priority as
// written (adaptation.hpp explains how the two come to differ). Behaviours have distinct bases, so two
// behaviours are never equal.
struct Priority {
  std::int8_t now = 0;
  std::int8_t base = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 sees a 0 in what it is defaulted to
  friend constexpr auto operator<=>(const Priority&, const Priority&) = default;
};

// A thread's place in the order as one number, below 2^kStandingBits: the higher number outranks.
// Equals rank by age. category_of() and priority_of() recover its parts.
//
//   bits 22–21: 3 safety, 2 control, 0 system, else 1 | 18–11: now + 128 | 10–3: base + 128 | 2–0: category
using Standing = std::uint32_t;
inline constexpr unsigned kStandingBits = 24;
constexpr Standing with_priority(Standing standing, Priority priority) {
  constexpr Standing kPriorityBits = 0xFFFF << 3;
  const auto now = static_cast<unsigned>(priority.now + 128);
  const auto base = static_cast<unsigned>(priority.base + 128);
  return (standing & ~kPriorityBits) | now << 11 | base << 3;
}
constexpr unsigned beyond(Category category) {
  switch (category) {
    case Category::safety:
      return 3;
    case Category::control:
      return 2;
    case Category::system:
      return 0;
    default:
      return 1;
  }
}
constexpr Standing standing(Category category, Priority priority) {
  return with_priority(beyond(category) << 21 | static_cast<unsigned>(category), priority);
}
constexpr Standing standing(Category category, std::int8_t priority) {
  return standing(category, Priority{priority, priority});
}
constexpr Category category_of(Standing standing) {
  return static_cast<Category>(standing & 7);
}
constexpr Priority priority_of(Standing standing) {
  const auto unbiased = [](Standing bits) {
    return static_cast<std::int8_t>(static_cast<int>(bits & 0xFF) - 128);
  };
  return {unbiased(standing >> 11), unbiased(standing >> 3)};
}
inline constexpr Standing kBelowAll = 0;

}  // namespace robosync::policy
