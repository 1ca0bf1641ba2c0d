// What an unprivileged thread cannot do: each attempt stops it, is described, and costs the
// others nothing.
//
// The code of such a thread uses only its stack, rig::granted_area() and registers, so the checks are
// in the conductor.
#include <algorithm>

#include "runtime-m4/port/cortex-m4/core.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

namespace core = robosync::port::core;

constexpr std::uint32_t kExecuteViolation = 1U << 0;  // bits of CFSR
constexpr std::uint32_t kDataViolation = 1U << 1;
constexpr std::uint32_t kStackingViolation = 1U << 4;
constexpr std::uint32_t kPreciseBusError = 1U << 9;
constexpr std::uint32_t kUndefinedInstruction = 1U << 16;
constexpr std::uint32_t kInvalidState = 1U << 17;
constexpr std::uint32_t kUnaligned = 1U << 24;
constexpr std::uint32_t kDivideByZero = 1U << 25;
constexpr std::uint32_t kStackOverflow = 1U << 20;  // port/cortex-m4/fault.hpp

constexpr unsigned kHeart = 0;
constexpr unsigned kVictim = 1;
constexpr std::uint32_t kMark = 0xC0FFEE11;

volatile unsigned beats = 0;
volatile unsigned late_beats = 0;

// Wakes every millisecond; no thread of lower rank may cost it a beat.
void heart(void*) {
  robosync::kernel::Time due = robosync_kernel.now();
  for (;;) {
    due += robosync::kernel::kTick;
    robosync_kernel.sleep_until(due);
    if (robosync_kernel.now() != due) late_beats = late_beats + 1;
    beats = beats + 1;
  }
}

bool is_victim(const robosync::link::Fault& fault) {
  constexpr char kName[] = "victim";
  for (std::size_t i = 0; i < sizeof kName; ++i)
    if (fault.thread[i] != kName[i]) return false;
  return true;
}

std::uint32_t address_of(const volatile void* of) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(of));
}

// The words in the granted area for the victim.
enum Word : std::uint8_t { kTarget, kDone };

// Starts `entry` unprivileged, in addition to the heart and the safety thread, and expects it to be
// stopped with `cause`, while the others continue.
void expect_fault(void (*entry)(void*), std::uint32_t cause, std::uint32_t target = 0) {
  beats = 0;
  late_beats = 0;
  rig::watch_safety();
  rig::start(kHeart, 60, heart);
  rig::granted_area()[kTarget] = target;
  rig::Thread& victim =
      rig::start_unprivileged(kVictim, 40, entry, rig::Category::behavior, "victim");
  rig::granted_area()[kTarget] = target;
  rig::sleep_ms(25);
  CHECK(rig::faults() == 1);
  CHECK((rig::last_fault().cause & cause) == cause);
  CHECK(is_victim(rig::last_fault()));
  CHECK(robosync_kernel.state(victim) == rig::Thread::State::stopped);
  CHECK(rig::granted_area()[kDone] != kMark);
  CHECK(beats >= 24);
  CHECK(late_beats == 0);
  CHECK(rig::safety_checks() == 2);
  CHECK(rig::safety_lateness() == 0);
}

// Where the victim was stopped.
void expect_pc_in(void (*entry)(void*), std::uint32_t bytes) {
  const std::uint32_t code = address_of(reinterpret_cast<const void*>(entry)) & ~1U;
  CHECK(rig::last_fault().pc - code < bytes);
}

// r0 is the granted area, whose first word is the address.
[[gnu::naked]] void read_target(void*) {
  asm volatile(
      "movw r1, #:lower16:granted_area_of_tests \n"
      "movt r1, #:upper16:granted_area_of_tests \n"
      "ldr  r2, [r1]                         \n"
      "ldr  r3, [r2]                         \n"
      "b    isolation_survived               \n");
}
[[gnu::naked]] void write_target(void*) {
  asm volatile(
      ".global write_to_target               \n"
      "write_to_target:                      \n"
      "movw r1, #:lower16:granted_area_of_tests \n"
      "movt r1, #:upper16:granted_area_of_tests \n"
      "ldr  r2, [r1]                         \n"
      "str  r2, [r2]                         \n"
      ".global isolation_survived            \n"
      "isolation_survived:                   \n"
      "ldr  r3, =0xC0FFEE11                  \n"
      "str  r3, [r1, #4]                     \n"
      "1: b 1b                               \n"
      ".ltorg                                \n");
}
[[gnu::naked]] void call_target(void*) {
  asm volatile(
      "movw r1, #:lower16:granted_area_of_tests \n"
      "movt r1, #:upper16:granted_area_of_tests \n"
      "ldr  r2, [r1]                         \n"
      "blx  r2                               \n"
      "b    isolation_survived               \n");
}

void expect_no_read(std::uint32_t address, std::uint32_t cause = kDataViolation) {
  expect_fault(read_target, cause, address);
  CHECK(rig::last_fault().address == address);
  expect_pc_in(read_target, 12);
}

void expect_no_write(std::uint32_t address, std::uint32_t cause = kDataViolation) {
  expect_fault(write_target, cause, address);
  CHECK(rig::last_fault().address == address);
  expect_pc_in(write_target, 14);
}

void granted_area_is_there() {
  rig::start_unprivileged(kVictim, 40, write_target);
  rig::granted_area()[kTarget] = address_of(&rig::granted_area()[rig::kGrantedWords - 1]);
  rig::sleep_ms(2);
  CHECK(rig::faults() == 0);
  CHECK(rig::granted_area()[rig::kGrantedWords - 1] == rig::granted_area()[kTarget]);
  CHECK(rig::granted_area()[kDone] == kMark);
}

void wild_read() {
  expect_no_read(0x6000'0000);
}
void wild_write() {
  expect_no_write(0x6000'0000);
}
void behind_granted_area() {
  expect_no_write(address_of(rig::granted_area().data() + rig::kGrantedWords));
}
void read_kernel() {
  expect_no_read(address_of(&robosync_kernel));
}
void write_kernel() {
  const auto* const first = reinterpret_cast<const std::uint32_t*>(&robosync_kernel);
  expect_no_write(address_of(first));
  CHECK(*first != address_of(first));
}
void read_foreign_stack() {
  expect_no_read(address_of(rig::stack_of(kHeart).data() + 512));
}
void write_foreign_stack() {
  expect_no_write(address_of(rig::stack_of(kHeart).data() + 512));
}
void write_above_own_stack() {
  expect_no_write(address_of(rig::stack_of(kVictim).data() + rig::kUnprivilegedStack));
}
void write_below_own_stack() {
  expect_no_write(address_of(rig::stack_of(kVictim).data() - 4));
  CHECK((rig::last_fault().cause & kStackOverflow) != 0);
}
void read_peripheral() {
  expect_no_read(0x4000'4004);
}
void write_peripheral() {
  expect_no_write(0x4000'8000);  // the watchdog
}
// The core's own registers: the bus refuses access, whatever the MPU allows.
void read_system() {
  expect_no_read(core::kVtor, kPreciseBusError);
}
void write_system() {
  expect_no_write(core::kMpuCtrl, kPreciseBusError);
}
void write_flash() {
  expect_no_write(0x0000'0400);
}

void execute_data() {
  rig::granted_area()[8] = 0x4770'4770;  // bx lr
  expect_fault(call_target, kExecuteViolation, address_of(&rig::granted_area()[8]) | 1);
  CHECK(rig::last_fault().pc == address_of(&rig::granted_area()[8]));
}
void execute_stack() {
  const std::uint32_t place = address_of(rig::stack_of(kVictim).data() + 64);
  expect_fault(call_target, kExecuteViolation, place | 1);
  CHECK(rig::last_fault().pc == place);
}
void null_call() {
  expect_fault(call_target, kInvalidState, 0);
  CHECK(rig::last_fault().pc == 0);
}

[[gnu::naked]] void overflow_by_pushing(void*) {
  asm volatile("1: push {r0-r7} \n b 1b");
}
void stack_overflow() {
  expect_fault(overflow_by_pushing, kStackOverflow);
  CHECK(rig::last_fault().address < address_of(rig::stack_of(kVictim).data()));
}

// The stack pointer where the core finds no room for a frame …
[[gnu::naked]] void stack_pointer_to_target(void*) {
  asm volatile(
      "movw r1, #:lower16:granted_area_of_tests \n"
      "movt r1, #:upper16:granted_area_of_tests \n"
      "ldr  r2, [r1]                         \n"
      "mov  sp, r2                           \n"
      "1: b 1b                               \n");
}
void stack_pointer_to_kernel() {
  const std::uint32_t end = address_of(&robosync_kernel) + sizeof robosync_kernel;
  const auto* const last = reinterpret_cast<const std::uint32_t*>(end) - 8;
  std::array<std::uint32_t, 8> before{};
  std::copy(last, last + before.size(), before.begin());
  expect_fault(stack_pointer_to_target, kStackingViolation, end);
  CHECK(rig::last_fault().pc == 0);
  CHECK(std::equal(before.begin(), before.end(), last));
}
// … or finds room, but privileged saving would write into others' memory.
void stack_pointer_to_granted_area() {
  const std::uint32_t bottom = address_of(rig::granted_area().data());
  const auto* const below = reinterpret_cast<const std::uint32_t*>(bottom) - 16;
  std::array<std::uint32_t, 16> before{};
  std::copy(below, below + before.size(), before.begin());
  expect_fault(stack_pointer_to_target, kStackOverflow, bottom + 40);
  CHECK(std::equal(before.begin(), before.end(), below));
  CHECK(rig::last_fault().pc == 0);  // that frame is not trusted
}
void no_room_to_save() {
  std::byte* const bottom = rig::stack_of(kVictim).data();
  const auto* const below = reinterpret_cast<const std::uint32_t*>(bottom) - 16;
  std::array<std::uint32_t, 16> before{};
  std::copy(below, below + before.size(), before.begin());
  expect_fault(stack_pointer_to_target, kStackOverflow, address_of(bottom) + 40);
  CHECK(std::equal(before.begin(), before.end(), below));
  CHECK(rig::last_fault().pc != 0);
}

[[gnu::naked]] void divides_by_zero(void*) {
  asm volatile("movs r1, #0 \n udiv r0, r0, r1 \n 1: b 1b");
}
void division_by_zero() {
  expect_fault(divides_by_zero, kDivideByZero);
  expect_pc_in(divides_by_zero, 4);
}

[[gnu::naked]] void loads_unaligned(void*) {
  asm volatile("mov r1, sp \n subs r1, #30 \n ldrd r2, r3, [r1] \n 1: b 1b");
}
void unaligned() {
  expect_fault(loads_unaligned, kUnaligned);
}

// With FPU registers in use, and a stack pointer to nowhere: a fault while the core takes a fault.
[[gnu::naked]] void faults_twice(void*) {
  asm volatile(
      "vmov s0, r0         \n"
      "ldr  r0, =0x60000000 \n"
      "mov  sp, r0         \n"
      "udf  #0             \n"
      ".ltorg              \n");
}
void fault_inside_fault() {
  expect_fault(faults_twice, kUndefinedInstruction | kStackingViolation);
}

// Registers that only privileged code may change: writing them does nothing, or only what the core allows.
[[gnu::naked]] void grabs_privileges(void*) {
  asm volatile(
      "movs r0, #0                           \n"
      "msr  control, r0                      \n"
      "movs r0, #1                           \n"
      "msr  basepri, r0                      \n"
      "cpsid i                               \n"
      "isb                                   \n"
      "b    write_to_target                  \n");
}
void no_way_to_privileges() {
  expect_fault(grabs_privileges, kDataViolation, address_of(&robosync_kernel));
}

[[gnu::naked]] void loops(void*) {
  asm volatile("1: b 1b");
}
// The heart and the safety thread outrank it and keep running. Nothing stops it.
void endless_loop() {
  beats = 0;
  late_beats = 0;
  rig::watch_safety();
  rig::start(kHeart, 60, heart);
  rig::start_unprivileged(kVictim, 40, loops, rig::Category::behavior, "victim");
  rig::sleep_ms(105);
  CHECK(rig::faults() == 0);
  CHECK(beats >= 104);
  CHECK(late_beats == 0);
  CHECK(rig::safety_checks() == 10);
  CHECK(rig::safety_lateness() == 0);
}

// Thread 1 and thread 2 take turns, and neither can see the other's stack.
void windows_change() {
  rig::start_unprivileged(kVictim, 40, loops);
  rig::start_unprivileged(2, 41, write_target, rig::Category::behavior, "victim");
  rig::granted_area()[kTarget] = address_of(rig::stack_of(kVictim).data() + 256);
  rig::sleep_ms(5);
  CHECK(rig::faults() == 1);
  CHECK(rig::last_fault().address == rig::granted_area()[kTarget]);
}

void bad_stacks_are_refused() {
  static rig::Thread thread;
  robosync::kernel::ThreadSpec spec;
  spec.entry = loops;
  spec.privileged = false;
  spec.stack = rig::stack_of(3).subspan(32, 512);
  CHECK(!robosync_kernel.add(thread, spec));
  spec.stack = rig::stack_of(3).first(500);
  CHECK(!robosync_kernel.add(thread, spec));
}

constexpr rig::Scenario kScenarios[] = {
    {"unprivileged: its stack and the open area are open", granted_area_is_there},
    {"unprivileged: wild read", wild_read},
    {"unprivileged: wild write", wild_write},
    {"unprivileged: write behind the open area", behind_granted_area},
    {"unprivileged: read of the kernel", read_kernel},
    {"unprivileged: write to the kernel", write_kernel},
    {"unprivileged: read of another thread's stack", read_foreign_stack},
    {"unprivileged: write to another thread's stack", write_foreign_stack},
    {"unprivileged: write above its own stack", write_above_own_stack},
    {"unprivileged: write below its own stack", write_below_own_stack},
    {"unprivileged: the stack of another one is closed", windows_change},
    {"unprivileged: read of a peripheral", read_peripheral},
    {"unprivileged: write to a peripheral", write_peripheral},
    {"unprivileged: read of the core's registers", read_system},
    {"unprivileged: write to the core's registers", write_system},
    {"unprivileged: write to flash", write_flash},
    {"unprivileged: execution of data", execute_data},
    {"unprivileged: execution of its stack", execute_stack},
    {"unprivileged: call of null", null_call},
    {"unprivileged: stack overflow", stack_overflow},
    {"unprivileged: stack pointer into the kernel", stack_pointer_to_kernel},
    {"unprivileged: stack pointer into the open area", stack_pointer_to_granted_area},
    {"unprivileged: no room to save registers", no_room_to_save},
    {"unprivileged: division by zero", division_by_zero},
    {"unprivileged: unaligned access that traps", unaligned},
    {"unprivileged: fault inside a fault", fault_inside_fault},
    {"unprivileged: no way to privileges", no_way_to_privileges},
    {"unprivileged: endless loop, others keep their time", endless_loop},
    {"unprivileged: stacks that the MPU cannot fit are refused", bad_stacks_are_refused},
};

}  // namespace

std::span<const rig::Scenario> rig::isolation_scenarios() {
  return kScenarios;
}
