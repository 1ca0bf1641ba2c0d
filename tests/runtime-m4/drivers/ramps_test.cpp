// Movements with a limit of acceleration: what they must never do, for any distances, speeds and accelerations, and what happens
// to one that is replaced or stopped.
#include <cmath>
#include <cstdlib>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "runtime-m4/drivers/trapezoid.hpp"
#include "runtime-m4/drivers/way.hpp"
#include "tests/runtime-m4/drivers/drive.hpp"

using namespace robosync;
using namespace robosync::drivers;
using test::order;
using trapezoid::Profile;
using vm::Action;
using vm::Param;
using vm::Value;

namespace {

// An actuator with a limit of acceleration.
struct Mover : test::Drive {
  explicit Mover(vm::DriverId id, std::uint16_t acceleration, Value min = 0, Value max = 180'000,
                 Value speed_limit = vm::kValueMax)
      : Drive(id, min, max, speed_limit) {
    if (id == vm::DriverId::virtual_motion) {
      wiring.pin = 90;  // its usual speed
      wiring.bus = static_cast<std::uint8_t>(vm::VirtualMotion::sweeps);
    }
    state.acceleration = acceleration;
  }
  void move(test::Params params) { begin(order(Action::move, params)); }
  void run(kernel::Time until = kernel::kForever) {
    Drive::run(until);
    if (until != kernel::kForever) now = until;
  }
  Value position() { return way::position(device(), now); }
  // How long it takes, in milliseconds.
  std::uint64_t takes(const Order& what) {
    const kernel::Time before = now;
    begin(what);
    run();
    return (now - before) / 1000;
  }
};

constexpr kernel::Time kStart = 1'000'000;

std::uint32_t drawn_below(std::uint32_t most) {
  const auto bits = *rc::gen::inRange(0U, static_cast<unsigned>(std::bit_width(most)) + 1U);
  return *rc::gen::inRange<std::uint32_t>(0, std::min(most, (1U << std::min(bits, 31U))) + 1);
}

struct Drawn {
  std::uint32_t way = 1 + drawn_below(2'000'000'000);
  Value speed = 1 + static_cast<Value>(drawn_below(2'000'000'000));
  std::uint32_t acceleration = 1 + drawn_below(65'534);
};

// Both limits, over any time: a position is rounded by less than a thousandth.
void check_limits(const Drawn& drawn, const Profile& profile) {
  const auto at = [&](std::uint64_t time) {
    return std::int64_t{trapezoid::covered(drawn.way, profile, time)};
  };
  RC_ASSERT(2 * profile.ramp <= profile.length);
  RC_ASSERT(at(0) == 0);
  RC_ASSERT(at(profile.length) == std::int64_t{drawn.way});
  for (int i = 0; i < 40; ++i) {
    const auto time = *rc::gen::inRange<std::uint64_t>(0, profile.length);
    const bool is_close = i % 2 == 0;
    const std::uint64_t room = std::min(time, profile.length - time);
    const auto apart = *rc::gen::inRange<std::uint64_t>(
        0, std::min<std::uint64_t>(room, is_close ? 30 : room) + 1);
    const std::int64_t before = at(time - apart);
    const std::int64_t here = at(time);
    const std::int64_t after = at(time + apart);
    RC_ASSERT(before <= here);
    RC_ASSERT(here <= after);
    RC_ASSERT(after <= std::int64_t{drawn.way});
    const auto most =
        static_cast<long double>(drawn.speed) * static_cast<long double>(apart) / 1000;
    RC_ASSERT(static_cast<long double>(after - here) <= most + 2);
    const long double square = static_cast<long double>(apart) * static_cast<long double>(apart);
    const auto change = static_cast<long double>(std::abs(after - 2 * here + before));
    RC_ASSERT(change <= drawn.acceleration * square / 1000 + 4);
    RC_ASSERT(trapezoid::speed_at(drawn.way, profile, time) <=
              static_cast<std::uint64_t>(drawn.speed));
  }
}

// In milliseconds, without rounding.
long double ideal(const Drawn& drawn) {
  const long double fastest = std::min<long double>(
      drawn.speed, static_cast<long double>(drawn.acceleration) * trapezoid::kLongestRamp);
  const long double ramp = fastest / drawn.acceleration;
  const long double rest = static_cast<long double>(drawn.way) * 1000 / fastest;
  if (rest >= ramp) return ramp + rest;
  return 2 * std::sqrt(static_cast<long double>(drawn.way) * 1000 / drawn.acceleration);
}

}  // namespace

TEST_CASE("root: the largest whole number whose square is not above") {
  for (const std::uint64_t exact :
       {0ULL, 1ULL, 2ULL, 3ULL, 1000ULL, 65'535ULL, 2'147'483'647ULL, 4'294'967'295ULL}) {
    CHECK(trapezoid::root(exact * exact) == exact);
    if (exact > 0) CHECK(trapezoid::root(exact * exact - 1) == exact - 1);
    CHECK(trapezoid::root_rounded_up(exact * exact) == exact);
    if (exact > 1) CHECK(trapezoid::root_rounded_up(exact * exact - 1) == exact);
  }
}

TEST_CASE(
    "any movement keeps both limits, never goes back nor too far, and ends exactly at its target") {
  const bool holds = rc::check("the shortest time", [] {
    const Drawn drawn;
    const Profile profile = trapezoid::shortest(drawn.way, drawn.speed, drawn.acceleration);
    RC_ASSERT(profile.ramp >= 1U);
    RC_ASSERT(profile.ramp <= trapezoid::kLongestRamp);
    const long double least = ideal(drawn);
    RC_PRE(least < 2'000'000'000.0L);
    RC_ASSERT(static_cast<long double>(profile.length) >= least - 0.01L);
    RC_ASSERT(static_cast<long double>(profile.length) <= least + 2.01L);
    check_limits(drawn, profile);
  });
  CHECK(holds);
  const bool stretched = rc::check("a longer time", [] {
    const Drawn drawn;
    RC_PRE(ideal(drawn) < 1'000'000'000.0L);
    const std::uint64_t length =
        trapezoid::shortest(drawn.way, drawn.speed, drawn.acceleration).length +
        drawn_below(1'000'000'000);
    const Profile profile = trapezoid::stretched(drawn.way, length, drawn.acceleration);
    RC_ASSERT(profile.length == length);
    check_limits(drawn, profile);
  });
  CHECK(stretched);
}

// Any order, at any time: the position at each millisecond is that of something that has mass.
TEST_CASE("any orders, one after the other or in the middle of each other, keep both limits") {
  const bool holds = rc::check("orders", [] {
    const auto acceleration = static_cast<std::uint16_t>(1 + drawn_below(20'000));
    const Value limit = 1000 + static_cast<Value>(drawn_below(2'000'000));
    const auto id = *rc::gen::element(vm::DriverId::servo, vm::DriverId::virtual_motion);
    Mover mover(id, acceleration, -90'000, 90'000, limit);
    std::vector<Value> places;
    const auto go_on = [&](int milliseconds) {
      for (int i = 0; i < milliseconds; ++i) {
        places.push_back(mover.position());
        mover.run(mover.now + 1000);
      }
    };
    Value target = 0;
    for (int i = 0; i < 6; ++i) {
      target = *rc::gen::inRange(-90'000, 90'001);
      const Value at = 1000 + *rc::gen::inRange(0, limit);
      const int kind = *rc::gen::inRange(0, 6);
      if (kind == 0) mover.move({{Param::to, target}, {Param::over, *rc::gen::inRange(0, 3000)}});
      if (kind == 1) mover.begin(order(Action::stop));
      if (kind == 2) mover.move({{Param::at, std::min(at, limit)}});
      if (kind == 3) mover.driver.release(mover.device(), vm::Release::hold, mover.now);
      if (kind >= 3)
        mover.begin(order(kind == 5 ? Action::follow : Action::move,
                          {{Param::to, target}, {Param::at, std::min(at, limit)}}));
      mover.now += 7;  // between two whole milliseconds
      go_on(*rc::gen::inRange(1, 400));
    }
    mover.move({{Param::to, target}});
    for (int i = 0; i < 400'000 && mover.wake != kDone; ++i)
      go_on(1);
    RC_ASSERT(mover.wake == kDone);
    RC_ASSERT(mover.position() == target);
    const std::int64_t frame = 20;
    for (std::size_t i = 0; i + 2 * frame < places.size(); ++i) {
      const std::int64_t first = places[i];
      const std::int64_t second = places[i + frame];
      const std::int64_t third = places[i + 2 * frame];
      RC_ASSERT(std::abs(first) <= 90'000);
      RC_ASSERT(std::abs(second - first) <= std::int64_t{limit} * frame / 1000 + 3);
      // Where one movement replaces another the speed changes by no more than in 3 ms, because times are whole milliseconds.
      RC_ASSERT(std::abs(third - 2 * second + first) <=
                std::int64_t{acceleration} * frame * (frame + 2 * 3) / 1000 + 6);
    }
  });
  CHECK(holds);
}

TEST_CASE("a servo with a limit of acceleration: a trapezoid, or a triangle if the way is short") {
  Mover servo(vm::DriverId::servo, 180);
  servo.move({{Param::to, 90'000}});  // at 90deg/s: half a second to speed up, and to slow down
  for (const auto& [ms, place] : std::initializer_list<std::pair<kernel::Time, Value>>{
           {250, 5625}, {500, 22'500}, {750, 45'000}, {1000, 67'500}, {1250, 84'375}}) {
    servo.run(kStart + ms * 1000);
    CHECK(servo.position() == place);
  }
  CHECK(servo.wake != kDone);
  servo.run();
  CHECK(servo.now == kStart + 1'500'000);
  CHECK(servo.pulse() == 1500);
  CHECK(servo.takes(order(Action::move, {{Param::by, 10'000}})) ==
        472);  // twice the root of 10 / 180
  CHECK(servo.takes(order(Action::move, {{Param::to, 10'000}, {Param::over, 3000}})) == 3000);
  CHECK(servo.takes(order(Action::move, {{Param::to, 10'000}, {Param::over, 500}})) == 500);
  servo.wiring.speed_limit = 90'000;
  CHECK(servo.takes(order(Action::move, {{Param::to, 100'000}, {Param::over, 100}})) == 1500);
  CHECK(servo.takes(order(Action::move, {{Param::to, 0}, {Param::at, 0}})) == 0);
  CHECK(servo.takes(order(Action::move, {{Param::to, 100'000}})) == 20);  // it is there
}

TEST_CASE("without a limit of acceleration a movement has one speed, and STOP is immediate") {
  for (const vm::DriverId id : {vm::DriverId::servo, vm::DriverId::virtual_motion}) {
    Mover mover(id, 0);
    CHECK(mover.takes(order(Action::move, {{Param::to, 90'000}})) == 1000);
    mover.move({{Param::to, 180'000}});
    mover.run(mover.now + 500'000);
    CHECK(mover.position() == 135'000);
    mover.begin(order(Action::stop));
    CHECK(mover.wake == kDone);
    CHECK(mover.position() == 135'000);
  }
}

TEST_CASE("a movement that replaces another goes on at its speed, or brakes first") {
  for (const vm::DriverId id : {vm::DriverId::servo, vm::DriverId::virtual_motion}) {
    const auto moving = [&] {
      auto mover = std::make_unique<Mover>(id, 180);
      mover->move({{Param::to, 90'000}});
      mover->run(kStart + 750'000);  // at 45 degrees, 90deg/s
      return mover;
    };
    auto ahead = moving();
    CHECK(ahead->takes(order(Action::follow, {{Param::to, 135'000}})) == 1250);
    CHECK(ahead->position() == 135'000);
    auto timed = moving();
    CHECK(timed->takes(order(Action::move, {{Param::to, 135'000}, {Param::over, 1250}})) == 1250);
    auto back = moving();
    back->move({{Param::to, 0}});
    back->run(kStart + 1'250'000);
    CHECK(back->position() == 67'500);
    back->run();
    CHECK(back->position() == 0);
    CHECK(back->now == kStart + 750'000 + 500'000 + 1'250'000);
    auto timed_back = moving();
    CHECK(timed_back->takes(order(Action::move, {{Param::to, 0}, {Param::over, 3000}})) == 3000);
    auto near = moving();  // it cannot stop there
    CHECK(near->takes(order(Action::move, {{Param::to, 50'000}})) == 500 + 624);
    auto slower = moving();
    CHECK(slower->takes(order(Action::move, {{Param::to, 97'500}, {Param::at, 30'000}})) ==
          500 + 1167);
    auto stopped = moving();
    CHECK(stopped->takes(order(Action::stop)) == 500);
    CHECK(stopped->position() == 67'500);
    CHECK(stopped->takes(order(Action::stop)) == 0);
    auto stands = moving();
    CHECK(stands->takes(order(Action::move, {{Param::to, 0}, {Param::at, 0}})) == 500);
    CHECK(stands->position() == 67'500);
  }
}

TEST_CASE(
    "released, it stays where it is at once; taken over in the same step, it goes on at its "
    "speed") {
  for (const kernel::Time later : {0, 10'000}) {
    Mover servo(vm::DriverId::servo, 180);
    servo.move({{Param::to, 90'000}});
    servo.run(kStart + 750'000);
    servo.driver.release(servo.device(), vm::Release::hold, servo.now);
    CHECK(servo.pulse() == 1000);
    servo.now += later;
    CHECK(servo.position() == 45'000);
    CHECK(servo.takes(order(Action::move, {{Param::to, 135'000}})) == (later == 0 ? 1250 : 1500));
  }
  for (const vm::Release how : {vm::Release::coast, vm::Release::rest}) {
    Mover servo(vm::DriverId::servo, 180);
    servo.move({{Param::to, 90'000}});
    servo.run(kStart + 750'000);
    servo.driver.release(servo.device(), how, servo.now);
    CHECK(servo.pulse() == (how == vm::Release::coast ? 0 : 500));
    const Value way = 135'000 - servo.position();
    CHECK(servo.takes(order(Action::move, {{Param::to, 135'000}})) ==
          static_cast<std::uint64_t>(way / 90 + 500));
  }
}

TEST_CASE("a gesture with ramps takes its OVER, or as long as its limits need") {
  Mover joint(vm::DriverId::virtual_motion, 180);
  joint.takes(order(Action::move, {{Param::to, 60'000}}));
  const std::uint64_t ramps = 3 * 500;
  CHECK(joint.takes(order(Action::move)) ==
        4001 + ramps);  // legs of 120, 180 and 60 degrees: 1334, 2000 and 667 ms
  CHECK(joint.position() == 60'000);
  const auto close_to = [](std::uint64_t length, std::uint64_t said) {
    return length >= said && length <= said + 6;
  };
  CHECK(close_to(joint.takes(order(Action::move, {{Param::over, 9000}})), 9000));
  joint.wiring.speed_limit = 90'000;
  CHECK(close_to(joint.takes(order(Action::move, {{Param::over, 1000}})), 4000 + ramps));
  joint.takes(order(Action::move, {{Param::to, 0}}));
  CHECK(close_to(joint.takes(order(Action::move, {{Param::over, 9000}})), 9000));
}
