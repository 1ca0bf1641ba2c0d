// What the kernel needs from a machine. Each port defines these names, inline where the kernel is
// time-critical:
//
//   struct Context          The saved state of a thread that does not run.
//   struct RunClock         Measures how long the running thread has been running.
//   kStackAlignment         Alignment of stacks at which no bytes are wasted.
//   kTimeFlows              Does time pass while threads run? On the host it advances only when all
//                           threads are blocked.
//   kCyclesPerCount         Cycles of the core's clock in one count of Machine::clock().
//   kArenaScale             A program's data may take this many times the bytes it takes on the Cortex-M4.
//   kMinStack               Minimum stack of a thread, in bytes.
//   kUnprivilegedStackAlignment, kMaxUnprivilegedStack   Alignment and maximum bytes of an unprivileged thread's stack.
//   struct Areas            What unprivileged threads may access besides their stacks: a readable area
//                           and a writable one, which may lie inside the readable one.
//   class Sandbox           Lets the thread of the highest rank run an unprivileged function: set(window, stack_top,
//                           function), then call() with its three arguments.
//   struct CallFrame        A system call that the kernel handles: number(), argument(); give(result),
//                           or repeat(): the thread makes the call again when it runs next.
//   call(kernel, number, argument)       Makes a system call from an unprivileged thread: calls
//                                        Kernel::answer() and returns its result.
//   stop_overrun(kernel, thread)         Stops a thread that runs longer than it may, not the calling
//                                        one, and reports a fault.
//   fetch_and_clear(word, mask)   Clears bits and returns the previous word; changes that an interrupt
//                                 makes meanwhile are not lost.
//   class Lock(Machine&)    Critical section, RAII, nests. Holds off interrupts of the kernel's level
//                           (never those above it), and delays a requested switch until the outermost
//                           Lock ends.
//   class OnlyLock(Machine&)  A Lock for a caller that holds no lock of either kind; may be cheaper.
//   class SwitchLock(Machine&)  The weaker lock: no switch and no tick, but interrupts are still taken.
//                           It may be nested in a Lock, and the other way round.
//   enum class Mode         The mode: init (no thread runs yet), thread, handler (of an interrupt).
//   enum class Held         The lock that is held: none, switch_lock, lock.
//   panic(service, why)     Called when an assertion fails (kernel/assertions.hpp): halts everything.
//   class Machine(Kernel&)  The processor a kernel runs on:
//     mode(), held()                For assertions. held() is valid in modes thread and handler.
//     may_call()                    Does the caller run at the kernel's level, or below it?
//     usable(spec)                  The usable part of a thread's stack: without alignment and guard.
//     can_run(spec)                 Does the stack meet the requirements of an unprivileged thread?
//     grant(areas)                  Lets unprivileged threads access `areas`. Under a Lock.
//     prepare(context, spec, stack) Makes a thread start with entry(argument) on a usable stack;
//                                   when entry returns, the thread is stopped.
//     prepare_idle(context)         Sets up the idle thread's context; returns its usable stack.
//     clock()                       A counter that counts down while threads run, and wraps at 32
//                                   bits; stands still where kTimeFlows is false.
//     run_time(context, run_clock, runs)   Counts of clock() for which the thread has run; `runs` if
//                                   it is the running one. Under a Lock.
//     refuse_call()                 An unprivileged thread has made a call that does not exist.
//     request_switch()              Runs Kernel::select_next() and switches, as soon as no Lock is
//                                   held and no interrupt handler runs.
//     run()                         Runs threads; the caller becomes the idle thread.
#pragma once

#if defined(__arm__)
#include "runtime-m4/port/cortex-m4/machine.hpp"  // IWYU pragma: export
#else
#include "runtime-m4/port/host/machine.hpp"  // IWYU pragma: export
#endif
