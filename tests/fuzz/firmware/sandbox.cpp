#include "tests/fuzz/firmware/sandbox.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "bench/firmware/mark.hpp"

namespace robosync::fuzz {
namespace {

volatile std::uint32_t& reg(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}
constexpr std::uintptr_t kShcsr = 0xE000ED24;
constexpr std::uintptr_t kCfsr = 0xE000ED28;
constexpr std::uintptr_t kMmfar = 0xE000ED34;
constexpr std::uintptr_t kBfar = 0xE000ED38;
constexpr std::uintptr_t kMpuCtrl = 0xE000ED94;
constexpr std::uintptr_t kMpuRnr = 0xE000ED98;
constexpr std::uintptr_t kMpuRbar = 0xE000ED9C;
constexpr std::uintptr_t kMpuRasr = 0xE000EDA0;

// Attributes of a region; those that the board reads only may still be written with privileges.
constexpr std::uint32_t kEnable = 1;
constexpr std::uint32_t kNoExecution = 1U << 28;
constexpr std::uint32_t kReadWrite = 3U << 24;
constexpr std::uint32_t kReadOnly = 2U << 24;
constexpr std::uint32_t kMpuOn = 1 | 4;  // with privileges, memory is as without an MPU

constexpr std::size_t kEighths = 8;
constexpr std::size_t kSmallest = 256;  // region that has eighths
constexpr std::uint32_t kFirstZone = 2;
constexpr std::size_t kFirmwareBytes = std::size_t{128} << 10;
constexpr std::uintptr_t kStack = 0x20000000;
constexpr std::size_t kStackBytes = std::size_t{16} << 10;

// Where each zone ends: far from each other.
constexpr std::uintptr_t kEnds[] = {0x20010000, 0x20020000, 0x20030000, 0x20040000};

constexpr std::uint32_t size_bits(std::size_t size) {
  return static_cast<std::uint32_t>(std::countr_zero(size) - 1) << 1;
}

void set_region(std::uint32_t number, std::uintptr_t base, std::uint32_t attributes) {
  reg(kMpuRnr) = number;
  reg(kMpuRasr) = 0;
  reg(kMpuRbar) = base;
  reg(kMpuRasr) = attributes;
  asm volatile("dsb\n\tisb" ::: "memory");
}

volatile bool expects_fault = false;
volatile bool faulted = false;

}  // namespace

std::byte* open_zone(Zone zone, std::size_t size) {
  const auto number = static_cast<std::uint32_t>(zone);
  const std::uintptr_t end = kEnds[number];
  const std::size_t region = std::max(std::bit_ceil(size), kSmallest);
  const std::size_t eighth = region / kEighths;
  const std::size_t used = (size + eighth - 1) / eighth;
  const std::uint32_t off = (1U << (kEighths - used)) - 1;
  const std::uint32_t access = zone == Zone::image ? kReadOnly : kReadWrite;
  set_region(kFirstZone + number, end - region,
             size == 0 ? 0 : kNoExecution | access | off << 8 | size_bits(region) | kEnable);
  return reinterpret_cast<std::byte*>(end - size);
}

void start_sandbox() {
  reg(kShcsr) |= 7U << 16;
  set_region(0, 0, kReadOnly | size_bits(kFirmwareBytes) | kEnable);
  set_region(1, kStack, kNoExecution | kReadWrite | size_bits(kStackBytes) | kEnable);
  reg(kMpuCtrl) = kMpuOn;
  asm volatile("dsb\n\tisb" ::: "memory");
}

namespace {

// On a stack of its own, without privileges; `svc` gives them back.
[[gnu::naked]] void drop(void (*)(void*), void*, std::uintptr_t) {
  asm volatile(
      "push {r4, lr}\n\t"
      "msr psp, r2\n\t"
      "mov r4, r0\n\t"
      "mov r0, r1\n\t"
      "movs r3, #3\n\t"
      "msr control, r3\n\t"
      "isb\n\t"
      "blx r4\n\t"
      "svc 0\n\t"
      "movs r3, #0\n\t"
      "msr control, r3\n\t"
      "isb\n\t"
      "pop {r4, pc}");
}

[[gnu::naked]] void poke(void*) {
  asm volatile(
      "str r0, [r0]\n"
      ".global fuzz_after_poke\n"
      "fuzz_after_poke: bx lr");
}
[[gnu::naked]] void peek(void*) {
  asm volatile(
      "ldr r0, [r0]\n\t"
      "b fuzz_after_poke");
}

bool traps(void (*access)(void*), std::uintptr_t address) {
  faulted = false;
  expects_fault = true;
  run_unprivileged(access, reinterpret_cast<void*>(address));
  expects_fault = false;
  return faulted;
}

}  // namespace

void run_unprivileged(void (*function)(void*), void* job) {
  drop(function, job, kJobs);
}

bool traps_write(std::uintptr_t address) {
  return traps(poke, address);
}
bool traps_read(std::uintptr_t address) {
  return traps(peek, address);
}
void stray_write(std::uintptr_t address) {
  run_unprivileged(poke, reinterpret_cast<void*>(address));
}

void print(const char* text) {
  constexpr unsigned kSysWrite0 = 0x04;
  register unsigned operation asm("r0") = kSysWrite0;
  register const char* what asm("r1") = text;
  asm volatile("bkpt 0xAB" : "+r"(operation) : "r"(what) : "memory");
}

void print(std::uint32_t number) {
  std::array<char, 11> text{};
  std::size_t at = text.size() - 1;
  do {
    text[--at] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number > 0);
  print(&text[at]);
}

}  // namespace robosync::fuzz

extern "C" {

extern const char fuzz_after_poke[];

// `frame`: r0–r3, r12, lr, pc, xpsr as the core has put them on the stack.
[[gnu::used]] void fuzz_fault(std::uint32_t* frame) {
  using namespace robosync::fuzz;
  constexpr std::size_t kPc = 6;
  const std::uint32_t cause = reg(kCfsr);
  const std::uint32_t address = (cause & 0x80) != 0 ? reg(kMmfar) : reg(kBfar);
  if (expects_fault) {
    expects_fault = false;
    faulted = true;
    reg(kCfsr) = cause;
    frame[kPc] = reinterpret_cast<std::uintptr_t>(fuzz_after_poke) & ~std::uintptr_t{1};
    return;
  }
  print("fault at pc ");
  print(frame[kPc]);
  print(", address ");
  print(address);
  print(", cause ");
  print(cause);
  print("\n");
  robosync::bench::leave(false);
}

// The stack that was in use is the one the frame is on.
#define FUZZ_FAULT_HANDLER(name) \
  [[gnu::naked]] void name() {   \
    asm volatile(                \
        "tst lr, #4\n\t"         \
        "ite eq\n\t"             \
        "mrseq r0, msp\n\t"      \
        "mrsne r0, psp\n\t"      \
        "b fuzz_fault");         \
  }
FUZZ_FAULT_HANDLER(HardFault_Handler)
FUZZ_FAULT_HANDLER(MemManage_Handler)
FUZZ_FAULT_HANDLER(BusFault_Handler)
FUZZ_FAULT_HANDLER(UsageFault_Handler)
#undef FUZZ_FAULT_HANDLER

[[gnu::naked]] void SVC_Handler() {
  asm volatile(
      "mrs r0, control\n\t"
      "bic r0, r0, #1\n\t"
      "msr control, r0\n\t"
      "isb\n\t"
      "bx lr");
}

}  // extern "C"
