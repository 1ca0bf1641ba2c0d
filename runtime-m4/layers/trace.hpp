// Stamps the events of the running program and hands them to the sink.
//
// What belongs to a step carries the step's time and number. What happens between steps (a command
// that waited for its actuator, done, finished) carries the kernel's time and the last step's
// number. Order within one time: see processing.hpp.
#pragma once

#include <cstdint>

#include "link/events.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/event_sink.hpp"
#include "runtime-m4/layers/messages.hpp"

namespace robosync::layers {

class Trace {
public:
  Trace(kernel::Kernel& kernel, EventSink& sink) : kernel_(kernel), sink_(sink) {}

  // A new program: its clock and steps count from 0.
  void restart(kernel::Time activated_at) {
    activated_at_ = activated_at;
    step_ = {};
  }
  void begin_step(Stamp step) { step_ = step; }

  kernel::Time activated_at() const { return activated_at_; }
  // 0 while the program waits for its first tick.
  kernel::Time program_time() const {
    const kernel::Time now = kernel_.now();
    return now < activated_at_ ? 0 : now - activated_at_;
  }
  Stamp step() const { return step_; }
  Stamp now() const { return {program_time(), step_.step}; }

  void emit(link::EventKind kind, Stamp stamp, unsigned subject, unsigned object = 0);
  void emit(link::EventKind kind, Stamp stamp, unsigned subject, unsigned object,
            std::int32_t value);
  // For events of several values: their number is value_count. Stacks are short, so that whoever
  // makes such an event fills it in place.
  static link::Event event(link::EventKind kind, Stamp stamp, unsigned subject, unsigned object);
  void emit(const link::Event& event) { sink_.emit(event); }

private:
  kernel::Kernel& kernel_;
  EventSink& sink_;
  kernel::Time activated_at_ = 0;
  Stamp step_;
};

}  // namespace robosync::layers
