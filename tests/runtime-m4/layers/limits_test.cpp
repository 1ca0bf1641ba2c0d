// An order's parameters after an actuator's range and limit were applied.
#include "runtime-m4/layers/limits.hpp"

#include <catch2/catch.hpp>

using namespace robosync;
using vm::Param;

namespace {

drivers::Order limited(Param param, vm::Value value) {
  vm::Actuator actuator{};
  actuator.min = -10;
  actuator.max = 20;
  actuator.speed_limit = 5;
  drivers::Order order;
  order.give(param, value);
  layers::limit(actuator, order);
  return order;
}

}  // namespace

TEST_CASE("TO stays in the actuator's range, and AT at most at its limit") {
  CHECK(limited(Param::to, -11)[Param::to] == -10);
  CHECK(limited(Param::to, 7)[Param::to] == 7);
  CHECK(limited(Param::to, 21)[Param::to] == 20);
  CHECK(limited(Param::at, -1)[Param::at] == 0);
  CHECK(limited(Param::at, 5)[Param::at] == 5);
  CHECK(limited(Param::at, 6)[Param::at] == 5);
}

TEST_CASE("what is unknown is not limited, nor is any other parameter") {
  CHECK(limited(Param::to, vm::kUnknown)[Param::to] == vm::kUnknown);
  CHECK(limited(Param::at, vm::kUnknown)[Param::at] == vm::kUnknown);
  CHECK(limited(Param::over, 1'000)[Param::over] == 1'000);
}

TEST_CASE("an order has limits if it says where, or how fast") {
  drivers::Order order;
  CHECK_FALSE(layers::has_limits(order));
  order.give(Param::over, 1);
  CHECK_FALSE(layers::has_limits(order));
  const Param limits = GENERATE(Param::to, Param::at);
  order.give(limits, 1);
  CHECK(layers::has_limits(order));
}
