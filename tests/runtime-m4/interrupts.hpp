// Interrupts at a chosen instruction. The host's kernel takes none while a thread runs, so the linker's --wrap (CMakeLists.txt)
// inserts a call before two of the kernel's services.
#pragma once

#include <cstdint>
#include <functional>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::test {

// While it exists, it is called before these services. It replaces none of them.
struct Interrupts {
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  std::function<void(kernel::Thread& thread)> before_signal;
  std::function<void(std::uint32_t number)> before_call;  // a system call (kernel/calls.def)

private:
  kernel::AssertionFailed assertion_failed_;
};

}  // namespace robosync::test
