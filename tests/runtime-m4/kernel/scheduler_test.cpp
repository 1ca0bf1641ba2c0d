// The ready set against a std::set.
#include "runtime-m4/kernel/scheduler.hpp"

#include <set>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using namespace robosync::kernel;

TEST_CASE("the empty ready set selects idle") {
  CHECK(ReadySet{}.first() == kIdleRank);
}

namespace {

// Do these operations on a ready set give the same results as on a set of ranks? Each is one of three, with
// a rank.
template <unsigned kWords>
void behaves_like_a_set(const std::vector<std::uint16_t>& operations) {
  constexpr unsigned kRanks = kWords * 32;
  using Ready = BasicReadySet<kWords>;
  Ready ready;
  std::set<unsigned> model;
  for (const std::uint16_t operation : operations) {
    const unsigned rank = operation % kRanks;
    switch (operation / kRanks % 3) {
      case 0:
        Ready::insert(ready.position(rank));
        model.insert(rank);
        break;
      case 1:
        Ready::erase(ready.position(rank));
        model.erase(rank);
        break;
      default:
        const unsigned next = (rank + 1) % kRanks;
        const bool was_in = model.contains(next);
        Ready::exchange(ready.position(rank), ready.position(next));
        if (model.contains(rank) != was_in) {
          if (model.erase(rank) == 0) model.insert(rank);
          if (model.erase(next) == 0) model.insert(next);
        }
    }
    RC_ASSERT(ready.first() == (model.empty() ? kRanks : *model.begin()));
    for (unsigned r = 0; r < kRanks; ++r) {
      RC_ASSERT(Ready::contains(ready.position(r)) == model.contains(r));
    }
  }
}

}  // namespace

TEST_CASE("the ready set behaves like a set of ranks") {
  CHECK(rc::check("64 of them", behaves_like_a_set<2>));
  CHECK(rc::check("128 of them", behaves_like_a_set<4>));
}
