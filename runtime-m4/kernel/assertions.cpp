#include "runtime-m4/kernel/assertions.hpp"

namespace robosync::kernel {

AssertionFailed assertion_failed = port::panic;

}  // namespace robosync::kernel
