// How imu_gestures classifies motions, with times. The motions are synthetic: no body moves like this, but each has the features
// that the module looks for.
#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/algorithms/modules.hpp"

using robosync::test::Module;

namespace {

constexpr int kLevel = 0;

struct Vector {
  int x = 0, y = 0, z = 1000;
};

struct Body : Module {
  explicit Body(int period_ms = 10, std::vector<std::int32_t> config = {}, int rest_ms = 1000)
      : Module(*imu_gestures_describe(ROBOSYNC_ABI), std::move(config),
               static_cast<std::uint32_t>(period_ms)),
        period(period_ms) {
    (void)hold({}, rest_ms);
  }

  // All changes except those of the jerk, with the time since it began.
  std::string move(int ms, const std::function<Vector(int)>& at) {
    std::string text;
    for (int now = 0; now < ms; now += period) {
      const Vector a = at(now);
      std::string changed = put({a.x, a.y, a.z});
      if (changed.starts_with("LEVEL ")) {
        const std::size_t end = changed.find(' ', 6);
        changed = end == std::string::npos ? "" : changed.substr(end + 1);
      }
      if (!changed.empty())
        text += (text.empty() ? "" : ", ") + std::to_string(now) + " " + changed;
    }
    return text;
  }
  std::string hold(Vector a, int ms) {
    return move(ms, [&](int) { return a; });
  }
  // Shakes along Y, `hertz` times a second.
  std::string shake(int hertz, int strength, int ms) {
    return move(ms, [&](int now) {
      const double turns = hertz * now / 1000.0;
      return Vector{0, static_cast<int>(strength * std::sin(turns * 2 * std::acos(-1.0))), 1000};
    });
  }
  int period;
};

}  // namespace

TEST_CASE("a body at rest") {
  Module body(*imu_gestures_describe(ROBOSYNC_ABI));
  CHECK(body.put({0, 0, 1000}) == "LEVEL 0 GESTURE none TILT upright");
  for (int i = 0; i < 100; ++i)
    CHECK(body.put({i % 3, -i % 2, 1000 + i % 4}).empty());  // and a little noise
}

TEST_CASE("the jerk rises at once and fades, as fast at every rate") {
  for (const int period : {5, 10, 20}) {
    INFO(period);
    Body body(period);
    (void)body.put({300, 0, 1000});
    CHECK(body.output(kLevel) == 300'000 / period / 1000 * 1000);
    (void)body.put({0, -300, 1000});  // both axes count
    CHECK(body.output(kLevel) == 600'000 / period / 1000 * 1000);
    const int highest = body.output(kLevel);
    (void)body.hold({0, -300, 1000}, 80);
    CHECK(body.output(kLevel) > highest / 5);
    CHECK(body.output(kLevel) < highest / 2);
    (void)body.hold({0, -300, 1000}, 1000);
    CHECK(body.output(kLevel) == 0);
  }
}

TEST_CASE("how it is held is seen when it is calm again, with a margin") {
  Body body;
  CHECK(body.hold({-1000, 0, 0}, 2000) == "820 TILT forward");
  CHECK(body.hold({1000, 0, 0}, 2000) == "820 TILT back");
  CHECK(body.hold({0, -1000, 0}, 2000) == "820 TILT left");
  CHECK(body.hold({0, 1000, 0}, 2000) == "820 TILT right");
  CHECK(body.hold({0, 0, -1000}, 2000) == "820 TILT upside_down");
  CHECK(body.hold({0, 0, 1000}, 2000) == "820 TILT upright");
  CHECK(body.hold({490, 0, 870}, 2000).empty());
  CHECK(body.hold({510, 0, 860}, 2000).ends_with("TILT back"));
  CHECK(body.hold({410, 0, 910}, 2000).empty());
  CHECK(body.hold({390, 0, 920}, 2000).ends_with("TILT upright"));
}

TEST_CASE("what is swung to and fro often and hard enough is shaken") {
  for (const int period : {5, 10, 20}) {
    INFO(period);
    Body body(period);
    CHECK(body.shake(3, 1500, 1000) == "520 GESTURE shaken");  // in the fourth half turn
    CHECK(body.hold({}, 1000) == "20 GESTURE none");           // 500 ms after the last swing
  }
  Body body;
  CHECK(body.shake(3, 600, 2000).empty());                              // not hard
  CHECK(body.shake(3, 1500, 480).find("shaken") == std::string::npos);  // not four times
  (void)body.hold({}, 1000);
  const auto now_and_then = [](int now) {
    const int force = now % 500 < 100 ? 1500 : 0;
    return Vector{0, now % 1000 < 500 ? force : -force, 1000};
  };
  CHECK(body.move(4000, now_and_then).find("shaken") == std::string::npos);
}

TEST_CASE("who goes on shaking it is told nothing new") {
  Body body(10, {1000, 700, 4000, 150, 500, 100, 450});  // three swings take 375 ms, four 500
  CHECK(body.shake(4, 1500, 3000) == "390 GESTURE shaken");
}

TEST_CASE("a short spike is a tap, a push is not") {
  Body body;
  CHECK(body.hold({0, 0, 3000}, 20).empty());
  CHECK(body.hold({}, 1000) == "110 GESTURE tapped, 610 GESTURE none");
  CHECK(body.hold({0, 0, 3000}, 60).empty());
  CHECK(body.hold({}, 1000).starts_with("110 GESTURE tapped"));
  CHECK(body.hold({1500, 0, 1000}, 80).empty());
  CHECK(body.hold({}, 1000).empty());
  CHECK(body.hold({900, 0, 1000}, 20).empty());  // too gentle
  CHECK(body.hold({}, 1000).empty());
}

TEST_CASE("a body in the air falls, and its landing is no tap") {
  Body body;
  CHECK(body.hold({0, 0, 290}, 90).empty());
  CHECK(body.hold({0, 0, 1000}, 500).empty());
  CHECK(body.hold({0, 0, 310}, 300).empty());
  (void)body.hold({}, 2000);
  CHECK(body.hold({100, 0, 100}, 400) == "90 GESTURE falling");
  CHECK(body.hold({0, 4000, 6000}, 30).empty());
  CHECK(body.hold({}, 2000) == "460 GESTURE none");
}

TEST_CASE("what is raised is lifted, what is put down is not") {
  Body body;
  CHECK(body.hold({0, 0, 1300}, 150) == "90 GESTURE lifted");
  CHECK(body.hold({0, 0, 700}, 150).empty());
  CHECK(body.hold({}, 2000) == "340 GESTURE none");
  CHECK(body.hold({0, 0, 700}, 150).empty());
  CHECK(body.hold({0, 0, 1300}, 150).empty());
  CHECK(body.hold({}, 2000).empty());
  CHECK(body.hold({0, 1600, 1000}, 170).empty());  // sideways
  (void)body.hold({}, 2000);
  CHECK(body.hold({0, 0, 1300}, 80).empty());  // too short
  CHECK(body.hold({}, 2000).empty());
  (void)body.hold({0, 0, 3000}, 20);
  CHECK(body.hold({}, 130) == "110 GESTURE tapped");
  CHECK(body.hold({0, 0, 1300}, 150).empty());  // something else is shown
  (void)body.hold({0, 1000, 0}, 3000);          // held on its side
  CHECK(Body(10, {}, 10).hold({0, 0, 1300}, 150) == "90 GESTURE lifted");  // right at the start
  CHECK(body.hold({0, 1300, 0}, 150) == "90 GESTURE lifted");              // up is up
}

TEST_CASE("readings beyond all measure do no harm") {
  Body body;
  for (int i = 0; i < 1000; ++i) {
    (void)body.put({INT32_MAX, INT32_MIN + 1, i % 2 == 0 ? INT32_MAX : INT32_MIN + 1});
    CHECK((body.output(kLevel) >= 0 && body.output(kLevel) <= 20'000'000));
  }
}
