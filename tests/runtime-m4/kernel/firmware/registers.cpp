// A thread's registers do not change while it does not run.
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

struct FpuImage {
  std::array<std::uint32_t, 32> s;
};

struct CoreImage {
  std::array<std::uint32_t, 13> r;  // r0 … r12
};

// Loads all FPU registers, loops for a while, then stores them.
void hold_fpu(const FpuImage& in, FpuImage& out, std::uint32_t turns) {
  asm volatile(
      "vldmia %1, {s0-s31}   \n"
      "1: subs %0, #1        \n"
      "bne 1b                \n"
      "vstmia %2, {s0-s31}   \n"
      : "+r"(turns)
      : "r"(&in), "r"(&out)
      : "cc", "memory", "s0", "s1", "s2", "s3", "s4", "s5", "s6", "s7", "s8", "s9", "s10", "s11",
        "s12", "s13", "s14", "s15", "s16", "s17", "s18", "s19", "s20", "s21", "s22", "s23", "s24",
        "s25", "s26", "s27", "s28", "s29", "s30", "s31");
}

// The same for r0 … r12 and lr; the loop counter is on the stack.
[[gnu::naked, gnu::noinline]] void hold_core(const CoreImage*, CoreImage*, std::uint32_t) {
  asm volatile(
      "push  {r1, r2, r4-r11, lr}  \n"
      "ldmia r0, {r0-r12}          \n"
      "1: push {r0}                \n"
      "ldr   r0, [sp, #8]          \n"
      "subs  r0, #1                \n"
      "str   r0, [sp, #8]          \n"
      "pop   {r0}                  \n"
      "bne   1b                    \n"
      "mov   lr, r12               \n"
      "ldr   r12, [sp]             \n"
      "stmia r12!, {r0-r11}        \n"
      "str   lr, [r12]             \n"
      "pop   {r1, r2, r4-r11, pc}  \n");
}

constexpr std::uint32_t kTurns = 20'000;
volatile unsigned wrong = 0;
volatile unsigned rounds = 0;

void use_all_registers(std::uint32_t pattern) {
  FpuImage in;
  FpuImage out{};
  for (unsigned i = 0; i < in.s.size(); ++i)
    in.s[i] = pattern + i;
  hold_fpu(in, out, kTurns / 10);
  if (in.s != out.s) wrong = wrong + 1;
  CoreImage core_in;
  CoreImage core_out{};
  for (unsigned i = 0; i < core_in.r.size(); ++i)
    core_in.r[i] = pattern + i;
  hold_core(&core_in, &core_out, kTurns / 100);
  if (core_in.r != core_out.r) wrong = wrong + 1;
  rounds = rounds + 1;
}

// Preempts the others every millisecond, with its own register values.
void disturber(void*) {
  for (unsigned i = 0;; ++i) {
    rig::sleep_ms(1);
    use_all_registers(0xD000'0000 + i * 64);
  }
}

void registers_survive() {
  wrong = 0;
  rounds = 0;
  rig::start(0, 60, disturber);
  rig::start(1, 40, [](void*) {
    for (unsigned i = 0;; ++i)
      use_all_registers(0x1000'0000 + i * 64);
  });
  // Has the same level as the one above, so that each is preempted by the other's wake-ups.
  rig::start(2, 45, [](void*) {
    for (unsigned i = 0;; ++i) {
      use_all_registers(0x5000'0000 + i * 64);
      rig::sleep_ms(2);
    }
  });
  rig::sleep_ms(300);
  CHECK(wrong == 0);
  CHECK(rounds > 500);
}

constexpr rig::Scenario kScenarios[] = {
    {"core and FPU registers survive preemption", registers_survive},
};

}  // namespace

std::span<const rig::Scenario> rig::register_scenarios() {
  return kScenarios;
}
