// Simulated registers: the reads and writes of the code under test go to the present model.
#pragma once

#include <cstdint>

namespace robosync::tests {

class RegisterModel {
public:
  RegisterModel();
  virtual ~RegisterModel();
  RegisterModel(const RegisterModel&) = delete;
  RegisterModel& operator=(const RegisterModel&) = delete;

  virtual std::uint32_t read(std::uintptr_t address) = 0;
  virtual void write(std::uintptr_t address, std::uint32_t value) = 0;
};

// Throws: a model reports a use that it does not support, or that is wrong.
[[noreturn]] void no_register(std::uintptr_t address);
void demand(bool holds, const char* what);

// The memory that the code under test has given a peripheral for DMA: the peripheral has the address as a 32-bit number.
const volatile void* memory_at(std::uint32_t bus_address);

}  // namespace robosync::tests
