// Fault handlers. A thread that faults is stopped and reported, and the others go on. A fault in a
// handler, in the kernel or in the safety thread leaves nothing to rely on: outputs off, reset.
//
// Nothing is believed of the thread: its stack pointer is used only if it lies in its own stack.
#include "runtime-m4/port/cortex-m4/fault.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

// Places in switch.S.
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
constexpr std::uint32_t kMarkUnprivileged = 1U << 5;  // … 0: of a thread without privileges, for
constexpr std::uint32_t kUnprivilegedWithoutFpu = 1U << 6;  // … which this says what bit 4 says
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

link::Name name_of(const kernel::Thread& thread) {
  link::Name name{};
  const char* text = thread.name();
  for (std::size_t i = 0; i < name.size() && text[i] != '\0'; ++i)
    name[i] = text[i];
  return name;
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

// What the core stacked there for the thread, if it is the thread's own stack.
[[gnu::noinline]] void copy_frame_at(std::uint32_t sp, const kernel::Thread& thread,
                                     link::Fault& fault) {
  fault.sp = sp;
  if (frame_lies_in(thread.stack(), sp)) copy_frame(*reinterpret_cast<const CoreFrame*>(sp), fault);
}

[[gnu::noinline]] void stop_and_report(kernel::Thread& thread, const link::Fault& fault) {
  robosync_kernel.stop(thread);
  hooks::thread_faulted(thread, fault);
}

// A stopped thread's stack is free, so its stack pointer is put where the switch that follows can
// save registers, whatever the thread made of it.
void make_switch_safe(kernel::Thread& thread) {
  const auto top = reinterpret_cast<std::uintptr_t>(thread.stack().data() + thread.stack().size());
  const std::uint32_t sp = (top & ~std::uintptr_t{7}) - sizeof(CoreFrame);
  asm volatile("msr psp, %0" ::"r"(sp) : "memory");
}

// Of the kernel's level, or all of them: then it is in the midst of something, and the switch that would follow a stop does
// not come.
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

// The handler that faulted did so there.
bool from_place(const FaultEntry& entry, void (*place)()) {
  return (entry.exc_return & kFromThreadMode) == 0 &&
         handler_frame(entry).pc == (word_of(place) & ~1U);
}

// True when the context switch faulted, or gave up, while it saved the registers of a thread
// without privileges on that thread's stack.
bool from_saving_unprivileged(const FaultEntry& entry) {
  return from_place(entry, robosync_saving_unprivileged_fpu) || from_place(entry, robosync_no_room);
}

// … of any thread.
bool from_saving(const FaultEntry& entry) {
  return from_place(entry, robosync_saving_core) || from_place(entry, robosync_saving_fpu) ||
         from_saving_unprivileged(entry);
}

// Whether the fault is the thread's own doing, in a state in which the kernel can go on without it.
bool may_go_on(const kernel::Thread& thread, const FaultEntry& entry) {
  return (from_thread(entry) || from_saving(entry)) && !holds_interrupts_off() &&
         &thread != &robosync_kernel.idle() && thread.category() != kernel::Category::safety;
}

// The guard was touched, or the core found no room for a frame.
bool is_overflow(const kernel::Thread& thread, std::uint32_t cause, std::uint32_t address) {
  if ((cause & core::kCfsrMemoryStacking) != 0) return true;
  const std::uint32_t guard = word_of(thread.stack().data()) - kGuard;
  return (cause & core::kCfsrDataAccess) != 0 && address - guard < kGuard;
}

link::Fault describe(const kernel::Thread& thread, const FaultEntry& entry) {
  link::Fault fault{};
  fault.thread = name_of(thread);
  fault.cause = core::reg(core::kCfsr);
  fault.address = fault_address(fault.cause);
  if (from_place(entry, robosync_no_room)) fault.cause = kCauseStackOverflow;
  if (is_overflow(thread, fault.cause, fault.address)) fault.cause |= kCauseStackOverflow;
  std::copy(entry.r4_r11.begin(), entry.r4_r11.end(), fault.r.begin() + 4);
  // What a thread left on its own stack, even when it is the context switch that faulted.
  if (from_thread(entry) || from_saving(entry)) {
    copy_frame_at(entry.psp, thread, fault);
  } else {
    fault.sp = entry.msp;
    copy_frame(handler_frame(entry), fault);
  }
  return fault;
}

// Lets the context switch go on as if it had saved the thread's registers.
void skip_saving(const FaultEntry& entry) {
  constexpr std::uint32_t kPartOfInstruction = 0x0600'FC00;  // how far a store-multiple had come
  CoreFrame& frame = handler_frame(entry);
  frame.pc =
      word_of(from_saving_unprivileged(entry) ? robosync_saved_unprivileged : robosync_saved) & ~1U;
  frame.xpsr &= ~kPartOfInstruction;
}

}  // namespace

void enable_fault_handlers() {
  core::reg(core::kShcsr) |= core::kShcsrFaultHandlers;
  core::reg(core::kCcr) |= core::kCcrDivideByZeroTrap;
}

// What it was at is told by what the switch saved: switch.S draws it, and says what the bits mean.
void stop_overrun(kernel::Kernel&, kernel::Thread& thread) {
  constexpr std::size_t kExcReturn = 8;  // index, above r4–r11
  constexpr std::size_t kFpuWords = 16;
  const std::uint32_t* const saved = kernel::Kernel::context(thread).sp;
  const std::uint32_t exc_return = saved[kExcReturn];
  const bool privileged = (exc_return & kMarkUnprivileged) != 0;
  const bool used_fpu = (exc_return & (privileged ? kWithoutFpu : kUnprivilegedWithoutFpu)) == 0;
  link::Fault fault{};
  fault.thread = name_of(thread);
  fault.cause = kCauseOverrun;
  std::copy_n(saved, kExcReturn, fault.r.begin() + 4);
  copy_frame_at(word_of(saved + kExcReturn + 1 + (used_fpu ? kFpuWords : 0)), thread, fault);
  stop_and_report(thread, fault);
}

// Stops the running thread, unless a fault before it has done so already.
void Machine::refuse_call() {
  kernel::Thread& thread = robosync_kernel.current();
  if (robosync_kernel.state(thread) == kernel::Thread::State::stopped) return;
  link::Fault fault{};
  fault.thread = name_of(thread);
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
  const robosync::link::Fault fault = describe(thread, *entry);
  if (!may_go_on(thread, *entry)) hooks::fatal_fault(fault);
  core::reg(core::kCfsr) = 0xFFFF'FFFF;  // write 1 to clear
  // One instruction may make two faults: an undefined one whose frame could not be stacked either.
  if (robosync_kernel.state(thread) != robosync::kernel::Thread::State::stopped) {
    stop_and_report(thread, fault);
  }
  if (from_saving(*entry)) {
    skip_saving(*entry);
    return entry->exc_return;
  }
  core::reg(core::kShcsr) &=
      ~core::kShcsrCallPending;  // it wanted to, and is not asked what any more
  make_switch_safe(thread);
  return kReturnToThread;
}
