// What the kernel needs of a machine. Each port defines these names, with inline bodies where the
// kernel is in a hurry:
//
//   struct Context          What a thread leaves behind while it does not run.
//   struct RunClock         What it notes of how long the running thread has been running.
//   kStackAlignment         How stacks should be aligned, so that nothing of them is wasted.
//   kTimeFlows              Does time pass while threads run? On the host it stands still until all
//                           wait.
//   kArenaScale             How many times the bytes of the Cortex-M4 what a program needs may take here.
//   kMinStack               Least bytes of stack a thread must have.
//   kUnprivilegedStackAlignment, kMaxUnprivilegedStack   What the stack of a thread without privileges must be.
//   kSecludedStack          … and of one with data on its stack, and nothing else: bytes, and alignment.
//   struct Areas            What threads without privileges may use besides their stacks: what is
//                           readable and, perhaps inside of it, writable.
//   class Sandbox           Lets the thread of the highest rank run a function without privileges: set(window, stack_top,
//                           function), then call() with its three arguments.
//   struct CallFrame        A system call that is being answered: number(), argument(); give(result),
//                           or repeat(): the thread makes it again when it runs next.
//   call(kernel, number, argument)       Makes one: Kernel::answer() from a thread without
//                                        privileges. Its result.
//   stop_overrun(kernel, thread)         Stops a thread, not the calling one, that runs longer than
//                                        it may, and reports it as a fault.
//   fetch_and_clear(word, mask)   Clears bits and returns what was there; an interrupt that changes
//                                 the word meanwhile is not lost.
//   class Lock(Machine&)    Critical section, RAII, nests. Keeps out the kernel's own interrupts
//                           (never those above its level) and holds a requested switch back until
//                           the outermost one ends.
//   class OnlyLock(Machine&)  The same, for who holds no Lock; may be cheaper.
//   class SwitchLock(Machine&)  The weaker one: no switch and no tick, but interrupts come in. It
//                           may stand inside of a Lock, and around one.
//   enum class Mode         What runs: init (no thread does yet), thread, handler (of an interrupt).
//   enum class Held         What holds others off: none, switch_lock, lock.
//   panic(service, why)     An assertion did not hold (kernel/assertions.hpp): ends everything.
//   class Machine(Kernel&)  The processor a kernel runs on:
//     mode(), held()                For assertions. `held` counts for thread and handler.
//     may_call()                    Is what runs of the kernel's level, or below it?
//     usable(spec)                  What a thread can use of its stack: without alignment, guard.
//     can_run(spec)                 Is its stack as a thread without privileges needs it?
//     grant(areas)                  Gives those threads what they may use. Under a Lock.
//     prepare(context, spec, stack) Makes a thread start with entry(argument) on a usable stack;
//                                   when that returns, the thread is stopped.
//     prepare_idle(context)         The idle thread's context; returns its usable stack.
//     clock()                       A counter that counts down while threads run, and wraps at 32
//                                   bits; stands still where kTimeFlows is false.
//     run_time(context, run_clock, runs)   How much of it passed while the thread ran, which does now
//                                   if `runs`. Under a Lock.
//     refuse_call()                 A thread without privileges has made a call that there is not.
//     request_switch()              Runs Kernel::select_next() and switches, as soon as no Lock is
//                                   held and no interrupt handler runs.
//     run()                         Runs threads; the caller becomes the idle thread.
#pragma once

#if defined(__arm__)
#include "runtime-m4/port/cortex-m4/machine.hpp"  // IWYU pragma: export
#else
#include "runtime-m4/port/host/machine.hpp"  // IWYU pragma: export
#endif
