// Preemption, order and time on the board: the same guarantees as in the host tests, with real
// context switches and a real tick.
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

using robosync::kernel::Time;

std::array<char, 32> log_text;
unsigned log_length = 0;

void note(char what) {
  if (log_length < log_text.size()) log_text[log_length++] = what;
}

bool log_is(const char* expected) {
  unsigned i = 0;
  for (; i < log_length && expected[i] != '\0'; ++i) {
    if (log_text[i] != expected[i]) return false;
  }
  return i == log_length && expected[i] == '\0';
}

void higher_preempts() {
  log_length = 0;
  const auto body = [](void*) {
    robosync_kernel.wait(1);
    note('h');
  };
  rig::Thread& high = rig::start(0, rig::kConductor + 1, body);
  note('a');
  robosync_kernel.signal(high, 1);
  note('b');
  CHECK(log_is("ahb"));
}

void lower_waits() {
  log_length = 0;
  rig::start(0, rig::kConductor - 1, [](void*) { note('l'); });
  note('a');
  rig::sleep_ms(2);
  note('b');
  CHECK(log_is("alb"));
}

void lock_holds_back() {
  log_length = 0;
  {
    const auto lock = robosync_kernel.lock();
    rig::start(0, 60, [](void*) { note('0'); });
    rig::start(1, 70, [](void*) { note('1'); });
    rig::start(2, 80, [](void*) { note('2'); });
    note('a');
  }
  note('b');
  CHECK(log_is("a210b"));
}

void sleep_lasts() {
  const Time before = robosync_kernel.now();
  rig::sleep_ms(7);
  const Time after = robosync_kernel.now();
  CHECK(after - before == 7000);
}

void timeout_and_event() {
  const auto body = [](void*) {
    rig::sleep_ms(3);
    robosync_kernel.signal(rig::conductor(), 4);
  };
  rig::start(0, 60, body);
  const Time before = robosync_kernel.now();
  CHECK(robosync_kernel.wait(4, before + 2000) == 0);
  CHECK(robosync_kernel.now() == before + 2000);
  CHECK(robosync_kernel.wait(4, before + 20000) == 4);
  CHECK(robosync_kernel.now() == before + 3000);
}

void ended_thread_is_stopped() {
  rig::Thread& brief = rig::start(0, 60, [](void*) {});
  CHECK(robosync_kernel.state(brief) == rig::Thread::State::stopped);
  CHECK(rig::faults() == 0);
}

// 200 timed wake-ups of three threads at the same time: each comes at its tick.
std::array<unsigned, 3> late;
std::array<unsigned, 3> woken;

void periodic(void* argument) {
  const auto* self = static_cast<rig::Thread*>(argument);
  const unsigned index = static_cast<unsigned>(self->priority().now - 60);
  const Time period = 1000 * (2 * index + 1);
  Time due = robosync_kernel.now();
  for (unsigned i = 0; i < 200; ++i) {
    due += period;
    robosync_kernel.sleep_until(due);
    ++woken[index];
    if (robosync_kernel.now() != due) ++late[index];
  }
}

void many_sleepers() {
  late = {};
  woken = {};
  for (unsigned i = 0; i < 3; ++i)
    rig::start(i, static_cast<std::int16_t>(60 + i), periodic);
  rig::sleep_ms(1001);
  for (unsigned i = 0; i < 3; ++i) {
    CHECK(woken[i] == 200);
    CHECK(late[i] == 0);
  }
}

void stack_use_is_known() {
  rig::Thread& thread = rig::start(0, 60, [](void*) {
    volatile std::uint8_t bytes[200];
    for (volatile std::uint8_t& byte : bytes)
      byte = 1;
  });
  const std::size_t used = thread.stack_used();
  CHECK(used >= 200);
  CHECK(used < rig::kWorkerStack);
}

// A thread of lower rank spins while the conductor sleeps: nearly all of the time is counted for it, and none
// for any other thread.
void run_time_is_known() {
  rig::Thread& spinner = rig::start(0, rig::kConductor - 1, [](void*) {
    while (true)
      asm volatile("");
  });
  const std::uint32_t begin = robosync_kernel.clock();
  const std::uint32_t mine = robosync_kernel.run_time(rig::conductor());
  rig::sleep_ms(5);
  const std::uint32_t passed = robosync_kernel.clock() - begin;
  const std::uint32_t own = robosync_kernel.run_time(rig::conductor()) - mine;
  CHECK(passed > 4 * 25'000);
  CHECK(robosync_kernel.run_time(spinner) > passed / 100 * 95);
  CHECK(robosync_kernel.run_time(spinner) <= passed);
  CHECK(own < passed / 20);
}

void raised_thread_preempts() {
  log_length = 0;
  rig::Thread& low = rig::start(0, rig::kConductor - 1, [](void*) { note('l'); });
  note('a');
  robosync_kernel.set_priority(low, {rig::kConductor + 1, rig::kConductor - 1});
  note('b');
  CHECK(log_is("alb"));
}

constexpr rig::Scenario kScenarios[] = {
    {"a signal to a higher thread runs it at once", higher_preempts},
    {"a lower thread runs when the higher one waits", lower_waits},
    {"a thread that is raised above the running one runs at once", raised_thread_preempts},
    {"how long threads run is known", run_time_is_known},
    {"a lock holds switches back; then the highest runs first", lock_holds_back},
    {"a sleep lasts as long as it should", sleep_lasts},
    {"a wait ends with its deadline or its event", timeout_and_event},
    {"a thread whose entry returns is stopped", ended_thread_is_stopped},
    {"three periodic threads wake at their ticks", many_sleepers},
    {"the stack's high-water mark is known", stack_use_is_known},
};

}  // namespace

std::span<const rig::Scenario> rig::scheduling_scenarios() {
  return kScenarios;
}
