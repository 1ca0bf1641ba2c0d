// The Cortex-M4 as a machine for the kernel. There is one, and it runs `robosync_kernel`.
//
// Threads run on PSP, handlers on MSP. The switch is PendSV at the lowest priority (switch.S), and
// so is the tick, SysTick. Critical sections raise BASEPRI, to the kernel's level or to that of
// these two only: interrupts above the kernel's level are never held off. Until
// run() the kernel's level is held off altogether (the board's reset handler sees to that).
//
// What the MPU closes, and to whom: isolation.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/port/cortex-m4/clock.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/sandbox.hpp"  // IWYU pragma: export

namespace robosync::kernel {
class Kernel;
class Thread;
struct ThreadSpec;
}  // namespace robosync::kernel

namespace robosync::port {

// Below the stack of each thread with privileges stand 32 bytes that nobody may touch while it
// runs: the MPU makes a fault of the first access. Bytes between a stack's start and what a thread
// can use of it:
inline constexpr std::size_t kGuard = 32;
inline constexpr bool kTimeFlows = true;
inline constexpr std::size_t kArenaScale = 1;
inline constexpr std::size_t kStackAlignment = kGuard;  // any other alignment wastes bytes

// The stack of a thread without privileges is all that it can write around there, so it needs no
// guard; its borders are those of the eighths of a window of two MPU regions (regions.hpp).
inline constexpr unsigned kStackWindowBits = 9;
inline constexpr std::size_t kUnprivilegedStackAlignment = (std::size_t{1} << kStackWindowBits) / 8;
inline constexpr std::size_t kMaxUnprivilegedStack =
    9 * kUnprivilegedStackAlignment;  // wherever it begins

// One that has data on its stack, and nothing else: a single region, so that the other one of the
// window can close the rest of the memory.
inline constexpr unsigned kSecludedBits = 10;
inline constexpr std::size_t kSecludedStack = std::size_t{1} << kSecludedBits;

// Alignment and guard, what the core stacks with FPU registers, and what switch.S adds.
inline constexpr std::size_t kFrame = 104;
inline constexpr std::size_t kSaved = 100;
inline constexpr std::size_t kMinStack = kGuard - 8 + kGuard + kFrame + kSaved;

// switch.S knows where these stand.
struct Context {
  std::uint32_t* sp = nullptr;  // r4–r11 and EXC_RETURN stand there, below the core's own frame
  std::uint32_t run_time = 0;   // how long it ran, until it stopped last
  // For the MPU's base register: the guard; without privileges, the lower region of the window; of a
  // secluded thread, its stack.
  std::uint32_t region = 0;
  // Without privileges: sizes and eighths of the lower region, and above them of the upper one; of a
  // secluded thread, the size of its stack's, and kSecluded.
  std::uint32_t windows = 0;
  static constexpr std::uint32_t kSecluded = 1U << 22;  // no bit of a size or of eighths
};
static_assert(offsetof(Context, sp) == 0 && offsetof(Context, run_time) == 4);
static_assert(offsetof(Context, region) == 8 && offsetof(Context, windows) == 12);

// What the core stacks.
struct CoreFrame {
  std::uint32_t r0, r1, r2, r3, r12, lr, pc, xpsr;
};

struct CallFrame : CoreFrame {
  std::uint32_t number() const { return r0; }
  std::uint32_t argument() const { return r1; }
  void give(std::uint32_t result) { r0 = result; }
  void repeat() { pc -= 2; }  // to the SVC, which has no other length
};

// Of the running thread: its run time so far is `origin` less the clock.
struct RunClock {
  std::uint32_t origin = 0;
#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
  std::uint32_t unused = 0;
#else
  const volatile std::uint32_t* clock = &robosync_clock;  // as the switch finds it
#endif
};

struct Areas {
  std::span<const std::byte> readable;
  std::span<std::byte> writable;
};

enum class Mode : std::uint8_t { init, thread, handler };
enum class Held : std::uint8_t { none, switch_lock, lock };
[[noreturn, gnu::cold]] void panic(const char* service, const char* why);

class Machine {
public:
  explicit Machine(kernel::Kernel&) {}
  [[gnu::cold]] static Mode mode();
  [[gnu::cold]] static Held held();
  [[gnu::cold]] static bool may_call();
  [[gnu::cold]] void prepare(Context& context, const kernel::ThreadSpec& spec,
                             std::span<std::byte> stack);
  static std::uint32_t clock() { return read_clock(); }
  static std::uint32_t run_time(const Context& context, const RunClock& run_clock, bool runs) {
    return runs ? run_clock.origin - clock() : context.run_time;
  }
  void request_switch() { core::reg(core::kIcsr) = core::kIcsrPendSvSet; }
  [[noreturn, gnu::cold]] void run();
  [[gnu::cold]] static std::span<std::byte> usable(const kernel::ThreadSpec& spec);
  [[gnu::cold]] static bool can_run(const kernel::ThreadSpec& spec);
  static void grant(const Areas& areas);
  static std::span<std::byte> prepare_idle(Context& context);
  [[gnu::cold]] static void refuse_call();
};

inline std::uint32_t fetch_and_clear(std::uint32_t& word, std::uint32_t mask) {
  std::uint32_t before, after, failed;
  asm volatile(
      "1: ldrex %0, %3        \n"
      "bic   %1, %0, %4       \n"
      "strex %2, %1, %3       \n"
      "cmp   %2, #0           \n"
      "bne   1b               \n"
      : "=&r"(before), "=&r"(after), "=&r"(failed), "+m"(word)
      : "r"(mask)
      : "cc", "memory");
  return before;
}

void stop_overrun(kernel::Kernel& kernel, kernel::Thread& thread);  // fault.cpp

// Number and argument go in r0 and r1, the result comes in r0 (SVC_Handler).
inline std::uint32_t call(kernel::Kernel&, std::uint32_t number, std::uint32_t argument) {
  register std::uint32_t r0 asm("r0") = number;
  register std::uint32_t r1 asm("r1") = argument;
  asm volatile("svc 0" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

// Never make one const: GCC then keeps it in memory ("store to a read-only decl" stops its scalar
// replacement), which costs four instructions in every path.
template <std::uint32_t kLevel>
class LockOfLevel {
public:
  explicit LockOfLevel(const Machine&) : outer_(raise()) {}
  // A switch that was requested under the lock happens here, give or take an instruction: without
  // a barrier the core may finish what it has fetched. Waiting does not rely on it.
  ~LockOfLevel() { asm volatile("msr basepri, %0" ::"r"(outer_) : "memory"); }
  LockOfLevel(const LockOfLevel&) = delete;
  LockOfLevel& operator=(const LockOfLevel&) = delete;

private:
  static std::uint32_t raise() {
    std::uint32_t outer;
    asm volatile("mrs %0, basepri\n\tmsr basepri_max, %1" : "=&r"(outer) : "r"(kLevel) : "memory");
    return outer;
  }

  std::uint32_t outer_;
};
using Lock = LockOfLevel<core::kKernelPriority>;
using SwitchLock = LockOfLevel<core::kSwitchPriority>;

// A Lock for who holds none, nor a SwitchLock: a thread, or the tick. What was before need not be
// kept.
class OnlyLock {
public:
  explicit OnlyLock(const Machine&) { set(core::kKernelPriority); }
  ~OnlyLock() { set(0); }
  OnlyLock(const OnlyLock&) = delete;
  OnlyLock& operator=(const OnlyLock&) = delete;

private:
  static void set(std::uint32_t level) { asm volatile("msr basepri, %0" ::"r"(level) : "memory"); }
};

}  // namespace robosync::port
