// Runs every scenario on the board, then two resets, and prints "N passed, N failed".
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"
#include "tests/runtime-m4/kernel/firmware/semihosting.hpp"

// 256 bytes, as one region of the MPU may be; assembler code refers to it.
extern "C" {
alignas(256) std::array<std::uint32_t, rig::kGrantedWords> granted_area_of_tests;
}
robosync::kernel::Kernel robosync_kernel;

namespace {

namespace core = robosync::port::core;
using semihosting::print;

// The progress so far; survives the resets that are part of the test.
struct Progress {
  std::uint32_t magic;
  std::uint32_t boots;
  std::uint32_t passed;
  std::uint32_t failed;
  bool kicked;
};
constexpr std::uint32_t kMagic = 0x54455354;
[[gnu::section(".noinit")]] Progress progress;

bool scenario_failed = false;
unsigned fault_count = 0;
robosync::link::Fault fault_record;

struct Worker {
  rig::Thread thread;
  std::array<std::byte, 192> room;  // for the stack overflows that are part of the test
  alignas(
      robosync::port::kUnprivilegedStackAlignment) std::array<std::byte, rig::kWorkerStack> stack;
};
std::array<Worker, rig::kWorkers> workers;
rig::Thread conductor_thread;
alignas(8) std::array<std::byte, 1024> conductor_stack;
rig::Thread spinner_thread;
alignas(8) std::array<std::byte, 320> spinner_stack;
rig::Thread safety_thread;
alignas(8) std::array<std::byte, 512> safety_stack;

volatile unsigned checks = 0;
volatile std::uint64_t lateness = 0;

void check_safety(void*) {
  for (robosync::kernel::Time due = robosync_kernel.now();;) {
    due += robosync::kernel::milliseconds(10);
    robosync_kernel.sleep_until(due);
    const std::uint64_t late = robosync_kernel.now() - due;
    if (late > lateness) lateness = late;
    checks = checks + 1;
  }
}

void print_number(std::uint32_t number) {
  static constexpr char kDigits[10][2] = {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"};
  constexpr std::uint32_t kBillion = 1'000'000'000;
  for (std::uint32_t power = kBillion; power != 0; power /= 10)
    if (number >= power || power == 1) print(kDigits[number / power % 10]);
}

void begin() {
  granted_area_of_tests.fill(0);
  scenario_failed = false;
  fault_count = 0;
}

void end(const char* name) {
  print(scenario_failed ? "FAIL " : "ok   ");
  print(name);
  print("\n");
  ++(scenario_failed ? progress.failed : progress.passed);
}

void run_all(std::span<const rig::Scenario> scenarios) {
  for (const rig::Scenario& scenario : scenarios) {
    begin();
    scenario.run();
    for (Worker& worker : workers)
      robosync_kernel.remove(worker.thread);
    robosync_kernel.remove(safety_thread);
    end(scenario.name);
  }
}

[[noreturn]] void finish() {
  print_number(progress.passed);
  print(" passed, ");
  print_number(progress.failed);
  print(" failed\n");
  const bool good = progress.failed == 0;
  progress = {};
  semihosting::exit(good ? 0 : 1);
}

// First boot: all scenarios, then a fault after which nothing can continue.
void first_boot() {
  run_all(rig::scheduling_scenarios());
  run_all(rig::register_scenarios());
  run_all(rig::interrupt_scenarios());
  run_all(rig::mutex_scenarios());
  run_all(rig::fault_scenarios());
  run_all(rig::isolation_scenarios());
  run_all(rig::call_scenarios());
  run_all(rig::sandbox_scenarios());
  run_all(rig::device_scenarios());
  run_all(rig::division_scenarios());
  run_all(rig::context_scenarios());
  robosync_board.pwm_write(3, 1500);
  robosync::kernel::ThreadSpec spec;
  spec.name = "safety";
  spec.category = rig::Category::safety;
  spec.entry = [](void*) { asm volatile("udf #1"); };
  spec.stack = safety_stack;
  CHECK(robosync_kernel.add(safety_thread, spec));
  rig::fail("main.cpp", __LINE__, "the fault of the safety thread did not reset");
  finish();
}

// Second boot: checks the record of the first one; then a thread's fault after which no switch is possible.
void second_boot() {
  begin();
  CHECK(robosync_board.reset_reason() == robosync::link::ResetReason::software);
  const robosync::link::Fault* words = robosync::boards::last_fault();
  CHECK(words != nullptr);
  if (words != nullptr) {
    CHECK(words->thread[0] == 's' && words->thread[5] == 'y' && words->thread[6] == '\0');
    CHECK(words->cause == 1U << 16);  // undefined instruction
    CHECK(words->pc != 0);
  }
  end("a fault in the safety thread resets, and the next start knows of it");
  asm volatile("cpsid i \n udf #2");
  rig::fail("main.cpp", __LINE__, "the fault with all interrupts held off did not reset");
  finish();
}

// Third boot: checks the record of the second one; then the watchdog against a thread that locks up.
void third_boot() {
  begin();
  CHECK(robosync_board.reset_reason() == robosync::link::ResetReason::software);
  CHECK(robosync::boards::last_fault() != nullptr);
  end("a fault with all interrupts held off resets, whoever makes it");
  begin();
  robosync_board.watchdog_start();
  for (unsigned i = 0; i < 10; ++i) {
    rig::sleep_ms(30);
    robosync_board.watchdog_kick();
  }
  end("a watchdog that is kicked lets the board run");
  progress.kicked = true;
  asm volatile("cpsid i");
  while (true) {
  }
}

void fourth_boot() {
  begin();
  robosync_kernel.remove(spinner_thread);
  rig::sleep_ms(20);
  end("threads wake from idle");
  run_all(rig::idle_scenarios());
  begin();
  CHECK(progress.kicked);  // otherwise it fired before the board locked up
  CHECK(robosync_board.reset_reason() == robosync::link::ResetReason::watchdog);
  CHECK(robosync::boards::last_fault() == nullptr);
  end("the watchdog resets a board that has locked up");
  finish();
}

void conduct(void*) {
  if (progress.magic != kMagic) progress = {kMagic, 0, 0, 0, false};
  switch (progress.boots++) {
    case 0:
      first_boot();
      break;
    case 1:
      second_boot();
      break;
    case 2:
      third_boot();
      break;
    default:
      fourth_boot();
      break;
  }
}

}  // namespace

namespace rig {

Thread& start(unsigned index, std::int16_t priority, void (*entry)(void*), Category category,
              const char* name) {
  Worker& worker = workers[index];
  const robosync::kernel::ThreadSpec spec{name,  category,       priority,
                                          entry, &worker.thread, worker.stack};
  CHECK(robosync_kernel.add(worker.thread, spec));
  return worker.thread;
}

Thread& start_unprivileged(unsigned index, std::int16_t priority, void (*entry)(void*),
                           Category category, const char* name) {
  Worker& worker = workers[index];
  const std::span area(granted_area_of_tests);
  robosync_kernel.grant(
      {.readable = std::as_bytes(area), .writable = std::as_writable_bytes(area)});
  const robosync::kernel::ThreadSpec spec{name,
                                          category,
                                          priority,
                                          entry,
                                          worker.stack.data(),
                                          std::span(worker.stack).first(kUnprivilegedStack),
                                          false};
  CHECK(robosync_kernel.add(worker.thread, spec));
  return worker.thread;
}

std::span<std::uint32_t> granted_area() {
  return granted_area_of_tests;
}

std::span<std::byte> stack_of(unsigned index) {
  return workers[index].stack;
}

void watch_safety() {
  checks = 0;
  lateness = 0;
  robosync::kernel::ThreadSpec spec;
  spec.name = "safety";
  spec.category = Category::safety;
  spec.entry = check_safety;
  spec.stack = safety_stack;
  CHECK(robosync_kernel.add(safety_thread, spec));
}

unsigned safety_checks() {
  return checks;
}

std::uint64_t safety_lateness() {
  return lateness;
}

bool all_sleep() {
  return robosync_kernel.state(spinner_thread) == Thread::State::absent;
}

Thread& conductor() {
  return conductor_thread;
}

void sleep_ms(std::uint32_t ms) {
  robosync_kernel.sleep_until(robosync_kernel.now() + robosync::kernel::milliseconds(ms));
}

unsigned faults() {
  return fault_count;
}

const robosync::link::Fault& last_fault() {
  return fault_record;
}

void fail(const char* file, int line, const char* what) {
  scenario_failed = true;
  print("  ");
  print(file);
  print(":");
  print_number(static_cast<std::uint32_t>(line));
  print(": ");
  print(what);
  print("\n");
}

}  // namespace rig

namespace robosync::port::hooks {

void thread_faulted(kernel::Thread&, const link::Fault& fault) {
  ++fault_count;
  fault_record = fault;
}

void fatal_fault(const link::Fault& fault) {
  boards::reset_after(fault);
}

}  // namespace robosync::port::hooks

int main() {
  robosync::kernel::ThreadSpec spec;
  spec.name = "conductor";
  spec.category = rig::Category::behavior;
  spec.priority = rig::kConductor;
  spec.entry = conduct;
  spec.stack = conductor_stack;
  bool ready = robosync_kernel.add(conductor_thread, spec);
  spec.name = "spinner";  // see run_qemu.sh
  spec.category = rig::Category::system;
  spec.entry = [](void*) {
    while (true)
      asm volatile("");
  };
  spec.stack = spinner_stack;
  ready = ready && robosync_kernel.add(spinner_thread, spec);
  if (ready) robosync_kernel.run();
  semihosting::exit(2);
}
