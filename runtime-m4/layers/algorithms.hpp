// The algorithms of a program: each is a module of the firmware (algorithms/) in a thread without privileges, which has its own
// stack, the module's data on it, and no other memory.
//
// One thread with privileges serves them all. When an input was sampled, or, where it is fed, at the algorithm's
// period, it hands the latest readings over and releases the module's thread. That outranks it, so when it runs
// again the module is done, and what it made goes where readings go, in one announcement, with the time of the readings
// that it was made of: so it grows stale when they do. While an input is unknown the module does not run; then
// it begins anew.
//
// Nothing that a module leaves is believed: outputs are cut off at the range of their channels. Its run time in
// one release is held to a budget, twice the cycles of what it declares and what interrupts may take meanwhile. The
// first time it is over, it is lowered: its thread ranks below all behaviours from then on. The second time, and
// when it goes on and on, it is stopped, as for a fault, and its channels become unknown. A module
// that never ends is seen by the safety monitor, at its next check; the step thread lowers it, since that outranks all
// algorithms and changes ranks alone. Where time does not flow nobody is ever over.
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
  // `lower` of `step_thread` is signalled when it is to call lower_those_over().
  AlgorithmLayer(kernel::Kernel& kernel, Trace& trace, Mailboxes& mailboxes, SensorLayer& sensors,
                 kernel::Thread& step_thread, kernel::Events lower)
      : kernel_(kernel),
        trace_(trace),
        mailboxes_(mailboxes),
        sensors_(sensors),
        step_thread_(step_thread),
        lower_(lower) {}

  // Creates the threads of `program`, which must stay until they are dismissed. After the sensors'.
  [[nodiscard, gnu::cold]] bool start(const LoadedProgram& program, Memory& memory,
                                      ProgramThreads& threads);
  // Program time begins.
  void begin() {
    if (server_ != nullptr) kernel_.signal(*server_, kBegin);
  }

  // Who runs on and on is lowered, then stopped.  [the safety thread]
  void hold_to_budgets() {
    if (!units_.empty()) [[unlikely]]
      look_at_budgets();
  }
  [[gnu::cold]] void lower_those_over(ProgramThreads& threads);  // [the step thread]
  // Its thread was stopped: what it makes is no longer known.
  [[gnu::cold]] void retire(unsigned sensor);

private:
  static constexpr kernel::Events kBegin = 2;  // besides SensorLayer::kSampled
  static constexpr kernel::Events kReleased = 1;
  // Counts of the clock that interrupts may take in one release: what both buffers of the line hold may come and go at once
  // where nothing paces it, as in an emulator.
  static constexpr std::uint32_t kInterrupts = 50'000;

  // How a module stands with its budget.
  enum class Conduct : std::uint8_t { good, over, lowered };

  // At the beginning of a module's stack: what it gets and gives, then its parameters, its state and its scratch. It may write all
  // of that, so nothing of it is believed.
  struct Data {
    kernel::Kernel* kernel = nullptr;
    const robosync_module* module = nullptr;
    std::uint32_t period_ms = 0;
    std::uint32_t begins = 0;   // init() comes first
    std::uint32_t changed = 0;  // what process() has returned
    std::int32_t inputs[ROBOSYNC_MOST_INPUTS] = {};
    std::int32_t outputs[ROBOSYNC_MOST_OUTPUTS] = {};
    std::int32_t config[ROBOSYNC_MOST_PARAMETERS] = {};
    alignas(8) std::byte memory[ROBOSYNC_MOST_BYTES] = {};
  };

  struct Unit {
    kernel::Thread* thread = nullptr;
    Data* data = nullptr;
    kernel::Time due = 0;                  // of an input that is fed: its next sample
    kernel::Time seen = kernel::kForever;  // when the readings that it has had were taken
    std::uint32_t budget = 0;              // counts of the clock for one release
    std::uint32_t run_time = 0;            // … when it was released
    std::uint8_t sensor = 0;               // that its outputs are channels of
    bool released = false;                 // and has not been seen to be done
    bool told = false;                     // in this release it was over once
    Conduct conduct = Conduct::good;       // changed under a lock
  };

  [[nodiscard]] bool start_server(ProgramThreads& threads);
  [[nodiscard]] bool start_unit(Unit& unit, ProgramThreads& threads);
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
