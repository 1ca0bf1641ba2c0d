// Processing layer: the step thread, which turns readings and time into steps.
//
// It works in passes. A pass first handles what ended since the last one. Then, if there is a reason
// for a step, it makes one, numbered from 1, at the time of the kernel's tick counted from
// activation. Reasons are: readings were announced or became too old, a thread was stopped, safety
// halted an actuator in use, or something is due (next_due()). Inside a step:
//
//   latch -> the behaviours take their turns, from the highest priority down -> commands are committed
//
// and in a behaviour's turn:
//
//   rules that read a changed input, or are due, are evaluated -> claims are decided, in the order of
//   the rules -> the interrupted responses are cancelled -> responses run: those that go on and those that won
//
// So a claim competes with the more important ones of the same step, and is never lost to a less
// important one. A step costs time for the rules that it concerns and for those that run, wait or want
// to run; the others cost nothing (find_concerned()).
//
// What a step itself causes (SET and SIGNAL, a WHILE that starts again, the end of a wait) is
// due in the next millisecond at the earliest, so the number of steps at one time is bounded by
// what comes from outside.
//
// Order of the trace events of one pass:
//   fault                a thread was stopped
//   priority             a window of adaptation ended, by behaviour; ranks change here
//   finished             rules whose commands are all done, by rule
//   input, stale         by channel; the step begins with the first of all these
//   set                  variables except bands, by variable; then bands, by CHECK
//   interrupt            responses of behaviours whose thread was stopped; responses that safety
//                        halted; each by rule
//   cancel               of those, in the order of the actuators' ranks
//   … then for each behaviour's turn:
//     zero_divide, fire, interrupt
//                        rule by rule; interrupt of a WHILE whose condition no longer holds
//     interrupt, win/lose
//                        claim by claim in the order of the rules: first what it interrupts, by rule
//     cancel             of those, in the order of the actuators' ranks
//     go_on, zero_divide, log, alert, wait, overrun
//                        response by response, by rule; overrun once for each actuator
//   command              in the order of the actuators' ranks (a STOP's cancel precedes the STOP)
//   finished             of responses that command nothing, by rule
// command and done of a queued command, and done in general, appear when the actuator's thread
// reaches them: before anything a lower ranked thread does at the same tick. What safety does
// (trip, halt, log, alert, resume, release) comes before everything else at its tick or, if a
// sensor's reading is the reason, before the step that the reading enters.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/adaptation.hpp"
#include "runtime-m4/layers/alarm.hpp"
#include "runtime-m4/layers/algorithms.hpp"
#include "runtime-m4/layers/arbiter.hpp"
#include "runtime-m4/layers/behavior.hpp"
#include "runtime-m4/layers/checks.hpp"
#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/control.hpp"
#include "runtime-m4/layers/link_share.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/mailbox.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/sensor.hpp"
#include "runtime-m4/layers/thresholds.hpp"
#include "runtime-m4/layers/trace.hpp"
#include "runtime-m4/layers/triggers.hpp"
#include "runtime-m4/layers/variables.hpp"

namespace robosync {
struct RuntimePeer;  // for tests
}

namespace robosync::layers {

// What wakes the step thread.
inline constexpr kernel::Events kNews = 1;       // readings were announced
inline constexpr kernel::Events kIdle = 2;       // an actuator has done all its commands
inline constexpr kernel::Events kFinished = 4;   // a behaviour has done what it was released for
inline constexpr kernel::Events kCancelled = 8;  // an actuator was cancelled
inline constexpr kernel::Events kStopped =
    16;  // a thread was stopped by a fault, or is to be lowered
inline constexpr kernel::Events kHalted = 32;      // safety has halted, let go, or set something
inline constexpr kernel::Events kBegin = 64;       // all threads of the program exist
inline constexpr kernel::Events kLinkRests = 128;  // the link's thread has nothing more to do

class ProcessingLayer {
public:
  struct Neighbours {
    Mailboxes& mailboxes;
    SensorLayer& sensors;
    Variables& variables;
    Triggers& triggers;
    Arbiter& arbiter;
    BehaviorLayer& behaviors;
    ControlLayer& control;
    ProgramThreads& threads;
    Alarm& alarm;
    AlgorithmLayer& algorithms;
  };

  ProcessingLayer(kernel::Kernel& kernel, Trace& trace, kernel::Thread& thread,
                  const Neighbours& neighbours)
      : kernel_(kernel), trace_(trace), thread_(thread), layers_(neighbours) {}

  // Starts the step thread of `program`, which must stay in place until it is dismissed.
  [[nodiscard, gnu::cold]] bool start(const LoadedProgram& program, const Beginnings& beginnings,
                                      Memory& memory);
  // All threads of the program exist: gives them their ranks.
  void rank() { adaptation_.rank(*program_, layers_.threads, trace_); }
  // … and starts the first step when the program's clock begins.
  void go() { kernel_.signal(thread_, kBegin); }

  // Gives the link's thread its share of the processor (policy/link_share.hpp). Before Kernel::run().
  void share_with(const kernel::Thread& link) { link_share_.watch(link); }
  // The link's thread has nothing more to do: it waits, and its turn, if it had one, is over.  [the link's thread]
  kernel::Events rest_link(kernel::Events mask, kernel::Time deadline) {
    return kernel_.signal_and_wait(thread_, kLinkRests, mask, deadline);
  }

  std::uint32_t steps() const { return trace_.step().step; }
  const Snapshot& snapshot() const { return snapshot_; }
  // For the monitor: is it between passes with nothing to do, and how many passes has it done?
  bool resting() const;
  std::uint32_t passes() const { return passes_.load(std::memory_order_relaxed); }

private:
  friend struct robosync::RuntimePeer;

  // --- passes, and what makes a step ---
  void run();
  void pass();
  [[gnu::noinline]] void finish_done(ActuatorMask idle);
  void finish_if_done(unsigned rule);
  bool is_due(std::uint32_t now) const;
  bool nothing_follows(std::uint32_t now) const;
  std::uint32_t read_clock(kernel::Time& time) const;
  bool latch(kernel::Time time, std::uint32_t now, bool anyway);
  ChannelMask latch_channels(ChannelMask announced, ChannelMask expired, const Stamp& stamp);
  void report_input(unsigned channel, bool expired, const Stamp& stamp);
  bool is_news(unsigned channel, vm::Value before, vm::Value value) const;
  VariableMask latch_variables(const Stamp& stamp);
  [[gnu::cold]] void report_beginnings();
  void report_set(unsigned variable, const Stamp& stamp);
  std::uint32_t next_due(std::uint32_t now) const;
  void add_waiting(unsigned rule, Soonest& due) const;
  void add_wanting(unsigned rule, Soonest& due, std::uint32_t now) const;
  kernel::Time next_time();
  [[gnu::cold, gnu::noinline]] void give_way();
  [[gnu::cold]] void note_stops();
  [[gnu::cold]] void retire(const ProgramThreads::Member& member);

  // --- which rules a step concerns ---
  void find_concerned();
  [[gnu::noinline]] void touch();
  bool stirred(unsigned behavior) const;

  // --- what happens in a step ---
  void step();
  RuleSet::Two next_at_work(unsigned rule) const;
  bool has_sole_turn(unsigned rule, unsigned next, RuleRange rules) const;
  void take_sole_turn(unsigned rule, bool is_last);
  void send_at_once(unsigned rule, ActuatorMask actuators);
  void send_if_undisputed(unsigned rule, bool may_go_on);
  [[gnu::noinline]] void take_turn(unsigned behavior, RuleRange rules);
  [[gnu::cold]] void interrupt_lost(BehaviorMask lost);
  [[gnu::cold]] void interrupt_halted(ActuatorMask halted);
  void collect(unsigned rule);
  void arbitrate(unsigned rule);
  bool serve(const Claim& claim, bool silent);
  bool decide(const Claim& claim, bool silent);
  void give(const Claim& claim);
  [[gnu::noinline]] bool prevails(const Claim& claim, bool silent);
  [[gnu::cold]] unsigned in_the_way(const Claim& claim, const Decision& decision) const;
  [[gnu::noinline]] void interrupt_by(const Claim& claim, const Decision& decision);
  void interrupt(unsigned rule, unsigned by);
  bool goes_on(unsigned rule) const;
  void run_response(unsigned rule);
  [[gnu::always_inline]] void await_behavior();
  [[gnu::cold, gnu::noinline]] void note_stops_at_work();
  void conclude(unsigned rule);
  void cancel_interrupted() {
    if (cancelled_ != 0) cancel_some();
  }
  [[gnu::noinline]] void cancel_some();
  void report(const Claim& claim, link::EventKind kind, unsigned object = 0);

  unsigned channels() const { return static_cast<unsigned>(program_->image.channels.size()); }

  template <class Pending>
  void await(kernel::Events event, Pending pending) {
    while (pending())
      if ((kernel_.wait(event | kStopped) & kStopped) != 0) note_stops();
  }

  kernel::Kernel& kernel_;
  Trace& trace_;
  kernel::Thread& thread_;
  Neighbours layers_;
  const LoadedProgram* program_ = nullptr;
  Checks checks_;
  Adaptation adaptation_;
  Snapshot snapshot_;
  Thresholds thresholds_;
  RuleSet concerned_;                // evaluated in this step
  InputMask changed_ = 0;            // in this step, so that it makes a difference to rules
  BehaviorMask woken_ = 0;           // with a rule that is due in this step
  BehaviorMask untouched_ = 0;       // none of their rules was ever evaluated …
  InputMask untouched_inputs_ = 0;   // … and what they read
  std::uint32_t set_due_ = 0;        // when staged writes may take effect
  ActuatorMask cancelled_ = 0;       // of interrupted responses, still to be cancelled
  BehaviorMask lost_behaviors_ = 0;  // stopped; their responses are still to be interrupted
  BehaviorMask unstarted_ = 0;       // with something to do before the first reading
  std::atomic<std::uint32_t> passes_ = 0;
  std::atomic<bool> in_pass_ = false;
  LinkShare link_share_;
  bool saves_no_work_ = false;  // in builds for tests: see is_news() and has_sole_turn()
};

}  // namespace robosync::layers
