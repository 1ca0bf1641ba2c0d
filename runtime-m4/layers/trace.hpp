// Stamps the events of the running program and hands them to the sink.
//
// Events of a step carry the step's time and number. Events between steps (a command that waited for
// its actuator, done, finished) carry the kernel's time and the last step's number. For the order of
// events at one time see processing.hpp.
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

  // A new program: its time and its steps count from 0.
  void restart(kernel::Time activated_at) {
    activated_at_ = activated_at;
    activated_tick_ = static_cast<std::uint32_t>(activated_at / kernel::kTick);
    step_ = {};
  }
  void begin_step(kernel::Time time) {
    step_.time = time;
    ++step_.step;
  }

  kernel::Time activated_at() const { return activated_at_; }
  // 0 until the program's first tick.
  kernel::Time program_time() const {
    const kernel::Time now = kernel_.now();
    return now < activated_at_ ? 0 : now - activated_at_;
  }
  // The same in whole ticks; wraps after 49 days.
  std::uint32_t milliseconds() const { return milliseconds(kernel_.tick()); }
  std::uint32_t milliseconds(std::uint32_t tick) const {
    const std::uint32_t passed = tick - activated_tick_;
    if (static_cast<std::int32_t>(passed) < 0) [[unlikely]]
      return is_waiting() ? 0 : passed;
    return passed;
  }
  // When `delay` milliseconds have passed since `now`, a value of milliseconds(). The tick may have come since.
  kernel::Time time_after(std::uint32_t now, std::uint32_t delay) const;
  const Stamp& step() const { return step_; }
  Stamp now() const { return {program_time(), step_.step}; }

  // True if somebody receives the events. A caller that would have to do work for an event asks first.
  [[gnu::always_inline]] bool listening() const { return sink_.listening(); }

  [[gnu::always_inline]] void emit(link::EventKind kind, const Stamp& stamp, unsigned subject,
                                   unsigned object = 0) {
    if (listening()) [[unlikely]]
      tell(kind, stamp, subject, object);
  }
  [[gnu::always_inline]] void emit(link::EventKind kind, const Stamp& stamp, unsigned subject,
                                   unsigned object, std::int32_t value) {
    if (listening()) [[unlikely]]
      tell(kind, stamp, subject, object, value);
  }
  // For events with several values (value_count says how many), once listening() is known to hold. Stacks
  // are small, so the caller fills the event in place.
  static void begin(link::Event& event, link::EventKind kind, Stamp stamp, unsigned subject,
                    unsigned object);
  void emit(const link::Event& event) { sink_.emit(event); }

private:
  // True before the program's first tick; otherwise half of the 49 days have passed.
  [[gnu::noinline]] bool is_waiting() const { return kernel_.now() < activated_at_; }
  [[gnu::noinline]] void tell(link::EventKind kind, const Stamp& stamp, unsigned subject,
                              unsigned object);
  [[gnu::noinline]] void tell(link::EventKind kind, const Stamp& stamp, unsigned subject,
                              unsigned object, std::int32_t value);

  kernel::Kernel& kernel_;
  EventSink& sink_;
  kernel::Time activated_at_ = 0;
  std::uint32_t activated_tick_ = 0;
  Stamp step_;
};

}  // namespace robosync::layers
