// Runs the runtime's CHECKs over given readings between markers: W3 as a user of RSL writes it. One
// reading a sample; after each it says which band the first CHECK is in.
#include <array>

#include "bench/firmware/given.hpp"
#include "bench/firmware/mark.hpp"
#include "runtime-m4/layers/checks.hpp"
#include "vm/verifier.hpp"

namespace robosync::bench {
namespace {

layers::Checks checks;
std::array<vm::Value, layers::kMaxInputs> values;

void measure(const vm::Image& image) {
  const vm::Check& check = image.checks[0];
  vm::Value& band = values[image.channels.size() + check.variable];
  values.fill(vm::kUnknown);
  checks.start(image);
  std::uint32_t now = 0;
  for (const vm::Value reading : given_readings()) {
    now += check.sample_ms;
    BENCH_MARK(check_begin);
    values[check.input] = reading;
    const bool changed = checks.update(0, now, values);
    BENCH_MARK(check_end);
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
