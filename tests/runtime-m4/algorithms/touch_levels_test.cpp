// How touch_levels interprets touches, with times.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/algorithms/modules.hpp"

using robosync::test::Module;

namespace {

constexpr std::int32_t kLight = 1000, kFirm = 5000, kMargin = 500;

struct Skin : Module {
  Skin() : Module(*touch_levels_describe(ROBOSYNC_ABI), {kLight, kFirm, kMargin, 300, 700, 400}) {}
  // Feeds the level for `ms`, at 50 Hz; returns all changes, with the time since it began.
  std::string hold(std::int32_t level, int ms) {
    std::string text;
    for (int at = 0; at < ms; at += 20)
      if (const std::string changed = put({level}); !changed.empty())
        text += (text.empty() ? "" : ", ") + std::to_string(at) + " " + changed;
    return text;
  }
};

}  // namespace

TEST_CASE("a module of another version of the interface says nothing") {
  CHECK(touch_levels_describe(ROBOSYNC_ABI) != nullptr);
  CHECK(touch_levels_describe(ROBOSYNC_ABI + 1) == nullptr);
}

TEST_CASE("the level's band has a margin below it") {
  Skin skin;
  CHECK(skin.put({0}) == "LEVEL none TOUCH none");
  CHECK(skin.put({999}).empty());
  CHECK(skin.put({1000}) == "LEVEL light");
  CHECK(skin.put({501}).empty());
  CHECK(skin.put({500}) == "LEVEL none TOUCH tap");
  CHECK(skin.put({5000}) == "LEVEL firm TOUCH none");
  CHECK(skin.put({4501}).empty());
  CHECK(skin.put({4500}) == "LEVEL light");
  CHECK(skin.put({4999}).empty());
  CHECK(skin.put({INT32_MAX}) == "LEVEL firm");
  CHECK(skin.put({INT32_MIN + 1}) == "LEVEL none TOUCH pat");
}

TEST_CASE("a short touch is a tap, or a pat when it was firm, and is shown for a while") {
  Skin skin;
  (void)skin.hold(0, 100);
  CHECK(skin.hold(2000, 280) == "0 LEVEL light");
  CHECK(skin.hold(0, 1000) == "0 LEVEL none TOUCH tap, 400 TOUCH none");
  CHECK(skin.hold(2000, 100) == "0 LEVEL light");
  CHECK(skin.hold(6000, 40) == "0 LEVEL firm");
  CHECK(skin.hold(2000, 140) == "0 LEVEL light");
  CHECK(skin.hold(0, 1000) == "0 LEVEL none TOUCH pat, 400 TOUCH none");
  CHECK(skin.hold(2000, 100) == "0 LEVEL light");
  CHECK(skin.hold(0, 40) == "0 LEVEL none TOUCH tap");  // firmness was that of the last touch
}

TEST_CASE("two taps are two, however soon the second comes") {
  Skin skin;
  (void)skin.hold(0, 100);
  (void)skin.hold(2000, 100);
  CHECK(skin.hold(0, 100) == "0 LEVEL none TOUCH tap");
  CHECK(skin.hold(2000, 100) == "0 LEVEL light TOUCH none");
  CHECK(skin.hold(0, 100) == "0 LEVEL none TOUCH tap");
}

TEST_CASE("a long touch is a stroke as long as it lasts, one in between is nothing") {
  Skin skin;
  (void)skin.hold(0, 100);
  CHECK(skin.hold(2000, 1000) == "0 LEVEL light, 700 TOUCH stroke");
  CHECK(skin.hold(0, 600) == "0 LEVEL none TOUCH none");
  CHECK(skin.hold(2000, 300) == "0 LEVEL light");
  CHECK(skin.hold(0, 600) == "0 LEVEL none");
  CHECK(skin.hold(2000, 700) == "0 LEVEL light");  // it has ended when it would have been one
  CHECK(skin.hold(0, 600) == "0 LEVEL none");
}
