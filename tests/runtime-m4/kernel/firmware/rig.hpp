// Shared by the scenarios: checks, worker threads, and printing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

namespace rig {

using robosync::kernel::Category;
using robosync::kernel::Events;
using robosync::kernel::Thread;

// A scenario runs in the conductor: category behavior, priority kConductor. Threads it adds are
// removed when it ends.
inline constexpr std::int16_t kConductor = 50;
struct Scenario {
  const char* name;
  void (*run)();
};
std::span<const Scenario> scheduling_scenarios();
std::span<const Scenario> register_scenarios();
std::span<const Scenario> interrupt_scenarios();
std::span<const Scenario> mutex_scenarios();
std::span<const Scenario> fault_scenarios();
std::span<const Scenario> device_scenarios();
std::span<const Scenario> division_scenarios();
std::span<const Scenario> isolation_scenarios();
std::span<const Scenario> call_scenarios();
std::span<const Scenario> sandbox_scenarios();
std::span<const Scenario> context_scenarios();
std::span<const Scenario> idle_scenarios();  // when no thread spins

// For the handler of timer 0: all threads sleep.
void interrupted_in_sleep();
bool all_sleep();

// Starts worker `index` (0 … kWorkers - 1) and returns its thread.
inline constexpr unsigned kWorkers = 4;
inline constexpr std::size_t kWorkerStack = 768;
Thread& start(unsigned index, std::int16_t priority, void (*entry)(void*),
              Category category = Category::behavior, const char* name = "worker");
// The same, unprivileged: it may read and write `granted_area()`, and its stack is smaller.
inline constexpr std::size_t kUnprivilegedStack = 512;
Thread& start_unprivileged(unsigned index, std::int16_t priority, void (*entry)(void*),
                           Category category = Category::behavior, const char* name = "worker");
std::span<std::uint32_t> granted_area();  // kGrantedWords
inline constexpr std::size_t kGrantedWords = 64;
std::span<std::byte> stack_of(unsigned index);  // a worker's stack, whatever runs on it

Thread& conductor();

// Sleeps for some milliseconds.
void sleep_ms(std::uint32_t ms);

// A thread of category safety that checks the time every 10 ms, as the safety monitor does. The number of
// its checks so far, and the worst lateness, in microseconds.
void watch_safety();
unsigned safety_checks();
std::uint64_t safety_lateness();

// Faults since the scenario began; the last one and its thread.
unsigned faults();
const robosync::link::Fault& last_fault();

// Records a failed check; CHECK prints where.
void fail(const char* file, int line, const char* what);
#define CHECK(condition)                                              \
  do {                                                                \
    if (!(condition)) rig::fail(__FILE_NAME__, __LINE__, #condition); \
  } while (false)

}  // namespace rig
