// Prepares threads to run, asserts the layout that switch.S relies on, and takes system calls.
#include "runtime-m4/port/cortex-m4/machine.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/fault.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/isolation.hpp"
#include "runtime-m4/port/cortex-m4/tick.hpp"

// switch.S
extern "C" {
[[noreturn]] void robosync_become_idle(std::byte* stack_top);
void robosync_save_unprivileged(std::uint32_t psp);
void robosync_no_room();
}

namespace robosync::port {

namespace {

constexpr std::uint32_t kXpsrThumb = 1U << 24;
constexpr std::uint32_t kReturnToThread = 0xFFFF'FFFD;        // thread mode, PSP, no FPU frame
constexpr std::uint32_t kReturnToUnprivileged = 0xFFFF'FFCD;  // … unprivileged, for switch.S

constexpr std::uint32_t kReturnToSecluded = 0xFFFF'FF8D;  // … as if it had used the FPU

// The contents of a thread's stack before it first runs; switch.S shows the layout.
struct SavedRegisters {
  std::array<std::uint32_t, 8> r4_r11;
  std::uint32_t exc_return;
};
struct FirstFrame {
  SavedRegisters saved;
  CoreFrame stacked;
};
// If a thread has used the FPU, there are more bytes between the two, and above them.
constexpr std::uint32_t kS16ToS31 = 16 * 4;
constexpr std::uint32_t kS0ToS15AndFpscr = 18 * 4;

// switch.S loads the first members in one instruction, and uses the offsets of the others.
using kernel::Selection;
static_assert(std::is_standard_layout_v<Selection> && kernel::kMaxThreads == 3 * 32);
static_assert(offsetof(Selection, running_) == 0 && offsetof(Selection, run_clock_) == 4);
static_assert(offsetof(RunClock, origin) == 0 && sizeof(RunClock) == 8);
static_assert(offsetof(Selection, held_) == 12 && offsetof(Selection, ready_) == 16);
static_assert(offsetof(Selection, running_rank_) == 28 && offsetof(Selection, ceiling_) == 29);
static_assert(offsetof(Selection, by_rank_) == 32);

// The idle thread needs the frame of an interrupt and of a switch, without FPU registers.
alignas(kGuard) std::array<std::byte, kGuard + 96> idle_stack;

// A thread's entry returns to this.
[[noreturn]] void thread_ended() {
  robosync_kernel.stop(robosync_kernel.current());
  while (true) {
  }
}

std::uint32_t word_of(const void* address) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address));
}

// The value of the MPU's base register for the guard below a usable stack.
std::uint32_t guard_below(std::span<const std::byte> stack) {
  return base_of(RegionNumber::guard, word_of(stack.data()) - kGuard);
}

// Sets the window of an unprivileged thread.
void set_stack_window(Context& context, std::span<const std::byte> stack) {
  const auto bytes = static_cast<std::uint32_t>(stack.size());
  const policy::regions::Window window =
      policy::regions::window(word_of(stack.data()), bytes, kStackWindowBits);
  context.region = base_of(RegionNumber::stack, window.lower.base);
  context.windows = window.lower.size_and_eighths | window.upper.size_and_eighths << 16;
}

void set_secluded(Context& context, std::span<const std::byte> stack) {
  const std::uint32_t begin = word_of(stack.data());
  const policy::regions::Region region =
      policy::regions::cover(begin, begin + static_cast<std::uint32_t>(stack.size()));
  context.region = base_of(RegionNumber::stack_upper, region.base);
  context.windows = region.size_and_eighths | Context::kSecluded;
}

void make_first_frame(Context& context, const kernel::ThreadSpec& spec, std::uint32_t top,
                      std::uint32_t exc_return) {
  const bool fpu = exc_return == kReturnToSecluded;
  const std::uint32_t bytes = sizeof(FirstFrame) + (fpu ? kS16ToS31 + kS0ToS15AndFpscr : 0);
  auto* const saved = reinterpret_cast<SavedRegisters*>(top - bytes);
  std::memset(saved, 0, bytes);
  saved->exc_return = exc_return;
  auto& stacked =
      *reinterpret_cast<CoreFrame*>(top - bytes + sizeof(SavedRegisters) + (fpu ? kS16ToS31 : 0));
  stacked.r0 = word_of(spec.argument);
  stacked.lr = word_of(reinterpret_cast<const void*>(&thread_ended));
  stacked.pc = word_of(reinterpret_cast<const void*>(spec.entry)) & ~1U;
  stacked.xpsr = kXpsrThumb;
  context.sp = reinterpret_cast<std::uint32_t*>(saved);
}

}  // namespace

bool Machine::can_run(const kernel::ThreadSpec& spec) {
  if (spec.data_bytes != 0)
    return !spec.privileged &&
           policy::regions::fits_region(word_of(spec.stack.data()),
                                        static_cast<std::uint32_t>(spec.stack.size())) &&
           spec.data_bytes + kMinStack <= spec.stack.size() && spec.data_bytes % 8 == 0;
  return spec.privileged || policy::regions::fits_window(
                                word_of(spec.stack.data()),
                                static_cast<std::uint32_t>(spec.stack.size()), kStackWindowBits);
}

std::span<std::byte> Machine::usable(const kernel::ThreadSpec& spec) {
  if (!spec.privileged) return spec.stack.subspan(spec.data_bytes);
  const std::uint32_t stack = word_of(spec.stack.data());
  const std::uint32_t begin = (stack + kGuard - 1) / kGuard * kGuard + kGuard;
  return spec.stack.subspan(begin - stack);
}

void Machine::prepare(Context& context, const kernel::ThreadSpec& spec,
                      std::span<std::byte> stack) {
  const std::uint32_t top = word_of(stack.data() + stack.size()) & ~7U;
  context.run_time = 0;
  if (spec.data_bytes != 0) {
    set_secluded(context, spec.stack);
    return make_first_frame(context, spec, top, kReturnToSecluded);
  }
  context.region = guard_below(stack);
  if (!spec.privileged) set_stack_window(context, stack);
  make_first_frame(context, spec, top, spec.privileged ? kReturnToThread : kReturnToUnprivileged);
}

std::span<std::byte> Machine::prepare_idle(Context& context) {
  const auto stack = std::span<std::byte>(idle_stack).subspan(kGuard);
  context.region = guard_below(stack);
  return stack;
}

void Machine::run() {
  enable_fault_handlers();
  core::reg(core::kShpr2) = core::kKernelPriority << 24;
  start_isolation();
  start_tick();
  robosync_kernel.run_clock().origin = clock();  // of the idle thread
  request_switch();
  robosync_become_idle(idle_stack.data() + idle_stack.size());
}

}  // namespace robosync::port

extern "C" {

void PendSV_Unprivileged_Handler();
void SVC_Handler();

// PendSV while an unprivileged thread runs. Its stack pointer may be any address at which the core
// could stack a frame, but registers are saved with privileges: so this checks that there is room on
// the thread's own stack. It ends in a jump, so lr and r4–r11 are the thread's when switch.S saves them.
void PendSV_Unprivileged_Handler() {
  using namespace robosync::port;
  // Bit 4 of EXC_RETURN: the thread does not use the FPU, so less is saved.
  std::uint32_t no_fpu = 0, psp = 0;
  asm volatile("and %0, lr, #0x10\n\tmrs %1, psp" : "=&r"(no_fpu), "=r"(psp));
  static_assert(kSaved - kSavedWithoutFpu == 0x10 << 2);
  const auto stack = robosync_kernel.current().stack();
  if (psp - word_of(stack.data()) + (no_fpu << 2) - kSaved >= stack.size())
    return robosync_no_room();
  return robosync_save_unprivileged(psp);
}

// A system call. Only the vector table of unprivileged threads has this handler. It runs at the
// kernel's own priority, so it needs no Lock. The thread is not trusted: number and argument are no
// addresses, and the core stacked their frame with the thread's rights, so the frame lies where the
// thread may write.
void SVC_Handler() {
  using namespace robosync::port;
  CallFrame* call = nullptr;
  asm volatile("mrs %0, psp" : "=r"(call));
  robosync_kernel.answer(*call);
}

}  // extern "C"
