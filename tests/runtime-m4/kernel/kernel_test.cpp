// The kernel on the host: its guarantees for threads, observed from threads.
#include "runtime-m4/kernel/kernel.hpp"

#include <string>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/kernel/rig.hpp"

using namespace robosync::kernel;
using robosync::kernel::test::Rig;

namespace {

constexpr Events kA = 1;
constexpr Events kB = 2;

}  // namespace

TEST_CASE("threads run in the order of their ranks, equals in the order of their creation") {
  Rig rig;
  const auto body = [&] { rig.note(rig.kernel.current().name()); };
  rig.add("l", Category::system, 0, body);
  rig.add("s", Category::sensor, 1, body);
  rig.add("c", Category::control, 1, body);
  rig.add("t", Category::sensor, 1, body);
  rig.add("h", Category::sensor, 2, body);
  rig.add("!", Category::safety, 0, body);
  CHECK(rig.names() == "!chstl");
  for (std::size_t rank = 0; rank < 6; ++rank)
    CHECK(rig.kernel.threads()[rank]->rank() == rank);
  rig.kernel.run();
  CHECK(rig.log == "! c h s t l");
}

TEST_CASE("a signal to a higher thread runs it at once, to a lower one later") {
  Rig rig;
  auto& high = rig.add("high", Category::behavior, 9, [&] {
    rig.kernel.wait(kA);
    rig.note("high");
  });
  auto& low = rig.add("low", Category::behavior, 1, [&] {
    rig.kernel.wait(kA);
    rig.note("low");
  });
  rig.add("middle", Category::behavior, 5, [&] {
    rig.kernel.sleep_until(rig.kernel.now() + 1000);
    rig.kernel.signal(low.thread, kA);
    rig.note("after-low");
    rig.kernel.signal(high.thread, kA);
    rig.note("after-high");
  });
  rig.kernel.run();
  CHECK(rig.log == "after-low high after-high low");
}

TEST_CASE("a lock holds a switch back until the outermost one ends") {
  Rig rig;
  auto& high = rig.add("high", Category::behavior, 9, [&] {
    rig.kernel.wait(kA);
    rig.note("high");
  });
  rig.add("low", Category::behavior, 1, [&] {
    {
      const auto outer = rig.kernel.lock();
      {
        const auto inner = rig.kernel.lock();
        rig.kernel.signal(high.thread, kA);
      }
      rig.note("locked");
    }
    rig.note("unlocked");
  });
  rig.kernel.run();
  CHECK(rig.log == "locked high unlocked");
}

TEST_CASE("a signal before the wait is not lost, and is taken once") {
  Rig rig;
  auto& waiter = rig.add("waiter", Category::behavior, 1, [&] {
    rig.note(std::to_string(rig.kernel.wait(kA | kB)));
    rig.note(std::to_string(rig.kernel.wait(kA, 5000)));
    CHECK(rig.kernel.now() == 5000);
  });
  rig.kernel.signal(waiter.thread, kA);
  rig.kernel.signal(waiter.thread, kA);
  rig.kernel.run();
  CHECK(rig.log == "1 0");
}

TEST_CASE("who is woken by one that signals and waits finds it waiting") {
  Rig rig;
  Thread* waiter = nullptr;
  auto& high = rig.add("high", Category::behavior, 9, [&] {
    for (int round = 0; round < 3; ++round) {
      rig.note(std::to_string(rig.kernel.wait(kA)));
      rig.note(rig.kernel.state(*waiter) == Thread::State::blocked ? "waits" : "runs");
      if (round == 1) rig.kernel.signal(*waiter, kB);
    }
  });
  auto& low = rig.add("low", Category::behavior, 1, [&] {
    const auto tell = [&](Time deadline) {
      rig.note(std::to_string(rig.kernel.signal_and_wait(high.thread, kA, kB, deadline)));
    };
    tell(5000);
    CHECK(rig.kernel.now() == 5000);
    tell(kForever);
    rig.kernel.signal(rig.kernel.current(), kB);
    tell(kForever);  // a pending event is not waited for
  });
  waiter = &low.thread;
  rig.kernel.run();
  CHECK(rig.log == "1 waits 0 1 waits 2 1 runs 2");
}

TEST_CASE("events outside the mask are kept and do not wake") {
  Rig rig;
  auto& waiter = rig.add("waiter", Category::behavior, 9, [&] {
    rig.note(std::to_string(rig.kernel.wait(kA)));
    rig.note(std::to_string(rig.kernel.wait(kB, 0)));  // only a check
    rig.note(std::to_string(rig.kernel.wait(kB, 0)));
  });
  rig.add("signaller", Category::behavior, 1, [&] {
    rig.kernel.signal(waiter.thread, kB);
    rig.note("b-sent");
    rig.kernel.signal(waiter.thread, kA);
  });
  rig.kernel.run();
  CHECK(rig.log == "b-sent 1 2 0");
}

TEST_CASE("all events that came before a thread got to run are returned together") {
  Rig rig;
  auto& waiter = rig.add("waiter", Category::behavior, 1,
                         [&] { rig.note(std::to_string(rig.kernel.wait(7))); });
  rig.add("signaller", Category::behavior, 9, [&] {
    rig.kernel.sleep_until(1000);
    rig.kernel.signal(waiter.thread, kA);
    rig.kernel.signal(waiter.thread, kB);
    rig.kernel.signal(waiter.thread, 8);
  });
  rig.kernel.run();
  CHECK(rig.log == "3");
}

TEST_CASE("sleeping: deadlines are rounded up to ticks, events do not end it") {
  Rig rig;
  auto& sleeper = rig.add("sleeper", Category::behavior, 1, [&] {
    rig.kernel.sleep_until(1500);
    CHECK(rig.kernel.now() == 2000);
    rig.kernel.sleep_until(100);  // in the past: no wait
    CHECK(rig.kernel.now() == 2000);
    CHECK(rig.kernel.wait(kA, 3000) == kA);
  });
  rig.add("signaller", Category::behavior, 9, [&] {
    rig.kernel.sleep_until(1000);
    rig.kernel.signal(sleeper.thread, kA);
  });
  rig.kernel.run();
  CHECK(rig.kernel.state(sleeper.thread) == Thread::State::stopped);
}

TEST_CASE("a sleep beyond the reach of the timer lasts to its end") {
  Rig rig;
  const Time far = Time{200} * 3600 * 1'000'000;  // 200 h
  rig.add("sleeper", Category::behavior, 1, [&] {
    rig.kernel.sleep_until(far);
    rig.note(std::to_string(rig.kernel.now() / 1'000'000));
  });
  rig.kernel.run();
  CHECK(rig.log == "720000");
}

TEST_CASE("ticks that are counted late, many at once, wake all who were due") {
  Rig rig;
  for (const auto& [name, due] : {std::pair{"a", 1}, {"b", 40}, {"c", 33}, {"d", 2000}, {"e", 60}})
    rig.add(name, Category::behavior, 1, [&rig, due = due, name = name] {
      rig.kernel.sleep_until(Time(due) * kTick);
      rig.note(name + std::to_string(rig.kernel.now() / kTick));
    });
  rig.kernel.machine().run_until(0);
  rig.kernel.on_tick(50);
  rig.kernel.on_tick(0);
  rig.kernel.machine().run_until(0);
  CHECK(rig.log == "a50 b50 c50");
  rig.kernel.run();
  CHECK(rig.log == "a50 b50 c50 e60 d2000");
}

TEST_CASE("time goes on when the count of ticks wraps") {
  Rig rig;
  const Time wrap = (Time{1} << 32) * kTick;
  rig.add("sleeper", Category::behavior, 1, [&] {
    for (const Time due : {wrap - kTick, wrap, wrap + 3 * kTick, 2 * wrap + kTick}) {
      rig.kernel.sleep_until(due);
      CHECK(rig.kernel.now() == due);
    }
    rig.note("done");
  });
  rig.kernel.run();
  CHECK(rig.log == "done");
}

TEST_CASE("an event ends a timed wait, and its deadline does not strike later") {
  Rig rig;
  auto& waiter = rig.add("waiter", Category::behavior, 9, [&] {
    CHECK(rig.kernel.wait(kA, 10'000) == kA);
    CHECK(rig.kernel.now() == 2000);
    CHECK(rig.kernel.wait(kA, 30'000) == 0);
    CHECK(rig.kernel.now() == 30'000);
    rig.note("done");
  });
  rig.add("signaller", Category::behavior, 1, [&] {
    rig.kernel.sleep_until(2000);
    rig.kernel.signal(waiter.thread, kA);
  });
  rig.kernel.run();
  CHECK(rig.log == "done");
}

TEST_CASE("a thread whose entry returns is stopped, the watcher is told, the others go on") {
  Rig rig;
  auto& watcher = rig.add("watcher", Category::control, 9, [&] {
    CHECK(rig.kernel.wait(kB) == kB);
    rig.note("told");
  });
  rig.kernel.watch(watcher.thread, kB, 0);
  auto& brief = rig.add("brief", Category::behavior, 5, [&] { rig.note("brief"); });
  rig.add("other", Category::behavior, 1, [&] {
    rig.note("other");
    rig.kernel.signal(brief.thread, kA);  // the thread has ended: no effect
    CHECK(rig.kernel.state(brief.thread) == Thread::State::stopped);
  });
  rig.kernel.run();
  CHECK(rig.log == "brief told other");
}

TEST_CASE("stop takes a thread out whether it is ready, waiting or asleep") {
  Rig rig;
  auto& ready = rig.add("ready", Category::behavior, 1, [&] { rig.note("ready"); });
  auto& waiting = rig.add("waiting", Category::behavior, 8, [&] {
    rig.kernel.wait(kA);
    rig.note("waiting");
  });
  auto& asleep = rig.add("asleep", Category::behavior, 7, [&] {
    rig.kernel.sleep_until(5000);
    rig.note("asleep");
  });
  rig.add("stopper", Category::behavior, 5, [&] {
    rig.kernel.stop(ready.thread);
    rig.kernel.stop(waiting.thread);
    rig.kernel.stop(asleep.thread);
    rig.kernel.signal(waiting.thread, kA);
    rig.kernel.sleep_until(9000);
    rig.note("end");
  });
  rig.kernel.run();
  CHECK(rig.log == "end");
}

TEST_CASE("a removed thread is gone, ranks close up, and it can be added again") {
  Rig rig;
  auto& top = rig.add("t", Category::behavior, 9, [&] { rig.kernel.wait(kA); });
  auto& middle = rig.add("m", Category::behavior, 5, [&] {
    rig.note("m");
    rig.kernel.wait(kA, 4000);
    rig.note("m-woke");
  });
  auto& low = rig.add("l", Category::behavior, 1, [&] {
    rig.kernel.remove(middle.thread);
    CHECK(rig.names() == "tl");
    CHECK(rig.kernel.current().rank() == 1);
    CHECK(rig.kernel.state(middle.thread) == Thread::State::absent);
    rig.kernel.signal(middle.thread, kA);
    rig.kernel.sleep_until(6000);
    REQUIRE(rig.start(middle, "m", Category::behavior, 0));
    CHECK(rig.names() == "tlm");
    rig.note("l");
  });
  rig.kernel.run();
  CHECK(rig.log == "m l m m-woke");
  CHECK(rig.kernel.state(top.thread) == Thread::State::blocked);
  CHECK(rig.kernel.state(low.thread) == Thread::State::stopped);
}

TEST_CASE("a thread added by a lower one runs at once, under a lock when the lock ends") {
  Rig rig;
  rig.add("loader", Category::system, 0, [&] {
    rig.add("a", Category::behavior, 1, [&] { rig.note("a"); });
    rig.note("alone");
    {
      const auto batch = rig.kernel.lock();
      rig.add("b", Category::behavior, 1, [&] { rig.note("b"); });
      rig.add("c", Category::behavior, 2, [&] { rig.note("c"); });
      rig.note("batch");
    }
    rig.note("end");
  });
  rig.kernel.run();
  CHECK(rig.log == "a alone batch c b end");
}

TEST_CASE("64 threads and no more; a thread is added once; a spec must have an entry") {
  Rig rig;
  unsigned ran = 0;
  for (unsigned i = 0; i < kMaxThreads; ++i) {
    rig.add("x", Category::behavior, static_cast<std::int16_t>(i % 7), [&] {
      rig.kernel.sleep_until(rig.kernel.now() + kTick * (rig.kernel.current().rank() + 1U));
      ++ran;
    });
  }
  Rig::Worker extra;
  CHECK_FALSE(rig.start(extra, "65", Category::behavior, 1));
  rig.kernel.run();
  CHECK(ran == kMaxThreads);

  Kernel kernel;
  Thread thread;
  ThreadSpec spec;
  CHECK_FALSE(kernel.add(thread, spec));
  spec.entry = [](void*) {};
  CHECK(kernel.add(thread, spec));
  CHECK_FALSE(kernel.add(thread, spec));
}

TEST_CASE("run_until stops the clock where it is told and goes on from there") {
  Rig rig;
  rig.add("ticker", Category::sensor, 0, [&] {
    for (Time at = 0;; at += 10'000) {
      rig.kernel.sleep_until(at);
      rig.note(std::to_string(rig.kernel.now() / 1000));
    }
  });
  auto& machine = rig.kernel.machine();
  machine.run_until(9999);
  CHECK(rig.log == "0");
  CHECK(rig.kernel.now() == 9000);
  machine.run_until(20'000);
  CHECK(rig.log == "0 10 20");
  CHECK(rig.kernel.now() == 20'000);
  machine.run_until(20'500);
  CHECK(rig.log == "0 10 20");
}

TEST_CASE("a signal from outside between two runs is served when the run goes on") {
  Rig rig;
  auto& waiter = rig.add("waiter", Category::sensor, 0, [&] {
    rig.kernel.wait(kA);
    rig.note(std::to_string(rig.kernel.now()));
  });
  rig.kernel.machine().run_until(3000);
  rig.kernel.signal(waiter.thread, kA);
  CHECK(rig.log.empty());
  rig.kernel.machine().run_until(3000);
  CHECK(rig.log == "3000");
}

TEST_CASE("two kernels in one process do not touch each other") {
  Rig left;
  Rig right;
  left.add("l", Category::sensor, 0, [&] {
    left.kernel.sleep_until(5000);
    left.note("left");
  });
  right.add("r", Category::sensor, 0, [&] {
    right.kernel.sleep_until(7000);
    right.note("right");
  });
  left.kernel.run();
  CHECK(left.kernel.now() == 5000);
  CHECK(right.kernel.now() == 0);
  right.kernel.run();
  CHECK(left.log + right.log == "leftright");
}
