// While it is there, the first module of the firmware is another one, for the board's side only: the compiler and the names
// stay as they are. A test can so have modules that break their word. The linker does it (--wrap).
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
