// The Cortex-M4 as a machine for the kernel. There is one, and it runs `robosync_kernel`.
//
// Threads run on PSP, handlers on MSP. The switch is PendSV (switch.S) and the tick is SysTick, both
// at the lowest priority. Critical sections raise BASEPRI, to the kernel's level or to that of the
// switch and the tick: interrupts above the kernel's level are never held off. Until run(), all
// interrupts of the kernel's level are held off (by the board's reset handler).
//
// What the MPU closes, and to which threads: isolation.hpp.
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

// Bytes of the guard below the usable stack of each privileged thread. While the thread runs, the MPU
// turns any access to the guard into a fault.
inline constexpr std::size_t kGuard = 32;
inline constexpr bool kTimeFlows = true;
inline constexpr std::size_t kArenaScale = 1;
inline constexpr std::size_t kStackAlignment = kGuard;  // any other alignment wastes bytes

// An unprivileged thread can write nothing next to its stack, so it needs no guard. The stack begins
// and ends at eighths of a window of two MPU regions (regions.hpp).
inline constexpr unsigned kStackWindowBits = 9;
inline constexpr std::size_t kUnprivilegedStackAlignment = (std::size_t{1} << kStackWindowBits) / 8;
inline constexpr std::size_t kMaxUnprivilegedStack =
    9 * kUnprivilegedStackAlignment;  // fits a window wherever it begins

// The stack of a secluded thread (ThreadSpec::data_bytes) is covered exactly by eighths of a single region. The other region of
// the window closes the rest of RAM.

// Room for alignment and guard, the core's frame with FPU registers, and what switch.S saves.
inline constexpr std::size_t kFrame = 104;
inline constexpr std::size_t kSaved = 100;
inline constexpr std::size_t kSavedWithoutFpu = 36;
inline constexpr std::size_t kMinStack = kGuard - 8 + kGuard + kFrame + kSaved;

// switch.S relies on this layout.
struct Context {
  std::uint32_t* sp = nullptr;  // points at r4–r11 and EXC_RETURN, saved below the core's frame
  std::uint32_t run_time = 0;   // counts of the clock until the thread was last switched out
  // For the MPU's base register: the guard; for an unprivileged thread, the lower region of its
  // window; for a secluded one, its stack.
  std::uint32_t region = 0;
  // For an unprivileged thread: size and eighths of the lower region, and in the upper half those of
  // the upper region; for a secluded one, the size and the eighths of its stack, and kSecluded.
  std::uint32_t windows = 0;
  static constexpr std::uint32_t kSecluded = 1U << 22;  // no bit of a size or of eighths
};
static_assert(offsetof(Context, sp) == 0 && offsetof(Context, run_time) == 4);
static_assert(offsetof(Context, region) == 8 && offsetof(Context, windows) == 12);

// What the core stacks at exception entry.
struct CoreFrame {
  std::uint32_t r0, r1, r2, r3, r12, lr, pc, xpsr;
};

struct CallFrame : CoreFrame {
  std::uint32_t number() const { return r0; }
  std::uint32_t argument() const { return r1; }
  void give(std::uint32_t result) { r0 = result; }
  void repeat() { pc -= 2; }  // back to the SVC, which is always 2 bytes long
};

// The run time of the running thread so far is `origin` minus the clock.
struct RunClock {
  std::uint32_t origin = 0;
#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
  std::uint32_t unused = 0;
#else
  const volatile std::uint32_t* clock = &robosync_clock;  // for the switch
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

// Passes number and argument in r0 and r1; the result is in r0 (SVC_Handler).
inline std::uint32_t call(kernel::Kernel&, std::uint32_t number, std::uint32_t argument) {
  register std::uint32_t r0 asm("r0") = number;
  register std::uint32_t r1 asm("r1") = argument;
  asm volatile("svc 0" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

// Never declare one const: GCC then keeps it in memory ("store to a read-only decl" prevents scalar
// replacement), which costs four instructions in every path.
template <std::uint32_t kLevel>
class LockOfLevel {
public:
  explicit LockOfLevel(const Machine&) : outer_(raise()) {}
  // A switch that was requested under the lock happens here, give or take an instruction: without a
  // barrier the core may first execute what it has fetched. Kernel::wait() does not rely on it.
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

// A Lock for a caller that holds neither a Lock nor a SwitchLock: a thread, or the tick. So it need
// not save the level before.
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
