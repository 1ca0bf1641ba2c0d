// Fault handlers. A thread that faults is stopped and reported, and the others continue. A fault in a
// handler, in the kernel or in the safety thread is fatal: outputs off, reset.
//
// The thread is not trusted: its stack pointer is used only if it points into its own stack.
#include "runtime-m4/port/cortex-m4/fault.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

// Labels in switch.S.
extern "C" {
void robosync_saving_core();
void robosync_saving_fpu();
void robosync_saved();
void robosync_saving_unprivileged_fpu();
void robosync_no_room();
void robosync_saved_unprivileged();
}

namespace robosync::port {

namespace {

constexpr std::uint32_t kReturnToThread = 0xFFFF'FFFD;  // thread mode, PSP, no FPU frame
constexpr std::uint32_t kWithoutFpu = 1U << 4;          // bits of EXC_RETURN as switch.S saves it
constexpr std::uint32_t kMarkUnprivileged = 1U << 5;    // … 0 for an unprivileged thread
constexpr std::uint32_t kUnprivilegedWithoutFpu = 1U << 6;  // … bit 4 of an unprivileged thread
constexpr std::uint32_t kFromThreadMode = 1U << 3;          // bits of EXC_RETURN
constexpr std::uint32_t kFromPsp = 1U << 2;

// What fault.S pushes.
struct FaultEntry {
  std::uint32_t msp, psp;
  std::array<std::uint32_t, 8> r4_r11;
  std::uint32_t exc_return;
};

std::uint32_t word_of(const void* address) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address));
}

std::uint32_t word_of(void (*function)()) {
  return word_of(reinterpret_cast<const void*>(function));
}

CoreFrame& handler_frame(const FaultEntry& entry) {
  return *reinterpret_cast<CoreFrame*>(entry.msp);
}

// `name` is all zero.
void put_name(const kernel::Thread& thread, link::Name& name) {
  const char* text = thread.name();
  for (std::size_t i = 0; i < name.size() && text[i] != '\0'; ++i)
    name[i] = text[i];
}

std::uint32_t fault_address(std::uint32_t cause) {
  if ((cause & core::kCfsrMmarValid) != 0) return core::reg(core::kMmfar);
  if ((cause & core::kCfsrBfarValid) != 0) return core::reg(core::kBfar);
  return 0;
}

bool frame_lies_in(std::span<const std::byte> stack, std::uint32_t sp) {
  const auto begin = reinterpret_cast<std::uintptr_t>(stack.data());
  return sp % 4 == 0 && stack.size() >= sizeof(CoreFrame) && sp >= begin &&
         sp - begin <= stack.size() - sizeof(CoreFrame);
}

void copy_frame(const CoreFrame& frame, link::Fault& fault) {
  fault.pc = frame.pc;
  fault.lr = frame.lr;
  fault.xpsr = frame.xpsr;
  fault.r[0] = frame.r0;
  fault.r[1] = frame.r1;
  fault.r[2] = frame.r2;
  fault.r[3] = frame.r3;
  fault.r[12] = frame.r12;
}

// Copies the frame that the core stacked at `sp`, if that is in the thread's own stack.
[[gnu::noinline]] void copy_frame_at(std::uint32_t sp, const kernel::Thread& thread,
                                     link::Fault& fault) {
  fault.sp = sp;
  if (frame_lies_in(thread.stack(), sp)) copy_frame(*reinterpret_cast<const CoreFrame*>(sp), fault);
}

[[gnu::noinline]] void stop_and_report(kernel::Thread& thread, const link::Fault& fault) {
  robosync_kernel.stop(thread);
  hooks::thread_faulted(thread, fault);
}

// The switch that follows saves the registers of the stopped thread. Sets its stack pointer to a valid
// place for that; the stack is no longer needed.
void make_switch_safe(kernel::Thread& thread) {
  const auto top = reinterpret_cast<std::uintptr_t>(thread.stack().data() + thread.stack().size());
  const std::uint32_t sp = (top & ~std::uintptr_t{7}) - sizeof(CoreFrame);
  asm volatile("msr psp, %0" ::"r"(sp) : "memory");
}

// True if the thread holds off interrupts of the kernel's level, or all of them. Then a change may be half done, and the switch
// after a stop would not happen.
bool holds_interrupts_off() {
  std::uint32_t basepri = 0;
  std::uint32_t primask = 0;
  asm volatile("mrs %0, basepri" : "=r"(basepri));
  asm volatile("mrs %0, primask" : "=r"(primask));
  return (basepri | primask) != 0;
}

bool from_thread(const FaultEntry& entry) {
  constexpr std::uint32_t kThread = kFromThreadMode | kFromPsp;
  return (entry.exc_return & kThread) == kThread;
}

// Where the fault occurred.
struct Origin {
  bool thread;               // in the running thread, or while the switch saved its registers
  bool saving;               // while the switch saved registers on the thread's stack
  bool saving_unprivileged;  // … of an unprivileged thread
  bool no_room;              // … which had no room for them
};

Origin origin_of(const FaultEntry& entry) {
  const bool handler = (entry.exc_return & kFromThreadMode) == 0;
  const std::uint32_t pc = handler ? handler_frame(entry).pc | 1U : 0;
  const auto is = [pc](void (*place)()) { return pc == (word_of(place) | 1U); };
  Origin origin{};
  origin.no_room = is(robosync_no_room);
  origin.saving_unprivileged = origin.no_room || is(robosync_saving_unprivileged_fpu);
  origin.saving = origin.saving_unprivileged || is(robosync_saving_core) || is(robosync_saving_fpu);
  origin.thread = origin.saving || from_thread(entry);
  return origin;
}

// Whether the kernel can continue without the thread.
bool may_go_on(const kernel::Thread& thread, const Origin& origin) {
  return origin.thread && !holds_interrupts_off() && &thread != &robosync_kernel.idle() &&
         thread.category() != kernel::Category::safety;
}

// The thread touched the guard, or the core had no room for a frame.
bool is_overflow(const kernel::Thread& thread, std::uint32_t cause, std::uint32_t address) {
  if ((cause & core::kCfsrMemoryStacking) != 0) return true;
  const std::uint32_t guard = word_of(thread.stack().data()) - kGuard;
  return (cause & core::kCfsrDataAccess) != 0 && address - guard < kGuard;
}

// `fault` is all zero.
void describe(const kernel::Thread& thread, const FaultEntry& entry, const Origin& origin,
              link::Fault& fault) {
  put_name(thread, fault.thread);
  fault.cause = core::reg(core::kCfsr);
  fault.address = fault_address(fault.cause);
  if (origin.no_room) fault.cause = kCauseStackOverflow;
  if (is_overflow(thread, fault.cause, fault.address)) fault.cause |= kCauseStackOverflow;
  std::copy(entry.r4_r11.begin(), entry.r4_r11.end(), fault.r.begin() + 4);
  // The thread's own frame, even if the context switch faulted.
  if (origin.thread) {
    copy_frame_at(entry.psp, thread, fault);
  } else {
    fault.sp = entry.msp;
    copy_frame(handler_frame(entry), fault);
  }
}

// Lets the context switch continue as if it had saved the thread's registers.
void skip_saving(const FaultEntry& entry, const Origin& origin) {
  constexpr std::uint32_t kPartOfInstruction = 0x0600'FC00;  // progress of a store-multiple
  CoreFrame& frame = handler_frame(entry);
  frame.pc =
      word_of(origin.saving_unprivileged ? robosync_saved_unprivileged : robosync_saved) & ~1U;
  frame.xpsr &= ~kPartOfInstruction;
}

}  // namespace

void enable_fault_handlers() {
  core::reg(core::kShcsr) |= core::kShcsrFaultHandlers;
  core::reg(core::kCcr) |= core::kCcrDivideByZeroTrap;
}

// Reports the registers that the switch saved; switch.S shows their layout and the bits of EXC_RETURN.
void stop_overrun(kernel::Kernel&, kernel::Thread& thread) {
  constexpr std::size_t kExcReturn = 8;  // index, above r4–r11
  constexpr std::size_t kFpuWords = 16;
  const std::uint32_t* const saved = kernel::Kernel::context(thread).sp;
  const std::uint32_t exc_return = saved[kExcReturn];
  const bool privileged = (exc_return & kMarkUnprivileged) != 0;
  const bool used_fpu = (exc_return & (privileged ? kWithoutFpu : kUnprivilegedWithoutFpu)) == 0;
  link::Fault fault{};
  put_name(thread, fault.thread);
  fault.cause = kCauseOverrun;
  std::copy_n(saved, kExcReturn, fault.r.begin() + 4);
  copy_frame_at(word_of(saved + kExcReturn + 1 + (used_fpu ? kFpuWords : 0)), thread, fault);
  stop_and_report(thread, fault);
}

// Stops the running thread, unless an earlier fault already has.
void Machine::refuse_call() {
  kernel::Thread& thread = robosync_kernel.current();
  if (robosync_kernel.state(thread) == kernel::Thread::State::stopped) return;
  link::Fault fault{};
  put_name(thread, fault.thread);
  fault.cause = kCauseNoSuchCall;
  std::uint32_t psp = 0;
  asm volatile("mrs %0, psp" : "=r"(psp));
  copy_frame_at(psp, thread, fault);
  fault.address = fault.r[0];
  stop_and_report(thread, fault);
}

}  // namespace robosync::port

extern "C" std::uint32_t robosync_fault(const robosync::port::FaultEntry* entry);

// Called by fault.S; returns the EXC_RETURN to leave the handler with.
std::uint32_t robosync_fault(const robosync::port::FaultEntry* entry) {
  using namespace robosync::port;
  robosync::kernel::Thread& thread = robosync_kernel.current();
  const Origin origin = origin_of(*entry);
  robosync::link::Fault fault{};
  describe(thread, *entry, origin, fault);
  if (!may_go_on(thread, origin)) hooks::fatal_fault(fault);
  core::reg(core::kCfsr) = 0xFFFF'FFFF;  // write 1 to clear
  // One instruction may cause two faults: it is undefined, and its frame could not be stacked either.
  if (robosync_kernel.state(thread) != robosync::kernel::Thread::State::stopped) {
    stop_and_report(thread, fault);
  }
  if (origin.saving) {
    skip_saving(*entry, origin);
    return entry->exc_return;
  }
  core::reg(core::kShcsr) &= ~core::kShcsrCallPending;  // drops a system call of the stopped thread
  make_switch_safe(thread);
  return kReturnToThread;
}
