// Which thread outranks which.
#include "runtime-m4/policy/standing.hpp"

#include <catch2/catch.hpp>

using namespace robosync::policy;

TEST_CASE("safety ranks above everything, system below, whatever the priorities") {
  constexpr std::int8_t kLowest = INT8_MIN;
  constexpr std::int8_t kHighest = INT8_MAX;
  CHECK(standing(Category::safety, kLowest) > standing(Category::control, kHighest));
  CHECK(standing(Category::system, kHighest) < standing(Category::sensor, kLowest));
}

TEST_CASE("control ranks above the rest of a program, whatever the priorities") {
  CHECK(standing(Category::control, INT8_MIN) > standing(Category::behavior, INT8_MAX));
  CHECK(standing(Category::control, 4) > standing(Category::control, 3));
}

TEST_CASE("a higher priority outranks any category of a lower one") {
  CHECK(standing(Category::sensor, 5) > standing(Category::behavior, 4));
  CHECK(standing(Category::sensor, -1) > standing(Category::behavior, -2));
}

TEST_CASE("between equal priorities the higher base decides, whatever the category") {
  CHECK(standing(Category::sensor, {60, 50}) > standing(Category::behavior, {60, 40}));
  CHECK(standing(Category::sensor, {61, -64}) > standing(Category::behavior, {60, 60}));
}

TEST_CASE("within one priority behavior > processing > sensor") {
  CHECK(standing(Category::behavior, 3) > standing(Category::processing, 3));
  CHECK(standing(Category::processing, 3) > standing(Category::sensor, 3));
}
