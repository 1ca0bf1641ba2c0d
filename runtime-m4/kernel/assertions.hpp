// Assertions of where the kernel's services are called from. On in builds with ROBOSYNC_ASSERTIONS:
// on the host, and in the kernel's tests and its stress test on the board. In the firmware nothing
// of them is left, not a byte.
//
// An assertion stands first in its service, before anything is changed. Mode and Held, which it
// looks at, come from the port (port.hpp).
#pragma once

#include "runtime-m4/port/port.hpp"

namespace robosync::kernel {

#if defined(ROBOSYNC_ASSERTIONS)
inline constexpr bool kAssertions = true;
#else
inline constexpr bool kAssertions = false;
#endif

// Called when one does not hold: `service` must not be called like that, and why. At first it is
// port::panic, which ends everything. Tests put their own in its place; if that returns, the service
// goes on.
using AssertionFailed = void (*)(const char* service, const char* why);
extern AssertionFailed assertion_failed;

// What a service expects of whoever calls it. Each takes the name of the function it stands in.
class Expect {
public:
  explicit constexpr Expect(const port::Machine& machine) : machine_(machine) {}

  // [any]: but no interrupt above the kernel's level, which its locks do not hold off.
  void any(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions)
      assert_that(machine_.may_call(), service, "from an interrupt above the kernel's level");
  }
  // [init]
  void init(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions)
      assert_that(machine_.mode() == port::Mode::init, service, "when threads run already");
  }
  // [init, thread], and interrupts are not held off.
  void no_handler(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      const port::Mode mode = machine_.mode();
      assert_that(mode != port::Mode::handler, service, "from an interrupt handler");
      const bool locked = mode == port::Mode::thread && machine_.held() == port::Held::lock;
      assert_that(!locked, service, "while interrupts are held off");
    }
  }
  // [thread], without any lock.
  void thread(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      assert_that(machine_.mode() == port::Mode::thread, service, "not from a thread");
      assert_that(machine_.held() == port::Held::none, service, "while a lock is held");
    }
  }
  // From the tick interrupt; where there are none, from whoever lets time pass.
  void no_thread(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions)
      assert_that(machine_.mode() != port::Mode::thread, service, "from a thread");
  }
  // Inside of the kernel: no interrupt of its level comes in between.
  void locked(const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      const bool locked = machine_.held() == port::Held::lock;
      assert_that(locked || machine_.mode() == port::Mode::handler, service, "without a lock");
    }
  }
  // `holds` is worked out in the firmware, too: no more than a comparison of members.
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
