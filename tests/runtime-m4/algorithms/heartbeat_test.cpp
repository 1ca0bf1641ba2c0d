// The module that docs/algorithms.md shows, compiled from that page.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/algorithms/modules.hpp"

extern "C" const robosync_description* heartbeat_describe(uint32_t abi);

using robosync::test::Module;

namespace {

// Feeds `beats` beats at a distance, each 200 ms long, at 50 Hz.
void beat(Module& module, int beats, int distance_ms) {
  for (int ms = 0; ms < beats * distance_ms; ms += 20)
    (void)module.put({ms % distance_ms < 200 ? 3000 : 1000});
}

}  // namespace

TEST_CASE("the module of docs/algorithms.md counts the beats of a heart") {
  Module heart(*heartbeat_describe(ROBOSYNC_ABI));
  CHECK(heart.put({1000}) == "RATE 0");
  for (const int distance : {400, 800, 1000, 1500}) {
    INFO(distance);
    beat(heart, 8, distance);
    CHECK(heart.output(0) == 60'000 / distance * 1000);
  }
  for (int ms = 0; ms < 3000; ms += 20)
    (void)heart.put({1000});
  CHECK(heart.output(0) == 0);  // no heart
  CHECK(heartbeat_describe(ROBOSYNC_ABI + 1) == nullptr);
}
