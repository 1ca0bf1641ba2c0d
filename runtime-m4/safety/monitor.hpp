// Safety monitor: a thread above all others that looks after the safety rules, checks every 10 ms
// that the program is alive, and keeps the watchdog from resetting the board as long as it is.
//
// Before program time begins it looks at the rules when one of their inputs has changed, and when the time
// for that is over. Its periods are those of program time, beginning with 0: at each it looks at the rules and at the
// program's life, once. In between it looks at the rules when one of their inputs has changed or one
// of their time words is due. So when a rule trips depends on the program and its readings alone, not on
// when the board was switched on.
//
// A program is hung when its step thread has work and has not finished a pass for kChecksUntilHung checks
// in a row. Then the actuators are halted, again at every check, and the watchdog is left alone: it
// resets the board. The monitor goes on through uploads and activations.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/safety/period.hpp"

namespace robosync::safety {

// What the monitor watches over. Called from the safety thread.
class Supervised {
public:
  virtual bool resting() const = 0;            // it has nothing to do
  virtual std::uint32_t progress() const = 0;  // changes with every piece of work it finishes
  // Called at each check: did it finish any, or had nothing to do, since the last one? If it did
  // not, who holds it up may be stopped.
  virtual void hold_to_budgets(bool alive) = 0;
  // Puts all actuators into their safe state, and lets no command through from then on. May be
  // called again.
  virtual void halt(kernel::Duration stuck_for) = 0;
  // Called at each check: outputs that may not change at once go on.
  virtual void tend_outputs() = 0;
  // A person has said stop, or resume.
  virtual void obey() = 0;
  // Evaluates the safety rules. Returns when a time word of theirs is due.
  virtual kernel::Time look_at_rules() = 0;
  virtual bool running() const = 0;        // is there a program?
  virtual kernel::Time began() const = 0;  // its time 0, or when that will be there at the latest

protected:
  ~Supervised() = default;
};

class Monitor {
public:
  static constexpr unsigned kChecksUntilHung = 5;

  Monitor(kernel::Kernel& kernel, boards::Board& board, Supervised& supervised)
      : kernel_(kernel), board_(board), supervised_(supervised) {}

  // Creates the thread. False when the kernel has no place for it.
  [[nodiscard]] bool start();

  // Signalled (kNews) when an input has changed that a safety rule reads, and
  // (kProgram) when there is another program, and (kPerson) when a person has said stop or resume.
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
