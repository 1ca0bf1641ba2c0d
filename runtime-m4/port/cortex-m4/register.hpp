// A register of the core or of a peripheral, by its address. On the host, tests simulate the registers
// (tests/runtime-m4/boards), so drivers of hardware that no emulator has are tested as shipped.
#pragma once

#include <cstdint>

#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::port {

#if !defined(__arm__)
// Defined by the test.
std::uint32_t read_register(std::uintptr_t address);
void write_register(std::uintptr_t address, std::uint32_t value);
std::uint32_t bus_address(const volatile void* memory);
#else
// The address of memory as a DMA peripheral sees it.
inline std::uint32_t bus_address(const volatile void* memory) {
  return reinterpret_cast<std::uintptr_t>(memory);
}
#endif

struct Register {
  std::uintptr_t address;

#if defined(__arm__)
  std::uint32_t read() const {
    return *reinterpret_cast<const volatile std::uint32_t*>(address);
  }
  void write(std::uint32_t value) const {
    *reinterpret_cast<volatile std::uint32_t*>(address) = value;
  }
#else
  std::uint32_t read() const {
    return read_register(address);
  }
  void write(std::uint32_t value) const {
    write_register(address, value);
  }
#endif

  bool has(std::uint32_t bits) const {
    return (read() & bits) != 0;
  }
  void set(std::uint32_t bits) const {
    write(read() | bits);
  }
  void clear(std::uint32_t bits) const {
    write(read() & ~bits);
  }
  // For a register that is a row of fields of `bits` bits each: sets field `index` to `value`.
  void set_field(unsigned index, unsigned bits, std::uint32_t value) const {
    const std::uint32_t mask = (1U << bits) - 1;
    write((read() & ~(mask << (index * bits))) | (value & mask) << (index * bits));
  }
};

// Masks all interrupts, even those above the kernel's level.
class Alone {
public:
#if defined(__arm__)
  Alone() {
    asm volatile("mrs %0, primask\n\tcpsid i" : "=r"(outer_)::"memory");
  }
  ~Alone() {
    asm volatile("msr primask, %0" ::"r"(outer_) : "memory");
  }
#else
  Alone() = default;
  ~Alone() {}
#endif
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

private:
  [[maybe_unused]] std::uint32_t outer_ = 0;
};

// Masks all interrupts and turns the MPU off, so that flash can be written and code can run in RAM.
class Unprotected {
public:
#if defined(__arm__)
  Unprotected() : outer_(Register{core::kMpuCtrl}.read()) {
    set(0);
  }
  ~Unprotected() {
    set(outer_);
  }
#else
  Unprotected() = default;
  ~Unprotected() {}
#endif
  Unprotected(const Unprotected&) = delete;
  Unprotected& operator=(const Unprotected&) = delete;

private:
#if defined(__arm__)
  static void set(std::uint32_t control) {
    Register{core::kMpuCtrl}.write(control);
    asm volatile("dsb\n\tisb" ::: "memory");
  }
#endif

  Alone alone_;
  [[maybe_unused]] std::uint32_t outer_ = 0;
};

}  // namespace robosync::port
