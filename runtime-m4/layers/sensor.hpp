// Sensor layer: one thread per sensor that samples, in step with the program's activation; and one
// thread for all fed sensors, since they share one queue.
//
// A reading is clamped to its channel's range and published only if it is news (mailbox.hpp). A
// sample that fails publishes nothing; if samples go on failing, the channel becomes unknown by age. Devices that do not
// answer are noted and reported (contact.hpp).
// All readings that one sensor takes at one time, and all feeds that are due at one tick, enter the
// same step: that of their tick, before its timers, because the first thread that looks at that tick
// delivers what is due (deliver_due()).
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/alarm.hpp"
#include "runtime-m4/layers/contact.hpp"
#include "runtime-m4/layers/feed_queue.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/mailbox.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/sampler.hpp"
#include "runtime-m4/layers/trace.hpp"

namespace robosync::layers {

class SensorLayer {
public:
  // `news` of `step_thread` is signalled when readings were announced.
  SensorLayer(kernel::Kernel& kernel, Trace& trace, Mailboxes& mailboxes, Alarm& alarm,
              kernel::Thread& step_thread, kernel::Events news)
      : kernel_(kernel),
        trace_(trace),
        mailboxes_(mailboxes),
        alarm_(alarm),
        step_thread_(step_thread),
        news_(news) {}

  // Creates the threads of `program`, which must stay in place until they are dismissed.
  // `simulated`: only `sampler` measures, so there is nothing to wait for.
  [[nodiscard]] bool start(const LoadedProgram& program, Sampler& sampler, bool simulated,
                           Memory& memory, ProgramThreads& threads);
  // All threads of the program exist: sensors that SAFETY reads begin to measure.
  void go();
  // Every channel that SAFETY reads has its first reading or, if `simulated`, has had its turn.
  // Before begin().
  bool knows_enough() const { return awaited_ == 0; }
  // Program time begins at activated_at(), which was expected to be `zero`.
  void begin(kernel::Time zero);

  // A reading for a fed channel of the running program. It is published at its time: now, if feed.at_us is 0 or over.  [thread]
  link::FeedResult feed(const link::Feed& feed);
  // … by a thread of the program, also if it is for now.  [any]
  link::FeedResult enqueue(const link::Feed& feed);
  // The contact with the devices that are measured.  [link thread]
  void fill_devices(link::Devices& devices) const;

  // Publishes the feeds that are due. The step thread and the safety thread outrank the one that serves
  // the feeds: each calls this before it asks what is known and what is due.  [thread]
  void deliver_due() {
    if (are_fed() && feeds_.next_due() <= kernel_.now()) deliver();
  }

  bool are_fed() const { return !feeds_.empty(); }  // feeds wait to be delivered

  // Its thread was stopped: its channels become unknown.
  void retire(unsigned member_index);

  // --- for the algorithms ---
  // From now on kSampled of `thread` is signalled when a sensor has sampled; null: no thread is.
  void tell_of_samples(kernel::Thread* thread) { sample_thread_ = thread; }
  static constexpr kernel::Events kSampled = 1;
  // Publishes a value made from readings of `time`; returns the channel's bit if it is news. Announce it afterwards.
  ChannelMask publish(std::uint8_t channel, vm::Value value, kernel::Time time);
  void announce(ChannelMask channels);
  // SAFETY still waits for a first reading of one of them.
  bool awaits(ChannelMask channels) const { return (awaited_ & channels) != 0; }
  // In a simulation SAFETY no longer waits for these: everything there was to read was read.
  void note_turn(ChannelMask channels) {
    if (simulated_ && awaits(channels)) note_tried(channels);
  }
  ChannelMask channels_of(unsigned sensor) const;

private:
  static constexpr kernel::Events kFeed = 1;
  static constexpr kernel::Events kGo = 2;
  static constexpr kernel::Events kBegin = 4;

  struct Unit {
    SensorLayer* layer = nullptr;
    kernel::Thread* thread = nullptr;  // null: it is fed
    Contact contact;
  };

  [[nodiscard]] bool start_sensor(unsigned sensor, ProgramThreads& threads);
  [[nodiscard]] bool start_feeds(ProgramThreads& threads);
  void run_sensor(unsigned sensor);
  kernel::Time first_sample(unsigned sensor) const;
  void await_begin(unsigned sensor);
  void note_tried(ChannelMask channels);
  void signal_sensors(kernel::Events events);
  ChannelMask made_of(unsigned sensor) const;
  void run_feeds();
  kernel::Duration asks_ahead(unsigned sensor) const {
    return sampler_->asks_ahead(program_->image.sensors[sensor]);
  }
  void ask(unsigned sensor);
  void await_sample(unsigned sensor, kernel::Time due);
  kernel::Time next_sample(unsigned sensor, kernel::Time last);
  void sample(unsigned sensor);
  void serve_chip(unsigned sensor);
  void note_contact(unsigned sensor, unsigned failed);
  [[gnu::noinline]] void deliver();
  void announce_to_safety(ChannelMask channels);
  void announce_all(ChannelMask channels);
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
  kernel::Thread* sample_thread_ = nullptr;
  std::span<Unit> units_;
  FeedQueue feeds_;
  ChannelMask awaited_ = 0;  // SAFETY reads them, and they have no reading yet
  bool simulated_ = false;
  std::atomic<bool> begun_ = false;
};

}  // namespace robosync::layers
