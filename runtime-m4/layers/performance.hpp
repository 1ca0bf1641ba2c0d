// An actuator's part in a MOTION, from key to key. Each way is a MOVE TO … OVER … of its driver, which
// keeps to the actuator's limits.
//
// A key's time counts from the beginning of the motion, not from the key before: an actuator that is
// late because of a limit catches up where it can, and rounds do not drift. No way takes less than
// kMinKeyGapMs, so an actuator costs no more than it does when it follows setpoints.
#pragma once

#include <cstdint>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

class Performance {
public:
  // Begins the part of `actuator`, for a command whose action is perform. There is nothing to do if the
  // motion has no track for it, or if a parameter is unknown or not above 0.
  void begin(const vm::Image& image, unsigned actuator, const drivers::Order& order,
             kernel::Time now);
  void end() { keys_ = 0; }

  // There is a way left, or the motion's time is not over.
  [[nodiscard]] bool is_on() const { return keys_ != 0; }
  // The next way. False if there is none; the motion is then over at ends_at().
  [[nodiscard]] bool next(const vm::Image& image, kernel::Time now, drivers::Order& order);
  kernel::Time ends_at() const { return round_ + length_; }

private:
  kernel::Duration stretched(vm::Value time) const;

  kernel::Time round_ = 0;       // when this round began
  kernel::Duration length_ = 0;  // of a round
  vm::Value tempo_ = 0;          // thousandths of a percent
  std::uint16_t first_key_ = 0;
  std::uint16_t rounds_ = 0;  // left, including this one
  std::uint8_t keys_ = 0;     // of the track; 0 without a motion
  std::uint8_t next_key_ = 0;
};

}  // namespace robosync::layers
