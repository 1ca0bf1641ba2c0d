// Assertions about the context from which the kernel's services are called. Enabled by
// ROBOSYNC_ASSERTIONS: on the host, and in the kernel's tests and its stress test on the board. In
// the firmware they take no bytes.
//
// An assertion comes first in its service, before anything changes. It reads Mode and Held, which
// the port defines (port.hpp).
#pragma once

#include "runtime-m4/port/port.hpp"

namespace robosync::kernel {

#if defined(ROBOSYNC_ASSERTIONS)
inline constexpr bool kAssertions = true;
#else
inline constexpr bool kAssertions = false;
#endif

// Called when an assertion fails, with the service and the reason. The default is port::panic, which
// halts everything. Tests set their own; if that returns, the service continues.
using AssertionFailed = void (*)(const char* service, const char* why);
extern AssertionFailed assertion_failed;

// What a service expects of its caller. Each function takes the name of the service, by default that
// of the function it is called in.
class Expect {
public:
  explicit constexpr Expect(const port::Machine& machine) : machine_(machine) {}

  // [any], except interrupts above the kernel's level, which its locks do not hold off.
  void any(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions)
      assert_that(machine_.may_call(), service, "from an interrupt above the kernel's level");
  }
  // [init]
  void init(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions)
      assert_that(machine_.mode() == port::Mode::init, service, "when threads run already");
  }
  // [init, thread]; a thread must not hold interrupts off.
  void no_handler(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      const port::Mode mode = machine_.mode();
      assert_that(mode != port::Mode::handler, service, "from an interrupt handler");
      const bool locked = mode == port::Mode::thread && machine_.held() == port::Held::lock;
      assert_that(!locked, service, "while interrupts are held off");
    }
  }
  // [thread], holding no lock.
  void thread(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      assert_that(machine_.mode() == port::Mode::thread, service, "not from a thread");
      assert_that(machine_.held() == port::Held::none, service, "while a lock is held");
    }
  }
  // From the tick interrupt; on the host, from the code that advances time.
  void no_thread(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions)
      assert_that(machine_.mode() != port::Mode::thread, service, "from a thread");
  }
  // Inside the kernel: no interrupt of its level can come in between.
  void locked(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      const bool locked = machine_.held() == port::Held::lock;
      assert_that(locked || machine_.mode() == port::Mode::handler, service, "without a lock");
    }
  }
  // … or no switch.
  void still(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      const bool still = machine_.held() != port::Held::none;
      assert_that(still || machine_.mode() != port::Mode::thread, service, "without a lock");
    }
  }
  // The firmware evaluates `holds` too, so it should be no more than a comparison of members.
  void that(bool holds, const char* why, const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) assert_that(holds, service, why);
  }

private:
  static void assert_that(bool holds, const char* service, const char* why) {
    if (!holds) [[unlikely]]
      assertion_failed(service, why);
  }

  const port::Machine& machine_;
};

}  // namespace robosync::kernel
