// The runtime of one robot: the safety thread, and the program's threads and layers, which are built
// from an image. It is the same on the board (boards/common/main.cpp) and on the host (sim/simulator.cpp).
//
// The memory of a program is in the arena, laid out anew at each activation (layers/memory.hpp). The
// object itself holds the parts that exist without a program, such as the kernel's and safety's control
// blocks, and those that the behaviours' threads may not access.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/alarm.hpp"
#include "runtime-m4/layers/algorithms.hpp"
#include "runtime-m4/layers/behavior.hpp"
#include "runtime-m4/layers/budget.hpp"
#include "runtime-m4/layers/control.hpp"
#include "runtime-m4/layers/event_sink.hpp"
#include "runtime-m4/layers/frames.hpp"
#include "runtime-m4/layers/kept.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/mailbox.hpp"
#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/processing.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/sampler.hpp"
#include "runtime-m4/layers/sensor.hpp"
#include "runtime-m4/layers/trace.hpp"
#include "runtime-m4/layers/triggers.hpp"
#include "runtime-m4/layers/variables.hpp"
#include "runtime-m4/layers/workspace.hpp"
#include "runtime-m4/safety/monitor.hpp"
#include "runtime-m4/safety/safety_rules.hpp"
#include "vm/verifier.hpp"

namespace robosync {

class Runtime final : private safety::Supervised {
public:
  // `arena` is the memory for programs that `memory` describes (layers::Memory). Only the runtime uses
  // it.
  Runtime(kernel::Kernel& kernel, boards::Board& board, EventSink& events,
          std::span<std::byte> arena, const policy::BoardMemory& memory);

  // Creates the safety thread. Call it once, before Kernel::run(). False if the kernel has no room.
  bool start();

  // Verifies `image` and, if it may run and fits, replaces the running program with a copy of it;
  // otherwise the running program continues. `named`: the image's name is the one computed from its
  // bytes; if not, the image is refused, after all other checks. Call it before Kernel::run(), or from
  // a thread of category `system`: that has the lowest rank, so no step is in progress when it runs.
  vm::Verdict activate(std::span<const std::byte> image, bool named = true);
  // Ends the running program and releases its actuators.  [as activate()]
  void clear();

  // Memory that is unused until the next activation, at most as large as an image may be: the next
  // image may be received into it.
  std::span<std::byte> room() {
    const std::span<std::byte> room = memory_.room();
    return room.first(std::min<std::size_t>(room.size(), limits_.image_bytes));
  }
  // The needs of the running program, and those of the last one that activate() has verified.
  const policy::Needs& needs() const { return memory_.needs(); }
  const policy::Needs& checked_needs() const { return next_; }
  const policy::BoardMemory& board_memory() const { return memory_.board(); }

  // A person's order: all outputs go to their safe state immediately and stay there, whatever program runs, until
  // resume(). Actuators that the running program's SAFETY rules halt stay halted after that.  [thread]
  void stop() { say(true); }  // or from an interrupt of the kernel's level
  void resume() { say(false); }
  bool stopped() const { return stopped_; }
  // Gives the link's thread its share of the processor, whatever the program does. Before Kernel::run().
  void share_with(const kernel::Thread& link) { shared_.processing.share_with(link); }
  // Kernel::wait() for the link's thread when it has nothing more to do; ends its turn.  [the link's thread]
  kernel::Events rest_link(kernel::Events mask, kernel::Time deadline) {
    return shared_.processing.rest_link(mask, deadline);
  }
  // The SAFETY rules of the running program that have tripped since it began: safety/safety_rules.hpp.
  std::size_t fill_tripped(std::span<std::uint32_t> keys) const {
    return running_ ? safety_rules_.fill_tripped(keys) : 0;
  }
  bool has_tripped_besides(std::span<const std::uint32_t> known) const {
    return running_ && safety_rules_.have_tripped_besides(known);
  }

  // A reading for a fed channel: now (at_us 0) or at a program time. Sensors with the driver
  // virtual_sensor or with period 0 are fed. The unknown value is a failed reading.
  // From a thread that the program outranks: one for now has had its effect when this returns.
  link::FeedResult feed(const link::Feed& feed);
  // From outside of all threads, as a simulation does: the program takes it when it runs on.
  link::FeedResult enqueue(const link::Feed& feed);

  // Fills in everything except bad_frames and lost_events, which only the link knows.
  void fill_status(link::Status& status) const;
  void fill_devices(link::Devices& devices) const;
  // Whether anything answers there, whatever runs. Takes a few milliseconds.  [the link's thread]
  link::Probed probe(const link::Probe& at);
  // The values from input `first` on.
  void fill_state(link::State& state, std::uint32_t first) const;
  bool running() const override { return running_; }
  const vm::Image& image() const { return shared_.program.image; }  // of the running program
  const vm::Limits& limits() const { return limits_; }

  // What the next programs begin with: their KEPT numbers with those in `kept`, a table that must stay valid; and with `carries`, the
  // other variables with the values of the program that runs before (layers/carried.hpp). Before activate().
  void begin_with(std::span<const layers::KeptNumber> kept, bool carries = false) {
    kept_ = kept;
    carries_ = carries;
  }
  // The current values of the running program, all from the same step. Returns how many.
  std::size_t fill_kept(std::span<layers::KeptNumber, vm::kMaxKept> kept) const;

  // Measures with `sampler` instead of the drivers. Before activate().
  // This makes it a simulation: its program does not wait for first readings.
  void measure_with(layers::Sampler& sampler) { sampler_ = &sampler; }
  // What measures otherwise.
  layers::Sampler& drivers() { return drivers_; }

  // The seed of the random numbers, which overrides that of the image. 0: the image's seed; if the image
  // has none, 1 in a simulation, and a new one each time on a board. Before activate().
  void draw_from(std::uint32_t seed) { given_seed_ = seed; }

private:
  friend struct RuntimePeer;

  // What the behaviours' threads may read. At the start of the arena.
  struct Shared {
    layers::LoadedProgram program;
    layers::Workspace workspace;
    layers::Frames frames;
    layers::Triggers triggers;
    layers::Arbiter arbiter;
    layers::BehaviorLayer behaviors;
    layers::ProcessingLayer processing;
  };

  bool resting() const override { return !running_ || shared_.processing.resting(); }
  std::uint32_t progress() const override { return shared_.processing.passes(); }
  void hold_to_budgets(bool alive) override;
  void halt(kernel::Duration stuck_for) override;
  kernel::Time look_at_rules() override;
  [[gnu::cold, gnu::noinline]] kernel::Time look_at_feeds();
  void tend_outputs() override { outputs_.go_on(kernel_.now()); }
  void obey() override;
  kernel::Time began() const override { return trace_.activated_at(); }

  Shared& share(std::span<std::byte> arena);
  [[gnu::noinline]] vm::Verdict check(std::span<const std::byte> bytes);
  [[gnu::noinline]] bool load(std::span<const std::byte> bytes);
  void end_program();
  void say(bool stopped);
  [[gnu::noinline]] bool change_to(std::span<const std::byte> bytes);
  [[gnu::noinline]] void take_values(layers::Carried& carried) const;
  [[gnu::noinline]] bool start_program(const layers::Carried& carried);
  std::uint32_t choose_seed(std::uint32_t of_image) const;
  void go();
  bool simulated() const { return sampler_ != &drivers_; }
  void begin();

  kernel::Kernel& kernel_;
  boards::Board& board_;
  layers::Memory memory_;
  vm::Limits limits_;
  policy::Needs next_;  // of the latest image that was checked

  std::atomic<bool> running_ = false;
  std::atomic<bool> stopped_ = false;  // a person's latest order
  bool halted_ = false;                // safety has halted this program
  bool begun_ = false;                 // program time has begun; only while a program runs
  std::uint16_t activations_ = 0;
  std::uint32_t given_seed_ = 0;
  std::span<const layers::KeptNumber> kept_;
  bool carries_ = false;
  unsigned faults_ = 0;  // of previous programs
  safety::Monitor monitor_;
  layers::Budget budget_;
  kernel::Thread step_thread_;
  layers::ProgramThreads threads_;

  layers::Mailboxes mailboxes_;
  layers::SensorLayer sensors_;
  layers::AlgorithmLayer algorithms_;
  guard::OutputGuard outputs_;
  layers::ControlLayer control_;
  layers::Variables variables_;
  layers::DriverSampler drivers_;
  layers::Sampler* sampler_ = &drivers_;
  layers::Alarm alarm_;
  layers::Trace trace_;
  Shared& shared_;
  safety::SafetyRules safety_rules_;
};

}  // namespace robosync
