// See isolation.hpp. switch.S sets the regions of the running thread.
#include "runtime-m4/port/cortex-m4/isolation.hpp"

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/sandbox.hpp"

namespace robosync::port {

namespace {

constexpr unsigned kMemoryBits = 30;
#if defined(ROBOSYNC_CODE_BITS)
constexpr unsigned kCodeBits = ROBOSYNC_CODE_BITS;
#else
constexpr unsigned kCodeBits = 28;
#endif
constexpr unsigned kGuardBits = 5;
static_assert(1U << kGuardBits == kGuard);

std::uint32_t word_of(const void* address) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address));
}

std::uint32_t size_of(policy::regions::Region region, std::uint32_t access) {
  return region.size_and_eighths == 0 ? 0 : access | region.size_and_eighths;
}

// Call under a Lock, because the switch sets regions too.
void set(RegionNumber number, policy::regions::Region region, std::uint32_t access) {
  core::reg(core::kMpuRbar) = base_of(number, region.base);
  core::reg(core::kMpuRasr) = size_of(region, access);
}

}  // namespace

void start_isolation() {
  set(RegionNumber::memory, {0, policy::regions::size_field(kMemoryBits)}, core::kMpuPrivileged);
  set(RegionNumber::code, {0, policy::regions::size_field(kCodeBits)}, core::kMpuCode);
  set(RegionNumber::guard,
      {word_of(robosync_kernel.idle().stack().data()) - kGuard,
       policy::regions::size_field(kGuardBits)},
      core::kMpuClosed);
  core::reg(core::kMpuCtrl) = core::kMpuOn;
  asm volatile("dsb\n\tisb" ::: "memory");
}

void Machine::grant(const Areas& areas) {
  const std::uint32_t begin = word_of(areas.readable.data());
  set(RegionNumber::readable,
      policy::regions::cover(begin, begin + static_cast<std::uint32_t>(areas.readable.size())),
      core::kMpuOthersRead);
  const policy::regions::Window window = policy::regions::finest_window(
      word_of(areas.writable.data()), static_cast<std::uint32_t>(areas.writable.size()));
  set(RegionNumber::writable, window.lower, core::kMpuAllWrite);
  set(RegionNumber::writable_upper, window.upper, core::kMpuAllWrite);
  asm volatile("dsb\n\tisb" ::: "memory");
}

void Sandbox::set(std::span<std::byte> window, std::byte* stack_top, Function function) {
  const policy::regions::Window regions = policy::regions::finest_window(
      word_of(window.data()), static_cast<std::uint32_t>(window.size()));
  lower_base_ = base_of(RegionNumber::stack, regions.lower.base);
  lower_size_ = size_of(regions.lower, core::kMpuAllWrite);
  upper_base_ = base_of(RegionNumber::stack_upper, regions.upper.base);
  upper_size_ = size_of(regions.upper, core::kMpuAllWrite);
  stack_top_ = stack_top;
  function_ = function;
}

}  // namespace robosync::port
