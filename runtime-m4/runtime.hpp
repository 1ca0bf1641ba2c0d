// The runtime of one robot: the safety thread, and the program's threads and layers made from an
// image. The same on the board (boards/common/main.cpp) and on the host (sim/simulator.cpp).
//
// All memory is inside the object, the workspace and the image, and sized by limits.hpp: put them
// into static storage, on the board the image behind the object. The members stand in the order of
// what is closed to the behaviours' threads: see layout().
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/alarm.hpp"
#include "runtime-m4/layers/behavior.hpp"
#include "runtime-m4/layers/budget.hpp"
#include "runtime-m4/layers/control.hpp"
#include "runtime-m4/layers/event_sink.hpp"
#include "runtime-m4/layers/frames.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/mailbox.hpp"
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
  Runtime(kernel::Kernel& kernel, boards::Board& board, EventSink& events,
          layers::Workspace& workspace);

  // Creates the safety thread. Once, before Kernel::run(). False when the kernel has no place.
  bool start();

  // Verifies `image` and, if it may run, puts it in the place of the running program; otherwise the
  // running program goes on. `image` must stay as it is until the next activation. Called from a
  // thread of category `system`: it has the lowest rank, so when it runs no step is under way. Or
  // before Kernel::run().
  vm::Verdict activate(std::span<const std::byte> image);

  // A reading for a fed channel: now (at_us 0) or at a program time. Sensors are fed whose driver
  // is virtual_sensor, and those with period 0. The unknown value is a reading that failed.
  link::FeedResult feed(const link::Feed& feed);

  // Everything but what only the link knows: bad_frames and lost_events.
  void fill_status(link::Status& status) const;
  bool running() const override { return running_; }
  const vm::Image& image() const { return program_.image; }  // of the running program
  static const vm::Limits& limits();

  // Offsets in the object, for the board's linker script, which looks whether it is so: behind
  // `readable` the behaviours' threads read what they need. The region that lets them may begin
  // earlier, by up to an eighth of its size, but not before `may_be_readable`: there stand the
  // kernel's and the safety monitor's control blocks, and all stacks.
  struct Layout {
    std::size_t may_be_readable, readable;
  };
  static constexpr Layout layout();

  // Measures with `sampler` in place of the drivers. Before activate().
  void measure_with(layers::Sampler& sampler) { sampler_ = &sampler; }

private:
  friend struct RuntimePeer;

  bool resting() const override { return !running_ || processing_.resting(); }
  std::uint32_t progress() const override { return processing_.passes(); }
  void hold_to_budgets(bool alive) override;
  void halt(kernel::Duration stuck_for) override;
  kernel::Time look_at_rules() override;
  kernel::Time began() const override { return trace_.activated_at(); }

  bool start_program();
  void go();
  port::Areas areas();

  kernel::Kernel& kernel_;
  boards::Board& board_;

  std::atomic<bool> running_ = false;
  bool halted_ = false;  // this program, by safety
  std::uint16_t activations_ = 0;
  unsigned faults_ = 0;  // of programs that are gone
  safety::Monitor monitor_;
  safety::SafetyRules safety_rules_;
  layers::Budget budget_;
  kernel::Thread step_thread_;
  layers::ProgramThreads threads_;

  // From here on layout().may_be_readable: nothing of the kernel and of safety, no stack.
  layers::Mailboxes mailboxes_;
  layers::SensorLayer sensors_;
  layers::ControlLayer control_;
  layers::Variables variables_;
  layers::DriverSampler drivers_;
  layers::Sampler* sampler_ = &drivers_;
  layers::Alarm alarm_;
  layers::Trace trace_;

  // From here on layout().readable, and behind the object the image.
  alignas(layers::kReadableAlignment) layers::LoadedProgram program_;
  layers::Frames frames_;
  layers::Triggers triggers_;
  layers::Arbiter arbiter_;
  layers::BehaviorLayer behaviors_;
  layers::ProcessingLayer processing_;
};

// offsetof is only guaranteed for simpler classes; both our compilers give it for all that have no
// virtual bases.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
constexpr Runtime::Layout Runtime::layout() {
  constexpr Layout kLayout{.may_be_readable = offsetof(Runtime, mailboxes_),
                           .readable = offsetof(Runtime, program_)};
  static_assert(offsetof(Runtime, monitor_) < kLayout.may_be_readable);
  static_assert(offsetof(Runtime, safety_rules_) < kLayout.may_be_readable);
  static_assert(offsetof(Runtime, budget_) < kLayout.may_be_readable);
  static_assert(offsetof(Runtime, step_thread_) < kLayout.may_be_readable);
  static_assert(offsetof(Runtime, threads_) < kLayout.may_be_readable);
  static_assert(kLayout.readable < offsetof(Runtime, frames_));
  static_assert(kLayout.readable < offsetof(Runtime, triggers_));
  static_assert(kLayout.readable < offsetof(Runtime, arbiter_));
  static_assert(kLayout.readable < offsetof(Runtime, behaviors_));
  static_assert(kLayout.readable < offsetof(Runtime, processing_));
  return kLayout;
}
#pragma GCC diagnostic pop

}  // namespace robosync
