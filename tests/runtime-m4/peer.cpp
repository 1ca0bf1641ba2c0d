// Counts the VM's evaluations for the runtime. The linker's --wrap (CMakeLists.txt) inserts this
// between them.
#include "tests/runtime-m4/peer.hpp"

#include "vm/interpreter.hpp"

namespace robosync::test {

namespace {
std::uint32_t evaluated = 0;
}  // namespace

std::uint32_t evaluations() {
  return evaluated;
}

}  // namespace robosync::test

namespace robosync::vm {

Value real_run(Machine& machine, const Word* code, Progress* progress) asm(
    "__real__ZN8robosync2vm3runERNS0_7MachineEPKjPNS0_8ProgressE");
Value counted_run(Machine& machine, const Word* code, Progress* progress) asm(
    "__wrap__ZN8robosync2vm3runERNS0_7MachineEPKjPNS0_8ProgressE");

// A condition has no Progress.
Value counted_run(Machine& machine, const Word* code, Progress* progress) {
  if (progress == nullptr) ++test::evaluated;
  return real_run(machine, code, progress);
}

}  // namespace robosync::vm
