// Makes threads runnable, takes the decisions of the context switch, and drives the tick.
#include "runtime-m4/port/cortex-m4/machine.hpp"

#include <array>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/fault.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

// switch.S
extern "C" [[noreturn]] void robosync_become_idle(std::byte* stack_top);

namespace robosync::port {

namespace {

constexpr std::uint32_t kXpsrThumb = 1U << 24;
constexpr std::uint32_t kReturnToThread = 0xFFFF'FFFD;  // thread mode, PSP, no FPU frame

// What a thread's stack holds before it runs for the first time; switch.S draws it.
struct FirstFrame {
  std::array<std::uint32_t, 8> r4_r11;
  std::uint32_t exc_return;
  std::uint32_t r0, r1, r2, r3, r12, lr, pc, xpsr;
};

// The idle thread needs the frame of an interrupt and of a switch, without FPU registers.
alignas(kGuard) std::array<std::byte, kGuard + 96> idle_stack;

// Where a thread's entry returns to.
[[noreturn]] void thread_ended() {
  robosync_kernel.stop(robosync_kernel.current());
  while (true) {
  }
}

std::uint32_t word_of(const void* address) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address));
}

// What the MPU's base register needs to guard the bytes below a usable stack.
std::uint32_t guard_below(std::span<const std::byte> stack) {
  return word_of(stack.data()) - kGuard + core::kMpuBaseValid + kGuardRegion;
}

}  // namespace

std::span<std::byte> Machine::usable(std::span<std::byte> stack) {
  const std::uint32_t begin = (word_of(stack.data()) + kGuard - 1) / kGuard * kGuard + kGuard;
  return stack.subspan(begin - word_of(stack.data()));
}

void Machine::prepare(Context& context, const kernel::ThreadSpec& spec,
                      std::span<std::byte> stack) {
  const std::uint32_t top = word_of(stack.data() + stack.size()) & ~7U;
  auto* const frame = reinterpret_cast<FirstFrame*>(top - sizeof(FirstFrame));
  *frame = {};
  frame->exc_return = kReturnToThread;
  frame->r0 = word_of(spec.argument);
  frame->lr = word_of(reinterpret_cast<const void*>(&thread_ended));
  frame->pc = word_of(reinterpret_cast<const void*>(spec.entry)) & ~1U;
  frame->xpsr = kXpsrThumb;
  context.sp = reinterpret_cast<std::uint32_t*>(frame);
  context.guard = guard_below(stack);
}

std::span<std::byte> Machine::prepare_idle(Context& context) {
  const auto stack = std::span<std::byte>(idle_stack).subspan(kGuard);
  context.guard = guard_below(stack);
  return stack;
}

void Machine::run() {
  enable_fault_handlers();
  core::reg(core::kMpuRbar) = kernel::Kernel::context(robosync_kernel.idle()).guard;
  core::reg(core::kMpuRasr) = core::kMpuNoAccess32;
  core::reg(core::kMpuCtrl) = core::kMpuOn;
  core::reg(core::kSystRvr) =
      static_cast<std::uint32_t>(hooks::kCoreHz / 1'000'000 * kernel::kTick) - 1;
  core::reg(core::kSystCvr) = 0;
  core::reg(core::kSystCsr) = 7;  // core clock, interrupt, on
  request_switch();
  robosync_become_idle(idle_stack.data() + idle_stack.size());
}

}  // namespace robosync::port

extern "C" {

std::uint32_t* robosync_switch(robosync::kernel::Kernel& kernel, std::uint32_t* sp);
void SysTick_Handler();

// Called by switch.S with the stack pointer of the thread that ran; returns that of the next one.
std::uint32_t* robosync_switch(robosync::kernel::Kernel& kernel, std::uint32_t* sp) {
  namespace core = robosync::port::core;
  using robosync::kernel::Kernel;
  robosync::port::Context& left = Kernel::context(kernel.current());
  left.sp = sp;
  asm volatile("" : : "m"(left.sp));  // at once: what follows then needs a register less
  const robosync::port::Context& next = Kernel::context(kernel.select_next());
  core::reg(core::kMpuRbar) = next.guard;
  return next.sp;
}

void SysTick_Handler() {
  robosync_kernel.on_tick();
}

}  // extern "C"
