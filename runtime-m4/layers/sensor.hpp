// Sensor layer: one thread per sensor that samples, in step with the program's activation; and one
// thread for all sensors that are fed, since what they wait for is one queue.
//
// A reading is clamped to its channel's range and published only if it is news (mailbox.hpp). A
// sample that fails publishes nothing; if it goes on failing, the channel becomes unknown by age.
// All readings that one sensor takes at one time, and all feeds that are due at one tick, enter the
// same step.
#pragma once

#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/alarm.hpp"
#include "runtime-m4/layers/feed_queue.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/mailbox.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/sampler.hpp"
#include "runtime-m4/layers/trace.hpp"

namespace robosync::layers {

class SensorLayer {
public:
  // `news` of `step_thread` are signalled when readings were announced.
  SensorLayer(kernel::Kernel& kernel, Trace& trace, Mailboxes& mailboxes, Alarm& alarm,
              kernel::Thread& step_thread, kernel::Events news)
      : kernel_(kernel),
        trace_(trace),
        mailboxes_(mailboxes),
        alarm_(alarm),
        step_thread_(step_thread),
        news_(news) {}

  // Creates the threads of `program`, which must stay until they are dismissed.
  [[nodiscard]] bool start(const LoadedProgram& program, Sampler& sampler, Memory& memory,
                           ProgramThreads& threads);
  // All threads of the program are there: sampling begins.
  void go();

  // A reading for a fed channel, of a program that runs.  [link thread]
  link::FeedResult feed(const link::Feed& feed);

  // Its thread was stopped: what it measures is no longer known.
  void retire(unsigned member_index);

private:
  static constexpr kernel::Events kFeed = 1;
  static constexpr kernel::Events kGo = 2;

  struct Unit {
    SensorLayer* layer = nullptr;
    kernel::Thread* thread = nullptr;  // null: it is fed
    std::uint8_t sensor = 0;
  };

  [[nodiscard]] bool start_sensor(unsigned sensor, ProgramThreads& threads);
  [[nodiscard]] bool start_feeds(ProgramThreads& threads);
  void run_sensor(unsigned sensor);
  void run_feeds();
  kernel::Time next_sample(unsigned sensor, kernel::Time last);
  void sample(unsigned sensor);
  void deliver_due();
  ChannelMask publish(std::uint8_t channel, vm::Value value);
  void announce(ChannelMask channels);
  link::FeedError check(const link::Feed& feed) const;

  kernel::Kernel& kernel_;
  Trace& trace_;
  Mailboxes& mailboxes_;
  Alarm& alarm_;
  kernel::Thread& step_thread_;
  kernel::Events news_;
  const LoadedProgram* program_ = nullptr;
  Sampler* sampler_ = nullptr;
  kernel::Thread* feed_thread_ = nullptr;
  std::span<Unit> units_;
  FeedQueue feeds_;
};

}  // namespace robosync::layers
