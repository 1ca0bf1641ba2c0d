// Each kind of fault in a thread: the thread is stopped and described, the others do not notice.
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

constexpr std::uint32_t kUndefinedInstruction = 1U << 16;  // bits of CFSR
constexpr std::uint32_t kInvalidState = 1U << 17;
constexpr std::uint32_t kDivideByZero = 1U << 25;
constexpr std::uint32_t kPreciseBusError = 1U << 9;
constexpr std::uint32_t kStackOverflow = 1U << 20;  // port/cortex-m4/fault.hpp

constexpr std::uintptr_t kNowhere = 0x6000'0000;  // no memory there

volatile unsigned beats = 0;

// Wakes every millisecond and uses the FPU; a fault of another thread must not cost it a beat.
void heart(void*) {
  volatile float pulse = 0;
  for (;;) {
    rig::sleep_ms(1);
    beats = beats + 1;
    pulse = pulse + 1.5F;
  }
}

bool name_is(const char* expected) {
  const auto& name = rig::last_fault().thread;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] != expected[i]) return false;
    if (expected[i] == '\0') return true;
  }
  return true;
}

// Starts `entry` in addition to the heart, and expects it to be stopped with `cause`.
void expect_fault(void (*entry)(void*), std::uint32_t cause) {
  beats = 0;
  rig::start(0, 60, heart);
  rig::Thread& victim = rig::start(1, 40, entry, rig::Category::behavior, "victim");
  rig::sleep_ms(10);
  CHECK(rig::faults() == 1);
  CHECK((rig::last_fault().cause & cause) == cause);
  CHECK(name_is("victim"));
  CHECK(robosync_kernel.state(victim) == rig::Thread::State::stopped);
  CHECK(beats >= 9);
}

void undefined_instruction() {
  const auto entry = [](void*) {
    asm volatile(
        "ldr r7, =0x12345678 \n"
        "udf #7              \n" ::
            : "r7");
  };
  expect_fault(entry, kUndefinedInstruction);
  CHECK(rig::last_fault().r[7] == 0x12345678);
  const auto code = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(+entry)) & ~1U;
  CHECK(rig::last_fault().pc >= code && rig::last_fault().pc < code + 16);
}

void wild_write() {
  expect_fault([](void*) { *reinterpret_cast<volatile std::uint32_t*>(kNowhere) = 1; },
               kPreciseBusError);
  CHECK(rig::last_fault().address == kNowhere);
}

void division_by_zero() {
  const auto entry = [](void*) {
    volatile int zero = 0;
    volatile int result = 1000 / zero;
    static_cast<void>(result);
  };
  expect_fault(entry, kDivideByZero);
}

void call_of_null() {
  const auto entry = [](void*) { asm volatile("movs r3, #0 \n blx r3" ::: "r3", "lr"); };
  expect_fault(entry, kInvalidState);
}

// With FPU registers in use, so that their lazy saving is still pending at the fault.
void fault_with_fpu() {
  const auto entry = [](void*) {
    asm volatile(
        "vmov s0, r0  \n"
        "vmov s31, r0 \n"
        "udf #0       \n" ::
            : "s0", "s31");
  };
  expect_fault(entry, kUndefinedInstruction);
}

// A stack pointer that points nowhere: the core cannot even stack the frame.
void lost_stack_pointer() {
  const auto entry = [](void*) {
    asm volatile(
        "ldr r0, =0x60000000 \n"
        "mov sp, r0          \n"
        "udf #0              \n" ::
            : "r0");
  };
  expect_fault(entry, 1U << 12);  // STKERR
  CHECK(rig::last_fault().pc == 0);
}

// The same with FPU registers in use, whose saving is then pending: they must not be saved
// later.
void lost_stack_pointer_with_fpu() {
  const auto entry = [](void*) {
    asm volatile(
        "vmov s0, r0         \n"
        "ldr r0, =0x60000000 \n"
        "mov sp, r0          \n"
        "udf #0              \n" ::
            : "r0", "s0");
  };
  expect_fault(entry, 1U << 12);  // STKERR
}

// A stack pointer into memory that is not the thread's own.
alignas(8) std::array<std::byte, 256> foreign;
void foreign_stack_pointer() {
  const auto entry = [](void*) {
    asm volatile(
        "mov sp, %0 \n"
        "udf #0     \n" ::"r"(foreign.data() + foreign.size()));
  };
  foreign.fill(std::byte{0});
  expect_fault(entry, kUndefinedInstruction);
  CHECK(rig::last_fault().pc == 0);
  // The core has stacked its frame there; the switch must not add to the damage.
  for (std::size_t i = 0; i < foreign.size() - 32; ++i)
    CHECK(foreign[i] == std::byte{0});
}

// Recurses until the stack pointer has passed `floor`, and returns.
[[gnu::noinline]] unsigned dive(std::uintptr_t floor) {
  volatile unsigned here = 1;
  if (reinterpret_cast<std::uintptr_t>(&here) <= floor) return 0;
  return dive(floor) + here;
}

std::uint32_t bottom(void* thread) {
  const auto stack = static_cast<rig::Thread*>(thread)->stack();
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(stack.data()));
}

void stack_overflow() {
  static std::uint32_t floor;
  const auto entry = [](void* self) {
    floor = bottom(self);
    dive(floor - 16);
  };
  expect_fault(entry, kStackOverflow);
  CHECK(rig::last_fault().address < floor);
  CHECK(rig::last_fault().address >= floor - 32);
}

// The next interrupt finds no room for its frame.
void no_room_for_a_frame() {
  const auto entry = [](void* self) {
    asm volatile(
        "mov sp, %0 \n"
        "1: b 1b    \n" ::"r"(bottom(self) + 24));
  };
  expect_fault(entry, kStackOverflow);
  CHECK(rig::last_fault().pc == 0);
}

// An interrupt finds room, but the context switch does not: it faults while it saves.
void no_room_for_registers() {
  const auto entry = [](void* self) {
    asm volatile(
        "mov sp, %0 \n"
        "1: b 1b    \n" ::"r"(bottom(self) + 40));
  };
  expect_fault(entry, kStackOverflow);
  CHECK(rig::last_fault().pc != 0);
}

void no_room_for_fpu_registers() {
  const auto entry = [](void* self) {
    asm volatile(
        "vmov s20, r0 \n"
        "mov sp, %0   \n"
        "1: b 1b      \n" ::"r"(bottom(self) + 104 + 36)
        : "s20");
  };
  expect_fault(entry, kStackOverflow);
}

constexpr rig::Scenario kScenarios[] = {
    {"undefined instruction: stopped, with registers and pc", undefined_instruction},
    {"write to nowhere: stopped, with the address", wild_write},
    {"division by zero: stopped", division_by_zero},
    {"call of null: stopped", call_of_null},
    {"fault while FPU registers are not saved yet: stopped", fault_with_fpu},
    {"fault with a stack pointer to nowhere: stopped, frame not believed", lost_stack_pointer},
    {"the same with FPU registers in use", lost_stack_pointer_with_fpu},
    {"fault with a foreign stack pointer: stopped, frame not believed", foreign_stack_pointer},
    {"stack overflow: stopped at the guard", stack_overflow},
    {"stack too full for an interrupt: stopped", no_room_for_a_frame},
    {"stack too full for the context switch: stopped", no_room_for_registers},
    {"stack too full for the switch with FPU registers: stopped", no_room_for_fpu_registers},
};

}  // namespace

std::span<const rig::Scenario> rig::fault_scenarios() {
  return kScenarios;
}
