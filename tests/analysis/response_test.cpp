// Response-time analysis against a simulation that shares no code with it: nothing that is observed
// over a million patterns of releases takes longer than was said, and at the critical instant it
// takes nearly as long.
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include <catch2/catch.hpp>

#include "analysis/report.hpp"
#include "analysis/task_set.hpp"
#include "rsc/board.hpp"
#include "rsc/program.hpp"
#include "tests/analysis/simulation.hpp"
#include "tests/timing/programs.hpp"

using namespace robosync;
using analysis::Priorities;
using analysis::TaskSet;
using test::Pattern;
using test::Time;

namespace {

constexpr unsigned kSets = 300;

// How many in all. `scripts/timing --patterns N` tries more.
unsigned long patterns() {
  const char* const wanted = std::getenv("ROBOSYNC_ANALYSIS_PATTERNS");
  return wanted == nullptr ? 3'000 : std::strtoul(wanted, nullptr, 10);
}
constexpr double kNear = 0.95;
constexpr double kNotFar = 0.85;

class Draw {
public:
  explicit Draw(unsigned seed) : random_(seed + 1) {}
  Time number(Time least, Time most) {
    return std::uniform_int_distribution<Time>(least, most)(random_);
  }
  bool chance(double share) {
    return std::uniform_real_distribution<double>(0, 1)(random_) < share;
  }
  std::mt19937& random() { return random_; }

private:
  std::mt19937 random_;
};

analysis::Source drawn_source(Draw& draw, unsigned number) {
  analysis::Source source;
  source.name = "s" + std::to_string(number);
  source.period = draw.number(5'000, 100'000);
  source.sample = draw.number(1, source.period / 20);
  source.step = draw.number(20, source.period / 12 + 20);
  source.rank = 1 + number;
  source.raised = source.rank;
  return source;
}

// Due by itself, or up to three that follow each other.
void add_timed(TaskSet& set, std::size_t like, Draw& draw) {
  analysis::Source timed = set.sources[like];
  timed.name += " again";
  timed.sample = 0;
  timed.rank = 0;
  timed.outranks_a_behavior = timed.may_outrank_one = true;
  const auto followers = draw.chance(0.5) ? draw.number(1, 3) : 0;
  if (followers == 0) set.sources.push_back(timed);
  for (Time i = 0; i < followers; ++i) {
    timed.follows = i == 0 ? like : set.sources.size() - 1;
    timed.delay = draw.number(1, 5'000);
    timed.step = draw.number(20, timed.period / 30 + 20);
    set.sources.push_back(timed);
  }
}

// `sneaky`: some outrank a behaviour, are due by themselves, follow others.
TaskSet drawn_set(Draw& draw, bool sneaky) {
  TaskSet set;
  const unsigned sources = static_cast<unsigned>(draw.number(1, 6));
  for (unsigned s = 0; s < sources; ++s)
    set.sources.push_back(drawn_source(draw, s));
  // Those with the better ranks outrank more.
  const auto outranking = sneaky ? draw.number(0, sources) : 0;
  for (unsigned s = 0; s < outranking; ++s)
    set.sources[s].outranks_a_behavior = set.sources[s].may_outrank_one = true;
  const std::size_t sampled = set.sources.size();
  for (std::size_t j = 0; sneaky && j < sampled; ++j)
    if (draw.chance(0.4)) add_timed(set, j, draw);
  const std::size_t rules = draw.number(0, 6);
  set.lost = draw.number(0, 500);               // none costs less
  const std::size_t apart = draw.number(1, 3);  // of every so many, the last fires as it likes
  for (std::size_t r = 0; r < rules; ++r) {
    analysis::Firing rule{
        "r" + std::to_string(r), draw.number(set.lost, 2'000), draw.chance(0.5), {}};
    for (std::size_t j = 0; j < set.sources.size(); ++j)
      if (draw.chance(0.5)) rule.sources.push_back(j);
    if (sneaky && r % (apart + 1) != 0) {  // choices 1 and 2, both in one contest
      rule.choice = 1 + r % 2;
      if (apart > 1) rule.contest = 0;
    }
    if (sneaky && draw.chance(0.3)) rule.gap = draw.number(1'000, 200'000);
    if (sneaky && draw.chance(0.3)) rule.cooldown = draw.number(1'000, 200'000);
    set.firings.push_back(rule);
  }
  for (unsigned i = 0; i < draw.number(0, 4); ++i) {
    const Time period = draw.number(3'000, 30'000);
    set.interferences.push_back({"i", period, draw.number(1, period / 25 + 1)});
  }
  set.longest_lock = draw.number(0, 60);
  analysis::settle(set, Priorities::base);
  return set;
}

Time longest_period(const TaskSet& set) {
  Time longest = 0;
  for (const analysis::Source& source : set.sources)
    longest = std::max(longest, source.period);
  return longest;
}

// Near together, or anywhere.
Pattern drawn_pattern(const TaskSet& set, Draw& draw) {
  Pattern pattern;
  const Time spread = draw.chance(0.5) ? 1'000 : 50'000;
  for (const analysis::Source& source : set.sources)
    pattern.first.push_back(source.follows == analysis::Source::kNone ? draw.number(1, spread)
                                                                      : ~Time{0});
  for (const analysis::Interference& one : set.interferences)
    pattern.interference_first.push_back(draw.number(1, one.period));
  pattern.laziness = draw.chance(0.5) ? 0 : 1;
  pattern.truth = draw.chance(0.3) ? 1 : 0.5;
  pattern.locks = draw.chance(0.5);
  pattern.behaviors_begin = draw.number(0, 3'000);
  pattern.follow_delay = draw.chance(0.5) ? 5'000 : draw.number(1, 5'000);
  return pattern;
}

std::vector<Time> bounds_of(const TaskSet& set) {
  std::vector<Time> bounds;
  for (std::size_t s = 0; s < set.sources.size(); ++s) {
    const analysis::ResponseTime response = analysis::response_time_of(set, s, Priorities::base);
    bounds.push_back(response.bounded ? response.time : ~Time{0});
  }
  return bounds;
}

bool exceeds(const std::vector<Time>& seen, const std::vector<Time>& bounds) {
  for (std::size_t s = 0; s < seen.size(); ++s)
    if (seen[s] > bounds[s]) return true;
  return false;
}

// One of the lowest has begun its step, and everybody comes.
Pattern critical_instant(const TaskSet& set, std::size_t blocker) {
  Pattern pattern;
  const Time begins = 2 + set.sources[blocker].sample;
  for (std::size_t s = 0; s < set.sources.size(); ++s)
    pattern.first.push_back(s == blocker ? 1 : begins);
  pattern.interference_first.assign(set.interferences.size(), begins);
  pattern.locks = false;
  pattern.behaviors_begin = ~Time{0};
  return pattern;
}

}  // namespace

TEST_CASE("nothing takes longer than was said, whatever the pattern of releases") {
  unsigned long tried = 0;
  double nearest = 0;
  for (unsigned number = 0; tried < patterns(); ++number) {
    REQUIRE(number < 2 * (kSets + 1));  // most of the sets that are drawn can be used
    Draw draw(number);
    const TaskSet set = drawn_set(draw, number % 4 != 0);
    if (analysis::utilization(set) > 0.85) continue;
    const std::vector<Time> bounds = bounds_of(set);
    for (unsigned long p = 0; p <= patterns() / kSets; ++p, ++tried) {
      const Pattern pattern = drawn_pattern(set, draw);
      const auto seen = test::simulate(set, pattern, longest_period(set), draw.random());
      for (std::size_t s = 0; s < seen.size(); ++s) {
        if (seen[s] > bounds[s])
          FAIL("set " << number << ", source " << s << " of " << set.sources.size() << ": "
                      << seen[s] << " > " << bounds[s] << ", pattern " << p);
        if (bounds[s] != ~Time{0})
          nearest =
              std::max(nearest, static_cast<double>(seen[s]) / static_cast<double>(bounds[s]));
      }
    }
  }
  std::cout << "response times: " << tried << " patterns of releases, the longest took " << nearest
            << " of what was said\n";
  CHECK(nearest > kNear);  // a bound that nothing comes near would prove little
}

TEST_CASE("at the critical instant it takes at least 95 % of what was said") {
  unsigned looked_at = 0;
  unsigned near = 0;
  for (unsigned number = 0; number < 2'000; ++number) {
    Draw draw(number);
    TaskSet set = drawn_set(draw, false);
    set.longest_lock = 0;
    set.firings.clear();  // so that the step that blocks costs what it is said to
    const std::size_t last = set.sources.size() - 1;
    if (analysis::utilization(set) > 0.7) continue;
    for (std::size_t s = 0; s < last; ++s) {
      // The longest step of those below.
      std::size_t blocker = s + 1;
      for (std::size_t j = s + 1; j <= last; ++j)
        if (set.sources[j].step > set.sources[blocker].step) blocker = j;
      const analysis::ResponseTime bound = analysis::response_time_of(set, s, Priorities::base);
      const auto seen =
          test::simulate(set, critical_instant(set, blocker), 1'000'000, draw.random());
      INFO("set " << number << ", source " << s);
      CHECK(seen[s] <= bound.time);
      const double share = static_cast<double>(seen[s]) / static_cast<double>(bound.time);
      CHECK(share > kNotFar);
      near += share >= kNear ? 1 : 0;
      ++looked_at;
    }
  }
  CHECK(looked_at > 1'000);
  CHECK(near > looked_at / 100 * 99);  // an interrupt counts that comes just too late for the step
}

TEST_CASE("each term is needed: without it, the simulation takes longer than was said") {
  Draw draw(7);
  TaskSet set;
  for (unsigned s = 0; s < 3; ++s)
    set.sources.push_back(drawn_source(draw, s));
  for (analysis::Source& source : set.sources) {
    source.period = 100'000;
    source.sample = 500;
    source.step = 3'000;
  }
  set.interferences.push_back({"the tick", 1'000, 36});
  const auto seen = [&](std::size_t blocker) {
    return test::simulate(set, critical_instant(set, blocker), 200'000, draw.random());
  };
  const std::vector<Time> worst = seen(2);
  CHECK_FALSE(exceeds(worst, bounds_of(set)));

  TaskSet without = set;
  without.interferences.clear();
  CHECK(exceeds(worst, bounds_of(without)));

  without = set;
  without.sources[2].step = 0;  // what blocks
  CHECK(worst[1] > bounds_of(without)[1]);

  without = set;
  without.sources[0].sample = without.sources[0].step = 0;  // what outranks
  CHECK(worst[1] > bounds_of(without)[1]);

  TaskSet locked = set;
  locked.longest_lock = 2'000;
  Pattern pattern = critical_instant(locked, 0);
  pattern.first = {1'000, 1'000, 1'000};
  pattern.interference_first = {1'000};
  pattern.locks = true;
  const auto late = test::simulate(locked, pattern, 50'000, draw.random());
  CHECK_FALSE(exceeds(late, bounds_of(locked)));
  TaskSet alone = locked;
  alone.sources.resize(1);
  alone.longest_lock = 0;
  CHECK(late[0] > bounds_of(alone)[0]);
}

// By hand: the root 1,100 and what joins it 5,000, two of what follows 2,000 each, 1,000 between;
// and the step of the path, 3,000, blocks each of the two steps.
TEST_CASE("a rule that cools down wins once, and may lose in every step") {
  TaskSet set;
  set.lost = 100;
  analysis::Source often;
  often.period = 2'000;
  often.step = 50;
  often.rank = 1;
  often.outranks_a_behavior = true;
  analysis::Source seldom;
  seldom.period = 100'000;
  seldom.step = 6'000;
  seldom.rank = 2;
  set.sources = {often, seldom};
  analysis::Firing other;
  other.cost = 200;
  other.sources = {0};
  other.contest = 0;
  analysis::Firing it = other;
  it.cost = 300;
  set.firings = {other};
  const auto bound = [&] { return analysis::response_time_of(set, 1, Priorities::base).time; };
  const Time alone = bound();
  set.firings.push_back(it);
  const Time always = bound();
  set.firings.back().cooldown = 1'000'000;
  const Time steps = 4;  // of `often` in this time
  CHECK(always == alone + steps * (300 - 200) + steps * set.lost);
  CHECK(bound() == alone + (300 - 200) + steps * set.lost);
}

TEST_CASE("from the asking for a sample on, all is one stretch of work, and the wait for its bus") {
  TaskSet set;
  set.sources.resize(3);
  for (analysis::Source& source : set.sources)
    source.period = 20'000;
  set.sources[0].sample = 100;  // asks
  set.sources[1].sample = 200;
  set.sources[1].step = 1'000;
  set.sources[1].follows = 0;
  set.sources[1].delay = 3'000;
  set.sources[2].step = 500;  // outranks both
  analysis::settle(set, Priorities::base);
  const auto whole = analysis::response_time_from_asking(set, 1, Priorities::base);
  CHECK(whole.bounded);
  CHECK(whole.time == 100 + 3'000 + 200 + 1'000 + 500);
  CHECK(whole.time <=
        analysis::response_time_of(set, 1, Priorities::base).time + set.sources[1].jitter);
  CHECK_FALSE(analysis::response_time_from_asking(set, 2, Priorities::base).bounded);
  set.sources[1].rank = 1;  // another thread's
  CHECK_FALSE(analysis::response_time_from_asking(set, 1, Priorities::base).bounded);
}

TEST_CASE("what follows a step comes late, and the next one may come soon after") {
  constexpr Time kPeriod = 20'000;
  TaskSet set;
  set.sources.resize(4);
  for (analysis::Source& source : set.sources) {
    source.period = 5 * kPeriod;
    source.outranks_a_behavior = source.may_outrank_one = true;
  }
  analysis::Source& root = set.sources[0];
  root.period = kPeriod;
  root.sample = 100;
  root.step = 1'000;
  set.sources[1].step = 5'000;  // joins it
  analysis::Source& follower = set.sources[2];
  follower.name = "follower";
  follower.period = kPeriod;
  follower.step = 2'000;
  follower.follows = 0;
  follower.delay = 1'000;
  set.sources[3].rank = 9;  // the path
  set.sources[3].outranks_a_behavior = false;
  set.sources[3].step = 3'000;
  set.sources[3].period = 5 * kPeriod;
  analysis::settle(set, Priorities::base);
  CHECK(set.sources[2].jitter == 1'000 + 1'100 + 5'000 + 2 * 2'000 + 2 * 3'000);

  const analysis::ResponseTime response = analysis::response_time_of(set, 3, Priorities::base);
  const auto late =
      std::ranges::find(response.contributors, "follower", &analysis::Contributor::name);
  REQUIRE(late != response.contributors.end());
  CHECK(late->cost == 2 * 2'000);
}

TEST_CASE("utilization: of a choice, each step runs at most the most expensive") {
  TaskSet set;
  analysis::Source source;
  source.period = 1'000;
  set.sources = {source};
  analysis::Firing cheap;
  cheap.cost = 100;
  cheap.sources = {0};
  analysis::Firing dear = cheap;
  dear.cost = 300;
  set.firings = {cheap, dear};
  CHECK(analysis::utilization(set) == Approx(0.4));
  for (analysis::Firing& rule : set.firings)
    rule.choice = 0;
  CHECK(analysis::utilization(set) == Approx(0.3));
  for (analysis::Firing& rule : set.firings)
    rule.alternates = true;
  CHECK(analysis::utilization(set) == Approx(0.2));  // each as often as it can
}
