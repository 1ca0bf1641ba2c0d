// The time words of docs/language.md, each read literally: whatever a rule says about the
// past is looked up in the whole past.
#include <algorithm>
#include <optional>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "tests/properties/timeline.hpp"

using robosync::test::rising;
using robosync::test::Timeline;
using robosync::test::Times;

namespace {

std::string ms(int duration) {
  return std::to_string(duration) + "ms";
}

std::string when(const std::string& condition) {
  return "WHEN " + condition + "\nDO\nLOG \"now\"\nEND\n";
}

// When `c FOR d` becomes true, and false. The readings of a millisecond come before what is due in it: one
// that ends the condition when its time is over ends it in time.
struct Changes {
  Times rises, falls;
};
Changes held(const std::vector<bool>& c, int duration) {
  Changes changes;
  std::optional<int> since;
  bool held = false;
  for (int at = 0; at < static_cast<int>(c.size()); ++at) {
    if (c[static_cast<std::size_t>(at)]) {
      if (!since) since = at;
    } else {
      since.reset();
      if (held) changes.falls.push_back(at);
      held = false;
    }
    if (since && !held && at - *since >= duration) {
      changes.rises.push_back(at);
      held = true;
    }
  }
  return changes;
}

// The triggers that are left when those within `cooldown` of one that is left are ignored.
Times cooled(const Times& triggers, int cooldown) {
  Times left;
  for (const int at : triggers)
    if (left.empty() || at >= left.back() + cooldown) left.push_back(at);
  return left;
}

// Compares, and counts what was compared, so that a test of nothing is noticed.
void same(const Times& seen, const Times& expected, std::size_t& compared) {
  RC_ASSERT(seen == expected);
  compared += expected.size();
}

constexpr std::size_t kEnough = 20;  // triggers compared in a test

}  // namespace

TEST_CASE("WHEN fires when the condition becomes true, the first reading included") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int limit = *rc::gen::inRange(0, 10);
    const auto truth = timeline.truth([&](int x) { return x > limit; });
    same(timeline.run(when("near X > " + std::to_string(limit)), "fire"), rising(truth), compared);
  }));
  CHECK(compared > kEnough);
}

TEST_CASE("FOR: true at every moment of the duration") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int limit = *rc::gen::inRange(0, 10);
    const int duration = *rc::gen::inRange(1, 400);
    const auto truth = timeline.truth([&](int x) { return x > limit; });
    same(timeline.run(when("near X > " + std::to_string(limit) + " FOR " + ms(duration)), "fire"),
         held(truth, duration).rises, compared);
  }));
  CHECK(compared > kEnough);
}

TEST_CASE("FOR with ELSE: the fall is immediate") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int limit = *rc::gen::inRange(0, 10);
    const int duration = *rc::gen::inRange(1, 400);
    const Changes changes = held(timeline.truth([&](int x) { return x > limit; }), duration);
    Times expected = changes.rises;
    expected.insert(expected.end(), changes.falls.begin(), changes.falls.end());
    for (int at = 1; at < timeline.end(); ++at)  // the first reading chooses ELSE
      if (timeline.known(at) && !timeline.known(at - 1)) expected.push_back(at);
    std::sort(expected.begin(), expected.end());
    same(timeline.run("WHEN near X > " + std::to_string(limit) + " FOR " + ms(duration) +
                          "\nDO\nLOG \"yes\"\nELSE\nLOG \"no\"\nEND\n",
                      "fire"),
         expected, compared);
  }));
  CHECK(compared > kEnough);
}

TEST_CASE("n TIMES WITHIN: the n-th rise in the window, then from 0 again") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int limit = *rc::gen::inRange(2, 8);
    const int times = *rc::gen::inRange(1, 5);
    const int window = *rc::gen::inRange(1, 600);
    Times expected;
    Times since;  // rises after the last time it fired
    for (const int at : rising(timeline.truth([&](int x) { return x > limit; }))) {
      since.push_back(at);
      const auto n = static_cast<std::size_t>(times);
      if (since.size() < n || at - since[since.size() - n] > window) continue;
      expected.push_back(at);
      since.clear();
    }
    same(timeline.run(when("near X > " + std::to_string(limit) + " " + std::to_string(times) +
                           " TIMES WITHIN " + ms(window)),
                      "fire"),
         expected, compared);
  }));
  CHECK(compared > kEnough);
}

TEST_CASE("THEN WITHIN: a rise of the second soon after a rise of the first") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int high = *rc::gen::inRange(4, 9);
    const int low = *rc::gen::inRange(2, high + 1);
    const int window = *rc::gen::inRange(1, 400);
    const Times firsts = rising(timeline.truth([&](int x) { return x > high; }));
    Times expected;
    for (const int at : rising(timeline.truth([&](int x) { return x < low; }))) {
      // The last rise of the first, if the rule has not used it up.
      const auto after = std::lower_bound(firsts.begin(), firsts.end(), at);
      if (after == firsts.begin() || at - after[-1] > window) continue;
      if (!expected.empty() && expected.back() > after[-1]) continue;
      expected.push_back(at);
    }
    same(timeline.run(when("near X > " + std::to_string(high) + " THEN near X < " +
                           std::to_string(low) + " WITHIN " + ms(window)),
                      "fire"),
         expected, compared);
  }));
  CHECK(compared > kEnough);
}

TEST_CASE("MARGIN: enters at the number, leaves a margin later") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int limit = *rc::gen::inRange(3, 9);
    const int margin = *rc::gen::inRange(1, 4);
    const auto enters = timeline.truth([&](int x) { return x > limit; });
    const auto leaves = timeline.truth([&](int x) { return x < limit - margin; });
    Times expected;
    bool inside = false;
    for (std::size_t at = 0; at < enters.size(); ++at) {
      if (enters[at] && !inside) expected.push_back(static_cast<int>(at));
      inside = (inside || enters[at]) && !leaves[at];
    }
    same(timeline.run("WHEN near X > " + std::to_string(limit) + "\nMARGIN " +
                          std::to_string(margin) + "\nDO\nLOG \"now\"\nEND\n",
                      "fire"),
         expected, compared);
  }));
  CHECK(compared > kEnough);
}

TEST_CASE("CHANGES BY: against the value of the last time, the first reading to begin with") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int least = *rc::gen::inRange(1, 5);
    Times expected;
    std::optional<int> reference;
    for (int at = 0; at < timeline.end(); ++at) {
      const auto value = timeline.value(at);
      if (!value) continue;
      if (!reference) reference = value;
      if (std::abs(*value - *reference) < least) continue;
      expected.push_back(at);
      reference = value;
    }
    same(timeline.run(when("near X CHANGES BY " + std::to_string(least)), "fire"), expected,
         compared);
  }));
  CHECK(compared > kEnough);
}

TEST_CASE("COOLDOWN: what comes too soon after a start is ignored") {
  std::size_t compared = 0;
  CHECK(rc::check([&] {
    const Timeline timeline = Timeline::random();
    const int limit = *rc::gen::inRange(2, 8);
    const int cooldown = *rc::gen::inRange(1, 600);
    const auto truth = timeline.truth([&](int x) { return x > limit; });
    same(timeline.run("WHEN near X > " + std::to_string(limit) + "\nCOOLDOWN " + ms(cooldown) +
                          "\nDO\nLOG \"now\"\nEND\n",
                      "win"),
         cooled(rising(truth), cooldown), compared);
  }));
  CHECK(compared > kEnough);
}
