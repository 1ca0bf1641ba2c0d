// Runs the runtime's CHECKs over given readings between markers: W3 as an RSL author would write it. Each sample has one reading;
// after each, prints the band of the first CHECK.
#include <array>

#include "bench/firmware/driven.hpp"
#include "bench/firmware/given.hpp"
#include "bench/firmware/mark.hpp"
#include "runtime-m4/layers/checks.hpp"
#include "vm/verifier.hpp"

namespace robosync::bench {
namespace {

constexpr policy::BoardMemory kBoard{
    .arena_begin = 0x2180'0000, .arena_bytes = 64 * 1024, .step_budget = 1'000'000};

layers::Memory memory(arena_at(kBoard), kBoard);
layers::Checks checks;
std::array<vm::Value, policy::kMaxChannels + policy::kMaxVariables> values;

void measure(const vm::Image& image) {
  const vm::Check& check = image.checks[0];
  vm::Value& band = values[image.channels.size() + check.variable];
  values.fill(vm::kUnknown);
  memory.lay_out(policy::needs_of(image, kBoard));
  checks.start(image, memory);
  std::uint32_t now = 0;
  for (const vm::Value reading : given_readings()) {
    now += check.sample_ms;
    values[check.input] = reading;
    bool changed = false;
    // A reading equal to the one before becomes a sample when its millisecond is over.
    for (const std::uint32_t at : {now, now + 1}) {
      BENCH_MARK(check_begin);
      changed |= checks.update(0, at, values.data());
      BENCH_MARK(check_end);
    }
    say(changed ? "changed" : "same", std::array{band});
  }
}

}  // namespace
}  // namespace robosync::bench

int main() {
  using namespace robosync;
  vm::Image image;
  if (!vm::verify(bench::given_image(), vm::Limits{}, image).ok()) bench::leave(false);
  if (image.checks.empty()) bench::leave(false);
  bench::measure(image);
  bench::leave(true);
}
