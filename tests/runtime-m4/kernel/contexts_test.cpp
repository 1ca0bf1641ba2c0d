// Kernel services called from contexts where they are not allowed: the assertion reports it, and
// the call has no effect. Contexts that only the Cortex-M4 has (interrupts): firmware/contexts.cpp.
#include <string>

#include <catch2/catch.hpp>

#include "runtime-m4/kernel/assertions.hpp"
#include "runtime-m4/kernel/calls.hpp"
#include "tests/runtime-m4/kernel/rig.hpp"

namespace robosync::kernel::test {
namespace {

// While one exists, a failed assertion throws "service: why".
class Throwing {
public:
  Throwing() {
    assertion_failed = [](const char* service, const char* why) {
      throw std::string(service) + ": " + why;
    };
  }
  ~Throwing() { assertion_failed = port::panic; }
};

// The message of the assertion that the call fails; "" if none.
template <class Call>
std::string said(Call call) {
  const Throwing throwing;
  try {
    call();
  } catch (const std::string& text) {
    return text;
  }
  return "";
}

// The same for a call from a thread.
template <class Call>
std::string said_in_thread(Rig& rig, Call call) {
  std::string text = "it never ran";
  rig.add("t", Category::behavior, 1, [&] { text = said(call); });
  rig.kernel.run();
  return text;
}

TEST_CASE("Assertions: what blocks is for threads") {
  Rig rig;
  Kernel& kernel = rig.kernel;
  Mutex mutex{Category::behavior};
  CHECK(said([&] { kernel.wait(1); }) == "wait: not from a thread");
  CHECK(said([&] { kernel.wait(1, 5000); }) == "wait: not from a thread");
  CHECK(said([&] { kernel.sleep_until(5000); }) == "sleep_until: not from a thread");
  CHECK(said([&] { kernel.acquire(mutex); }) == "acquire: not from a thread");
  CHECK(said([&] { kernel.release(mutex); }) == "release: not from a thread");
}

TEST_CASE("Assertions: nothing blocks under a lock") {
  Rig rig;
  Kernel& kernel = rig.kernel;
  Mutex mutex{Category::behavior};
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock();
          kernel.wait(1);
        }) == "wait: while a lock is held");
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock_interrupts();
          kernel.sleep_until(5000);
        }) == "sleep_until: while a lock is held");
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock();
          kernel.signal_and_wait(kernel.current(), 1, 1, 5000);
        }) == "signal_and_wait: while a lock is held");
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock();
          kernel.acquire(mutex);
        }) == "acquire: while a lock is held");
}

TEST_CASE("Assertions: who holds a mutex neither waits nor gives back another") {
  Rig rig;
  Kernel& kernel = rig.kernel;
  Mutex mutex{Category::behavior};
  Mutex another{Category::behavior};
  CHECK(said_in_thread(rig, [&] {
          const MutexGuard mine(kernel, mutex);
          kernel.wait(1);
        }) == "wait: while it holds a mutex");
  CHECK(said_in_thread(rig, [&] {
          const MutexGuard mine(kernel, mutex);
          kernel.sleep_until(5000);
        }) == "sleep_until: while it holds a mutex");
  CHECK(said_in_thread(rig, [&] {
          const MutexGuard mine(kernel, mutex);
          kernel.release(another);
        }) == "release: by a thread that does not hold it");
}

TEST_CASE("Assertions: threads do not come and go while interrupts are held off") {
  Rig rig;
  Kernel& kernel = rig.kernel;
  Rig::Worker& other = rig.add("other", Category::behavior, 0, [] {});
  const std::string held = ": while interrupts are held off";
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock_interrupts();
          kernel.remove(other.thread);
        }) == "remove" + held);
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock_interrupts();
          (void)rig.start(other, "other", Category::behavior, 0);
        }) == "add" + held);
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock_interrupts();
          kernel.set_priority(other.thread, {1, 1});
        }) == "set_priority" + held);
  CHECK(said_in_thread(rig, [&] {
          const auto lock = kernel.lock();  // this is allowed
          kernel.set_priority(other.thread, {1, 1});
        }).empty());
}

TEST_CASE("Assertions: no thread removes itself, runs the kernel or makes time pass") {
  Rig rig;
  Kernel& kernel = rig.kernel;
  CHECK(said_in_thread(rig, [&] { kernel.remove(kernel.current()); }) ==
        "remove: of the running thread");
  CHECK(said_in_thread(rig, [&] { kernel.run(); }) == "run: when threads run already");
  CHECK(said_in_thread(rig, [&] { kernel.on_tick(1); }) == "on_tick: from a thread");
}

TEST_CASE("Assertions: a system call holds interrupts off, as its handler does on the board") {
  Rig rig;
  Kernel& kernel = rig.kernel;
  port::CallFrame call(static_cast<std::uint32_t>(Call::wait), 1);
  CHECK(said_in_thread(rig, [&] { kernel.answer(call); }) == "block: without a lock");
}

TEST_CASE("Assertions: right calls are silent, before run() and from threads") {
  Rig rig;
  Kernel& kernel = rig.kernel;
  Mutex mutex{Category::behavior};
  Rig::Worker& other = rig.add("other", Category::behavior, 0, [&] { kernel.wait(1); });
  CHECK(said([&] {
          kernel.set_priority(other.thread, {2, 2});
          kernel.watch(other.thread, 2, 4);
          kernel.signal(other.thread, 8);
          (void)kernel.now();
        }).empty());
  CHECK(said_in_thread(rig, [&] {
          const MutexGuard mine(kernel, mutex);
          const auto lock = kernel.lock();
          kernel.signal(other.thread, 1);
        }).empty());
}

}  // namespace
}  // namespace robosync::kernel::test
