// An unprivileged function called by a thread of category safety: what it returns, and that it cannot damage its
// caller. An access to forbidden memory is a fault that ends everything: tests/e2e/test_isolation.py.
#include <array>

#include "runtime-m4/port/port.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

using robosync::port::Sandbox;

constexpr unsigned kCalls = 20'000;  // several milliseconds, with a tick in each

alignas(512) std::array<std::byte, 512> window;
Sandbox sandbox;

volatile unsigned good = 0;
volatile bool done = false;

// Returns r0 + r1 + r2, and does everything to registers and stack that a function must not do.
[[gnu::naked]] std::int32_t adds_and_spoils(void*, const void*, void*) {
  asm volatile(
      "add  r0, r0, r1 \n"
      "add  r0, r0, r2 \n"
      "mvn  r4, #0     \n"
      "mov  r5, r4     \n"
      "mov  r6, r4     \n"
      "mov  r7, r4     \n"
      "mov  r8, r4     \n"
      "mov  r9, r4     \n"
      "mov  r10, r4    \n"
      "mov  r11, r4    \n"
      "push {r4-r11}   \n"
      "msr  apsr_nzcvq, r4 \n"
      "bx   lr         \n");
}

// Whether a call that returns 1 + 2 + 4 preserves all callee-saved registers.
[[gnu::naked]] bool call_keeps_registers(const Sandbox*) {
  asm volatile(
      "push {r4-r11, lr}  \n"
      "mov  r3, r0        \n"
      "movs r4, #4        \n"
      "movs r5, #5        \n"
      "movs r6, #6        \n"
      "movs r7, #7        \n"
      "mov  r8, #8        \n"
      "mov  r9, #9        \n"
      "mov  r10, #10      \n"
      "mov  r11, #11      \n"
      "movs r0, #1        \n"
      "movs r1, #2        \n"
      "movs r2, #4        \n"
      "bl   robosync_call_in_sandbox \n"
      "cmp  r0, #7        \n"
      "itttt eq           \n"
      "cmpeq r4, #4       \n"
      "cmpeq r5, #5       \n"
      "cmpeq r6, #6       \n"
      "cmpeq r7, #7       \n"
      "itttt eq           \n"
      "cmpeq r8, #8       \n"
      "cmpeq r9, #9       \n"
      "cmpeq r10, #10     \n"
      "cmpeq r11, #11     \n"
      "ite  eq            \n"
      "moveq r0, #1       \n"
      "movne r0, #0       \n"
      "pop  {r4-r11, pc}  \n");
}

std::uint32_t rights() {
  std::uint32_t control = 0;
  asm volatile("mrs %0, control" : "=r"(control));
  return control;
}

void calls(void*) {
  for (unsigned i = 0; i < kCalls; ++i)
    if (call_keeps_registers(&sandbox) && rights() == 2) good = good + 1;
  done = true;
}

// The heart interrupts the call at every instruction.
void nothing_is_spoiled() {
  good = 0;
  done = false;
  window.fill(std::byte{0});
  sandbox.set(window, window.data() + window.size(), adds_and_spoils);
  rig::start(0, 0, calls, rig::Category::safety);
  for (unsigned i = 0; i < 100 && !done; ++i)
    rig::sleep_ms(10);
  CHECK(done);
  CHECK(good == kCalls);
  CHECK(rig::faults() == 0);
  CHECK(window[window.size() - 1] == std::byte{0xFF});  // its stack is there
}

std::int32_t rights_inside(void*, const void*, void*) {
  return static_cast<std::int32_t>(rights());
}

void it_has_no_privileges() {
  static std::int32_t inside;
  inside = 0;
  sandbox.set(window, window.data() + window.size(), rights_inside);
  rig::start(
      0, 0, [](void*) { inside = sandbox.call(nullptr, nullptr, nullptr); }, rig::Category::safety);
  rig::sleep_ms(2);
  CHECK(inside == 3);  // nPRIV, PSP
  CHECK(rig::faults() == 0);
}

constexpr rig::Scenario kScenarios[] = {
    {"sandbox: it spoils neither registers nor stack, nor rights, of its caller",
     nothing_is_spoiled},
    {"sandbox: it has no privileges", it_has_no_privileges},
};

}  // namespace

std::span<const rig::Scenario> rig::sandbox_scenarios() {
  return kScenarios;
}
