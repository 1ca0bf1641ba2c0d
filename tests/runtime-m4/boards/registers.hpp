// Registers that a model behaves like: what the code under test reads and writes goes to the model that is there.
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

// What a model says of a use that it does not know, or that is wrong: an exception.
[[noreturn]] void no_register(std::uintptr_t address);
void demand(bool holds, const char* what);

// What the code under test has told a peripheral to read by itself: the peripheral has the address as a number of 32 bits.
const volatile void* memory_at(std::uint32_t bus_address);

}  // namespace robosync::tests
