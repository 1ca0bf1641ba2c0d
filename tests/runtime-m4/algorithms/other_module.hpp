// While one exists, it replaces the firmware's first module, on the board's side only: the compiler and the names stay as they
// are. This gives tests modules that violate their contract. It is done by the linker (--wrap).
#pragma once

#include "runtime-m4/algorithms/modules.hpp"

namespace robosync::test {

class OtherModule {
public:
  explicit OtherModule(const robosync_module& module);
  ~OtherModule();
  OtherModule(const OtherModule&) = delete;
  OtherModule& operator=(const OtherModule&) = delete;
};

}  // namespace robosync::test
