// Virtual wheels against a count in small steps.
#include "runtime-m4/policy/virtual_wheels.hpp"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using robosync::policy::VirtualWheels;

namespace {

constexpr std::uint32_t kSecond = 1'000'000;

}  // namespace

TEST_CASE("virtual wheels: edges and the time since the last one, forward and back") {
  VirtualWheels wheels;
  wheels.begin(1, 80 * VirtualWheels::kRateParts, 5 * kSecond);
  CHECK(wheels.is_on(1));
  CHECK_FALSE(wheels.is_on(0));
  CHECK(wheels.edges(1, 9 * kSecond) == 0);
  CHECK(wheels.ago(1, 9 * kSecond) == 4 * kSecond);
  wheels.turn(1, 10'000, 9 * kSecond);  // half the power: 25 ms for an edge
  CHECK(wheels.edges(1, 9 * kSecond + 24'999) == 0);
  CHECK(wheels.edges(1, 9 * kSecond + 25'000) == 1);
  CHECK(wheels.edges(1, 10 * kSecond) == 40);
  CHECK(wheels.ago(1, 10 * kSecond + 7'000) == 7'000);
  wheels.turn(1, 0, 10 * kSecond + 7'000);
  CHECK(wheels.edges(1, 20 * kSecond) == 40);
  CHECK(wheels.ago(1, 20 * kSecond) == 9'993'000);
  wheels.turn(1, -10'000, 20 * kSecond);
  CHECK(wheels.edges(1, 20 * kSecond + 7'000) == 40);
  CHECK(wheels.edges(1, 20 * kSecond + 7'001) == 39);
  CHECK(wheels.edges(1, 22 * kSecond) == -40);
  CHECK(wheels.ago(1, 20 * kSecond + 10'000) == 3'000);
  wheels.end_all();
  CHECK_FALSE(wheels.is_on(1));
  CHECK(wheels.edges(1, 30 * kSecond) == 0);
}

TEST_CASE("virtual wheels: whenever they are looked at, they count the same, also very many") {
  const bool holds = rc::check("virtual wheels", [] {
    const auto full = *rc::gen::inRange<std::int32_t>(1, 4'000 * VirtualWheels::kRateParts);
    VirtualWheels wheels;
    long double turned = 0;                    // edges
    std::uint32_t now = UINT32_MAX - kSecond;  // the time wraps
    wheels.begin(0, full, now);
    for (unsigned i = 0; i < 40; ++i) {
      const auto pulse = *rc::gen::inRange<std::int32_t>(-20'000, 20'001);
      const auto length = *rc::gen::inRange<std::uint32_t>(1, 20 * kSecond);
      wheels.turn(0, pulse, now);
      turned += static_cast<long double>(full) / VirtualWheels::kRateParts * pulse / 20'000 *
                static_cast<long double>(length) / 1e6L;
      now += length;
      const auto counted = static_cast<long double>(wheels.edges(0, now));
      RC_ASSERT(counted <= turned + 1e-6L);
      RC_ASSERT(counted > turned - 1 - 1e-6L);
    }
  });
  CHECK(holds);
}

TEST_CASE(
    "virtual wheels: a time before the last turn turns nothing, and one that stands stands for "
    "hours") {
  VirtualWheels wheels;
  wheels.begin(0, 100 * VirtualWheels::kRateParts, 0);
  wheels.turn(0, 20'000, 5 * kSecond);
  CHECK(wheels.edges(0, 5 * kSecond - 1000) == 0);
  CHECK(wheels.edges(0, 6 * kSecond) == 100);
  wheels.turn(0, 0, 6 * kSecond);
  const std::uint32_t late = 3'000 * kSecond;
  CHECK(wheels.edges(0, late) == 100);
  wheels.turn(0, 20'000, late);
  CHECK(wheels.edges(0, late + kSecond) == 200);
}
