// The policy against naive models: an order that is sorted, a set that is a std::set.
#include "runtime-m4/kernel/scheduler.hpp"

#include <set>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using namespace robosync::kernel;

TEST_CASE("safety ranks above everything, system below, whatever the priorities") {
  constexpr std::int16_t kLowest = INT16_MIN;
  constexpr std::int16_t kHighest = INT16_MAX;
  CHECK(standing(Category::safety, kLowest) > standing(Category::control, kHighest));
  CHECK(standing(Category::system, kHighest) < standing(Category::sensor, kLowest));
}

TEST_CASE("a higher priority outranks any category of a lower one") {
  CHECK(standing(Category::sensor, 5) > standing(Category::control, 4));
  CHECK(standing(Category::sensor, -1) > standing(Category::control, -2));
}

TEST_CASE("within one priority control > behavior > processing > sensor") {
  CHECK(standing(Category::control, 3) > standing(Category::behavior, 3));
  CHECK(standing(Category::behavior, 3) > standing(Category::processing, 3));
  CHECK(standing(Category::processing, 3) > standing(Category::sensor, 3));
}

TEST_CASE("the empty ready set selects idle") {
  CHECK(ReadySet{}.first() == kIdleRank);
}

// One operation on the set: bit 7..6 what, bit 5..0 the rank.
TEST_CASE("the ready set behaves like a set of ranks") {
  const bool holds = rc::check([](const std::vector<std::uint8_t>& operations) {
    ReadySet ready;
    std::set<unsigned> model;
    for (const std::uint8_t operation : operations) {
      const unsigned rank = operation % kMaxThreads;
      std::set<unsigned> moved;
      switch (operation / kMaxThreads) {
        case 0:
          ReadySet::insert(ready.place(rank));
          model.insert(rank);
          break;
        case 1:
          ReadySet::erase(ready.place(rank));
          model.erase(rank);
          break;
        case 2:
          ready.open_place(rank);
          for (const unsigned r : model)
            moved.insert(r < rank ? r : r + 1);
          moved.erase(kMaxThreads);  // the last place falls off; the kernel never fills it
          model = moved;
          break;
        default:
          ready.close_place(rank);
          for (const unsigned r : model) {
            if (r != rank) moved.insert(r < rank ? r : r - 1);
          }
          model = moved;
      }
      RC_ASSERT(ready.first() == (model.empty() ? kIdleRank : *model.begin()));
      for (unsigned r = 0; r < kMaxThreads; ++r) {
        RC_ASSERT(ReadySet::contains(ready.place(r)) == model.contains(r));
      }
    }
  });
  CHECK(holds);
}
