// Counts the VM's evaluations for the runtime, and changes what its responses say. The linker's --wrap (CMakeLists.txt) inserts
// this between them.
#include "tests/runtime-m4/peer.hpp"

#include <utility>

#include "vm/interpreter.hpp"

namespace robosync::test {

namespace {
std::uint32_t evaluated = 0;
std::function<void(vm::Progress&)> lies;
}  // namespace

std::uint32_t evaluations() {
  return evaluated;
}

void let_responses_lie(std::function<void(vm::Progress&)> lie) {
  lies = std::move(lie);
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
  const Value result = real_run(machine, code, progress);
  if (progress != nullptr && test::lies) test::lies(*progress);
  return result;
}

}  // namespace robosync::vm
