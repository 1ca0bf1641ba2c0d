// A register of the core or of a peripheral, by its address. On the chip that is what it is; on the host a test says what
// the register does (tests/runtime-m4/boards), so that what drives hardware that no emulator has is tested as it is shipped.
#pragma once

#include <cstdint>

#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::port {

#if !defined(__arm__)
// The test's.
std::uint32_t read_register(std::uintptr_t address);
void write_register(std::uintptr_t address, std::uint32_t value);
std::uint32_t bus_address(const volatile void* memory);
#else
// Where a peripheral that reads memory by itself finds it.
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
  // Of a register that is a row of fields, each of `bits` bits: the one with that index becomes `value`.
  void set_field(unsigned index, unsigned bits, std::uint32_t value) const {
    const std::uint32_t mask = (1U << bits) - 1;
    write((read() & ~(mask << (index * bits))) | (value & mask) << (index * bits));
  }
};

// Nothing comes between: not even who is more urgent than the kernel.
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

// … and the MPU is off: flash may be written, and what stands in RAM may run.
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
