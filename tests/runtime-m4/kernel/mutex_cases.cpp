// See mutex_cases.hpp. In each, `low` takes a mutex, makes higher threads ready, and
// releases it; their notes show who ran when. Capital letters are the other threads.
#include "tests/runtime-m4/kernel/mutex_cases.hpp"

#include <array>

namespace mutex_cases {
namespace {

using namespace robosync::kernel;

constexpr Events kGo = 1;
constexpr std::int16_t kPriority = 60;

// By rank: high, middle, between, low.
constexpr auto kHigh = Category::behavior;
constexpr auto kMiddle = Category::processing;
constexpr auto kBetween = Category::algorithm;
constexpr auto kLow = Category::sensor;

Mutex of_high{kHigh};
Mutex of_middle{kMiddle};
Stage* stage = nullptr;
Thread* high = nullptr;
Thread* middle = nullptr;
Thread* between = nullptr;
Thread* low = nullptr;

std::array<char, 32> log_text;
unsigned log_length = 0;

void note(char what) {
  if (log_length + 1 < log_text.size()) log_text[log_length++] = what;
}

Kernel& kernel() {
  return stage->kernel;
}

void go(Thread* thread) {
  kernel().signal(*thread, kGo);
}

// Waits to be called, then takes and releases `mutex`.
void use(Mutex& mutex, char name) {
  kernel().wait(kGo);
  kernel().acquire(mutex);
  note(name);
  kernel().release(mutex);
}

void run_high(void*) {
  use(of_high, 'H');
}

void run_middle(void*) {
  use(of_middle, 'M');
}

void run_between(void*) {
  kernel().wait(kGo);
  note('B');
}

// Starts all threads; the others wait when `entry` begins.
void set(void (*entry)(void*), void (*high_entry)(void*) = run_high,
         void (*middle_entry)(void*) = run_middle) {
  {
    const auto all_of_them = kernel().lock();
    high = &stage->start(0, kHigh, kPriority, high_entry);
    middle = &stage->start(1, kMiddle, kPriority, middle_entry);
    between = &stage->start(2, kBetween, kPriority, run_between);
    low = &stage->start(3, kLow, kPriority, entry);
  }
  stage->run();
}

void nested_in_any_order(Stage&) {
  set([](void*) {
    kernel().acquire(of_high);
    kernel().acquire(of_middle);
    go(middle);
    go(high);
    note('a');
    kernel().release(of_high);
    note('b');
    kernel().release(of_middle);
    note('c');
  });
}

void nested_in_order(Stage&) {
  set([](void*) {
    kernel().acquire(of_high);
    kernel().acquire(of_middle);
    go(middle);
    go(high);
    note('a');
    kernel().release(of_middle);
    note('b');
    kernel().release(of_high);
    note('c');
  });
}

// High wants a mutex that middle uses, middle wants one that low holds: neither delays high.
void chain(Stage&) {
  const auto both = [](void*) {
    kernel().wait(kGo);
    kernel().acquire(of_high);
    kernel().acquire(of_middle);
    note('M');
    kernel().release(of_middle);
    kernel().release(of_high);
  };
  const auto holder = [](void*) {
    kernel().acquire(of_middle);
    go(middle);
    note('a');
    go(high);
    note('b');
    kernel().release(of_middle);
    note('c');
  };
  set(holder, run_high, both);
}

// The deadline of a thread that wants the mutex passes while it is held: the thread runs late, and the
// holder has its own rank again.
void deadline_passes(Stage&) {
  const auto waiter = [](void*) {
    kernel().wait(kGo, kernel().now() + kTick);
    kernel().acquire(of_high);
    note('H');
    kernel().release(of_high);
  };
  const auto holder = [](void*) {
    const Time begin = kernel().now();
    kernel().acquire(of_high);
    if constexpr (!robosync::port::kTimeFlows) go(high);
    while (robosync::port::kTimeFlows && kernel().now() < begin + 3 * kTick) {
    }
    note('a');
    kernel().release(of_high);
    note('b');
    go(between);
    note('c');
  };
  set(holder, waiter);
}

// A thread that is ready but held off by the ceiling rises in rank: the ceiling rises with it.
void raised_while_held_off(Stage&) {
  set([](void*) {
    kernel().acquire(of_middle);
    go(middle);
    kernel().remove(*middle);
    middle = &stage->start(1, kMiddle, kPriority + 5, run_middle);
    go(middle);
    note('a');
    go(high);  // is below middle now, and the holder is not
    note('b');
    kernel().release(of_middle);
    note('c');
  });
}

void keeps_another(Stage&) {
  set([](void*) {
    kernel().acquire(of_middle);
    kernel().acquire(of_high);
    go(between);
    go(high);
    note('a');
    kernel().release(of_high);
    note('b');
    go(middle);
    note('c');
    kernel().release(of_middle);
    note('d');
  });
}

// A thread above the ceiling stops the holder, which has taken two mutexes.
void holder_is_stopped(Stage&) {
  const auto stopper = [](void*) {
    kernel().wait(kGo);
    kernel().stop(*low);
    note('H');
  };
  const auto holder = [](void*) {
    kernel().acquire(of_middle);
    go(middle);
    note('a');
    go(high);
    note('b');
  };
  set(holder, stopper);
}

void above_the_ceiling(Stage&) {
  const auto intruder = [](void*) {
    kernel().wait(kGo);
    note('H');
    kernel().acquire(of_middle);
    note('!');
  };
  const auto holder = [](void*) {
    kernel().acquire(of_middle);
    go(high);
    note('a');
    go(middle);
    kernel().release(of_middle);
    note('b');
  };
  set(holder, intruder);
}

// Threads above the ceiling switch while it is held; afterwards the holder continues.
void preempted_holder(Stage&) {
  set([](void*) {
    kernel().acquire(of_middle);
    go(middle);
    go(between);
    go(high);
    note('a');
    kernel().release(of_middle);
    note('b');
  });
}

constexpr Case kCases[kCount] = {
    {"mutex: two nested, the outer one given back first", nested_in_any_order, "aHbMc"},
    {"mutex: two nested, given back in order", nested_in_order, "abHMc"},
    {"mutex: a chain of three threads", chain, "aHbMc"},
    {"mutex: the deadline of one that wants it passes", deadline_passes, "aHbBc"},
    {"mutex: one that wants it is raised meanwhile", raised_while_held_off, "abMHc"},
    {"mutex: gives back the wanted one and keeps another", keeps_another, "aHbcMBd"},
    {"mutex: free again when its holder is stopped", holder_is_stopped, "aHM"},
    {"mutex: a thread above the ceiling is stopped, the holder goes on", above_the_ceiling, "HaMb"},
    {"mutex: a switch while it is held leads back to the holder", preempted_holder, "HaMBb"},
};

}  // namespace

std::span<const Case, kCount> all() {
  return kCases;
}

bool passes(const Case& example, Stage& where) {
  stage = &where;
  log_length = 0;
  example.run(where);
  log_text[log_length] = '\0';
  unsigned i = 0;
  while (i < log_length && log_text[i] == example.expected[i])
    ++i;
  return i == log_length && example.expected[i] == '\0' && !of_high.held() && !of_middle.held();
}

const char* noted() {
  return log_text.data();
}

}  // namespace mutex_cases
