// The algorithms of a program. Each is a module of the firmware (algorithms/) in an unprivileged thread, which has its own
// stack with the module's data on it, and no other memory.
//
// One privileged thread serves them all. When an input was sampled, or at the algorithm's period if the input is fed,
// it hands over the latest readings and releases the module's thread. That thread outranks it, so when the server runs
// again the module is done. The module's results are published like readings, in one announcement, with the time of the
// readings that they were made of: so they grow stale when those do. While an input is unknown the module does not run;
// afterwards it starts over.
//
// Nothing that a module leaves is trusted: outputs are clamped to the range of their channels. Its run time in
// one release is bounded by a budget: twice its declared cost in cycles, plus what interrupts may take meanwhile. The
// first time it exceeds the budget it is lowered: its thread ranks below all behaviours from then on. The second time, and
// if it runs on and on, it is stopped as for a fault, and its channels become unknown. The safety monitor notices
// a module that never ends, at its next check; the step thread lowers it, since it outranks all
// algorithms and is the only one that changes ranks. Where time does not flow, no module is ever over.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "runtime-m4/algorithms/robosync_module.h"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/mailbox.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/sensor.hpp"
#include "runtime-m4/layers/trace.hpp"

namespace robosync::layers {

class AlgorithmLayer {
public:
  // `lower` of `step_thread` is signalled when it must call lower_those_over().
  AlgorithmLayer(kernel::Kernel& kernel, Trace& trace, Mailboxes& mailboxes, SensorLayer& sensors,
                 kernel::Thread& step_thread, kernel::Events lower)
      : kernel_(kernel),
        trace_(trace),
        mailboxes_(mailboxes),
        sensors_(sensors),
        step_thread_(step_thread),
        lower_(lower) {}

  // Creates the threads of `program`, which must stay in place until they are dismissed. After the sensors'.
  [[nodiscard, gnu::cold]] bool start(const LoadedProgram& program, Memory& memory,
                                      ProgramThreads& threads);
  // Program time begins.
  void begin() {
    if (server_ != nullptr) kernel_.signal(*server_, kBegin);
  }

  // A module that runs on and on is lowered, then stopped.  [the safety thread]
  void hold_to_budgets() {
    if (!units_.empty()) [[unlikely]]
      look_at_budgets();
  }
  [[gnu::cold]] void lower_those_over(ProgramThreads& threads);  // [the step thread]
  // Its thread was stopped: its outputs are no longer known.
  [[gnu::cold]] void retire(unsigned sensor);

private:
  static constexpr kernel::Events kBegin = 2;  // besides SensorLayer::kSampled
  static constexpr kernel::Events kReleased = 1;
  // Cycles that interrupts may take in one release. Where nothing paces the line, as in an emulator, the contents of both its
  // buffers may come and go in one go.
  static constexpr std::uint32_t kInterrupts = 50'000;

  // A module's record with its budget.
  enum class Conduct : std::uint8_t { good, over, lowered };

  // At the bottom of a module's stack: its inputs and outputs, its parameters, then its state and its scratch memory. It may write
  // all of that, so nothing of it is trusted.
  struct alignas(8) Data {
    kernel::Kernel* kernel = nullptr;
    const robosync_module* module = nullptr;
    std::uint32_t period_ms = 0;
    std::uint32_t begins = 0;   // init() must run first
    std::uint32_t changed = 0;  // returned by process()
    std::int32_t inputs[ROBOSYNC_MOST_INPUTS] = {};
    std::int32_t outputs[ROBOSYNC_MOST_OUTPUTS] = {};
    std::int32_t config[ROBOSYNC_MOST_PARAMETERS] = {};

    std::byte* memory() { return reinterpret_cast<std::byte*>(this + 1); }
  };

  struct Unit {
    kernel::Thread* thread = nullptr;
    Data* data = nullptr;
    kernel::Time due = 0;                  // for a fed input: the next sample
    kernel::Time seen = kernel::kForever;  // when the readings that it last got were taken
    std::uint32_t budget = 0;              // for one release, in counts of the clock
    std::uint32_t run_time = 0;            // … of the thread, when it was released
    std::uint8_t sensor = 0;               // the sensor whose channels are its outputs
    bool released = false;                 // and not yet seen to be done
    bool told = false;                     // it was over once in this release
    Conduct conduct = Conduct::good;       // changed under a lock
  };

  [[nodiscard]] bool start_server(ProgramThreads& threads);
  [[nodiscard]] bool start_units(const policy::BoardMemory& board, ProgramThreads& threads);
  [[nodiscard]] bool start_unit(Unit& unit, std::span<std::byte> stack, ProgramThreads& threads);
  void fill(Unit& unit, Data& data) const;
  static void run_module(Data& data);
  void run();
  void note_begin();
  kernel::Time next_due() const;
  bool is_timed(const Unit& unit) const;
  bool is_due(Unit& unit, kernel::Time now);
  void serve(Unit& unit, kernel::Time now);
  bool latch(Unit& unit, kernel::Time now);
  bool latch_inputs(Unit& unit, kernel::Time now);
  void show_constants(const Unit& unit);
  void release(Unit& unit);
  void collect(Unit& unit);
  bool is_done(const Unit& unit) const;
  bool is_over(const Unit& unit, std::uint32_t times) const;
  [[gnu::cold]] void look_at_budgets();
  [[gnu::cold]] void punish(Unit& unit);
  const vm::Sensor& wiring_of(const Unit& unit) const {
    return program_->image.sensors[unit.sensor];
  }

  kernel::Kernel& kernel_;
  Trace& trace_;
  Mailboxes& mailboxes_;
  SensorLayer& sensors_;
  kernel::Thread& step_thread_;
  kernel::Events lower_;
  const LoadedProgram* program_ = nullptr;
  kernel::Thread* server_ = nullptr;
  std::span<Unit> units_;
  bool begun_ = false;  // [the serving thread]
};

}  // namespace robosync::layers
