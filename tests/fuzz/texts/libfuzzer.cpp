// What libFuzzer, whose main() runs, calls with each input that it has thought of. FUZZED is one of targets.def.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/texts/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  robosync::fuzz::FUZZED({reinterpret_cast<const char*>(data), size});
  return 0;
}
