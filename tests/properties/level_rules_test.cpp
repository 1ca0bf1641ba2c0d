// WHILE and EVERY of docs/language.md, read literally.
#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "tests/properties/timeline.hpp"

using robosync::test::rising;
using robosync::test::Timeline;
using robosync::test::Times;

TEST_CASE("EVERY comes each period, from one period after the start") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int period = *rc::gen::inRange(1, 500);
    Times expected;
    for (int at = period; at < timeline.end(); at += period)
      expected.push_back(at);
    const Times seen = timeline.run("EVERY " + std::to_string(period) +
                                        "ms\nDO\nLOG \"now\"\nEND\n"
                                        "WHEN near X > 3\nDO\nMOVE a FOR 10ms\nEND\n",
                                    "fire r0");
    RC_ASSERT(seen == expected);
    compared += seen.size();
  }));
  CHECK(compared > 20);
}

TEST_CASE("EVERY … TO …: each period is within the bounds, and they differ") {
  std::size_t different = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int least = *rc::gen::inRange(1, 100);
    const int most = least + *rc::gen::inRange(0, 100);
    const Times seen =
        timeline.run("EVERY " + std::to_string(least) + "ms TO " + std::to_string(most) +
                         "ms\nDO\nLOG \"now\"\nEND\n"
                         "WHEN near X > 3\nDO\nMOVE a FOR 10ms\nEND\n",
                     "fire r0");
    int last = 0;
    int last_period = 0;
    for (const int at : seen) {
      RC_ASSERT(at - last >= least);
      RC_ASSERT(at - last <= most);
      if (last_period != 0 && at - last != last_period) ++different;
      last_period = at - last;
      last = at;
    }
    RC_ASSERT(timeline.end() - 1 - last <= most);
  }));
  CHECK(different > 100);
}

namespace {
constexpr int kShortestRound = 20;  // ms, if it does not wait
}

TEST_CASE("WHILE runs as long as its condition is true, and ends in the step in which it is not") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int limit = *rc::gen::inRange(1, 9);
    const int length = *rc::gen::inRange(1, 300);
    const auto truth = timeline.truth([&](int x) { return x > limit; });
    const std::string rsl = "WHILE near X > " + std::to_string(limit) + "\nDO\nMOVE a FOR " +
                            std::to_string(length) + "ms\nEND\n";
    const Times starts = timeline.run(rsl, "command a");
    Times begins;  // of the stretches in which it runs without a stop
    int until = -2;
    for (const int at : starts) {
      RC_ASSERT(truth[static_cast<std::size_t>(at)]);
      const bool again = at == until;  // rounds do not drift
      if (!again || !truth[static_cast<std::size_t>(at - 1)]) begins.push_back(at);
      until = at + std::max(length, kShortestRound);
    }
    RC_ASSERT(begins == rising(truth));
    Times cancels;
    std::size_t next = 0;
    for (std::size_t at = 1; at < truth.size(); ++at) {
      if (!truth[at - 1] || truth[at]) continue;
      // It falls at `at`: the command under way is cancelled, unless it is done by then.
      int last_start = -1;
      while (next < starts.size() && starts[next] <= static_cast<int>(at))
        last_start = starts[next++];
      if (last_start >= 0 && last_start + length > static_cast<int>(at))
        cancels.push_back(static_cast<int>(at));
    }
    RC_ASSERT(timeline.run(rsl, "cancel a") == cancels);
    compared += begins.size() + cancels.size();
  }));
  CHECK(compared > 20);
}
