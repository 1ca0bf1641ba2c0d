// Safety monitor: the thread of the highest rank. It evaluates the safety rules, checks every 10 ms
// that the program is alive, and kicks the watchdog as long as it is.
//
// Before program time begins, it evaluates the rules when one of their inputs has changed, and when the wait for the
// sensors is over. Its periods are in program time, beginning at 0: at each it evaluates the rules and checks the
// program's liveness, once. In between it evaluates the rules when one of their inputs has changed or one
// of their time words is due. So the time at which a rule trips depends on the program and its readings only, not on
// when the board was switched on.
//
// A program hangs when its step thread has work and has not finished a pass for kChecksUntilHung checks
// in a row. Then the monitor halts the actuators, again at every check, and stops kicking the watchdog, which
// resets the board. The monitor keeps running during uploads and activations.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/safety/period.hpp"

namespace robosync::safety {

// What the monitor supervises. Called from the safety thread.
class Supervised {
public:
  virtual bool resting() const = 0;            // true if it has nothing to do
  virtual std::uint32_t progress() const = 0;  // changes with every piece of work it finishes
  // Called at each check. `alive`: since the last check it has finished work, or had none. If not, a
  // thread that delays it may be stopped.
  virtual void hold_to_budgets(bool alive) = 0;
  // Puts all actuators into their safe state, and blocks all commands from then on. May be called
  // again.
  virtual void halt(kernel::Duration stuck_for) = 0;
  // Called at each check: moves outputs on that may only change gradually.
  virtual void tend_outputs() = 0;
  // A person has ordered a stop or a resume.
  virtual void obey() = 0;
  // Evaluates the safety rules. Returns the time at which a time word of theirs is due.
  virtual kernel::Time look_at_rules() = 0;
  virtual bool running() const = 0;        // is there a program?
  virtual kernel::Time began() const = 0;  // its time 0, or the latest time at which that will be

protected:
  ~Supervised() = default;
};

class Monitor {
public:
  static constexpr unsigned kChecksUntilHung = 5;

  Monitor(kernel::Kernel& kernel, boards::Board& board, Supervised& supervised)
      : kernel_(kernel), board_(board), supervised_(supervised) {}

  // Creates the thread. False if the kernel has no room for it.
  [[nodiscard]] bool start();

  // Events of the thread. kNews: an input that a safety rule reads has changed. kProgram: there is
  // another program. kPerson: a person has ordered a stop or a resume.
  static constexpr kernel::Events kNews = 1;
  static constexpr kernel::Events kProgram = 2;
  static constexpr kernel::Events kPerson = 4;
  kernel::Thread& thread() { return thread_; }

  std::uint32_t checks() const { return checks_.load(std::memory_order_relaxed); }
  std::uint32_t worst_lateness() const { return late_.load(std::memory_order_relaxed); }  // us

private:
  static constexpr std::size_t kStack = 512;

  void run();
  kernel::Time next_after(kernel::Time due, kernel::Time now) const;
  void check(kernel::Duration late);

  kernel::Kernel& kernel_;
  boards::Board& board_;
  Supervised& supervised_;
  std::atomic<std::uint32_t> checks_ = 0;
  std::atomic<std::uint32_t> late_ = 0;
  std::uint32_t last_progress_ = 0;
  unsigned without_progress_ = 0;  // checks in a row
  std::uint32_t idle_us_ = 0;
  kernel::Thread thread_;
  alignas(port::kStackAlignment) std::array<std::byte, kStack> stack_{};
};

}  // namespace robosync::safety
