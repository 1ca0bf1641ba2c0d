// Who outranks whom: a thread's standing, worked out from its category and its priority. Pure; the
// kernel ranks threads by it, and analysis/ asks it which of them may interrupt which.
#pragma once

#include <compare>
#include <cstdint>

namespace robosync::policy {

// Threads that the kernel ranks at most: one bit each in its ready set.
inline constexpr unsigned kMaxThreads = 96;

// The paper's four categories with that of algorithms, and the two kinds of threads around them. Inside one behaviour's
// priority, a later category ranks higher. `safety` ranks above everything, `system` (the link) below everything, and
// `control` above the rest of a program, whatever its behaviour's priority: what an actuator has done at a time is known to
// the step of that time, or what the robot does would depend on which other behaviours there are.
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

// What a thread's behaviour is worth: `now` decides, and between equals `base`, the priority as it
// was written (adaptation.hpp says how the two come to differ). Behaviours have distinct bases, so
// two behaviours are never equal.
struct Priority {
  std::int8_t now = 0;
  std::int8_t base = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 sees a 0 in what it is defaulted to
  friend constexpr auto operator<=>(const Priority&, const Priority&) = default;
};

// A thread's place in the order as one number, below 2^kStandingBits: the higher outranks. Equals
// rank by age. What it was made of can be had of it again.
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
