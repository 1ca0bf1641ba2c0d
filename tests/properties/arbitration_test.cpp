// Who gets the actuators: random robots with random stimuli against the reference interpreter. The
// RSL goes through the real compiler and the real simulator; what differs is made small.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "tests/oracles/rsl/analysed.hpp"
#include "tests/runtime-m4/robot.hpp"

namespace oracle = robosync::oracle;
using robosync::test::Robot;

namespace {

const std::vector<std::string> kActuatorNames = {"a", "b", "c", "d"};

struct Condition {
  int above_x;  // near X > above_x
  int above_y;  // far Y > above_y
  int form;     // 0: x, 1: y, 2: x AND y, 3: x OR y, 4: NOT x
};

struct Step {
  unsigned actuator;
  int length_ms;
};

struct Rule {
  unsigned behavior;
  Condition condition;
  std::vector<Step> then;
  std::vector<Step> otherwise;  // empty: no ELSE
};

struct Feed {
  int at_ms;
  bool is_x;
  int value;
};

// --- as RSL ---

std::string text_of(const Condition& c) {
  const std::string x = "near X > " + std::to_string(c.above_x);
  const std::string y = "far Y > " + std::to_string(c.above_y);
  switch (c.form) {
    case 0:
      return x;
    case 1:
      return y;
    case 2:
      return x + " AND " + y;
    case 3:
      return x + " OR " + y;
    default:
      return "NOT " + x;
  }
}

std::string text_of(const std::vector<Step>& steps) {
  std::string text;
  for (const Step& step : steps)
    text +=
        "MOVE " + kActuatorNames[step.actuator] + " FOR " + std::to_string(step.length_ms) + "ms\n";
  return text;
}

std::string text_of(const std::vector<Rule>& rules) {
  std::string text;
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const Rule& rule = rules[r];
    if (r == 0 || rules[r - 1].behavior != rule.behavior)
      text += "BEHAVIOR k" + std::to_string(rule.behavior) + " PRIORITY " +
              std::to_string(90 - rule.behavior) + "\n";
    text += "WHEN " + text_of(rule.condition) + "\nDO\n" + text_of(rule.then);
    if (!rule.otherwise.empty()) text += "ELSE\n" + text_of(rule.otherwise);
    text += "END\n";
    if (r + 1 == rules.size() || rules[r + 1].behavior != rule.behavior) text += "END\n";
  }
  return text;
}

// --- both traces in the same words ---

using Events = std::map<int, std::vector<std::string>>;  // by milliseconds

// What is compared, sorted: cancels and commands of one tick go by rank, and their order is in the
// golden traces.
void add(Events& events, int at_ms, std::string event) {
  std::vector<std::string>& here = events[at_ms];
  here.insert(std::upper_bound(here.begin(), here.end(), event), std::move(event));
}

// "120 #3 command a MOVE for_=0.031", "120 #3 lose r1 DO to b0" and the like: "command a 31",
// "lose line 4 DO".
Events events_of(const Robot& robot) {
  Events events;
  for (const std::string& line : robot.lines()) {
    std::istringstream words(line);
    int at_ms = 0;
    std::string step, event, who, rest;
    words >> at_ms >> step >> event >> who >> rest;
    if (event == "input" || who.empty()) continue;
    if (event == "command")
      rest = std::to_string(std::lround(1000 * std::stod(line.substr(line.find('=') + 1))));
    if (event == "interrupt") rest.clear();
    if (who[0] == 'r')
      who = "line " + std::to_string(robot.image().rules[std::stoul(who.substr(1))].line);
    add(events, at_ms, event + " " + who + (rest.empty() ? "" : " " + rest));
  }
  return events;
}

// The same of the reference interpreter's trace, which is JSON.
Events events_of(std::istream& trace) {
  Events events;
  for (std::string line; std::getline(trace, line);) {
    const auto object = nlohmann::json::parse(line);
    const std::string event = object.at("event");
    if (event == "input") continue;
    std::string said = event;
    if (object.contains("actuator")) said += " " + object["actuator"].get<std::string>();
    if (object.contains("line")) said += " line " + std::to_string(object["line"].get<int>());
    if (object.contains("side")) said += " " + object["side"].get<std::string>();
    if (object.contains("for"))
      said += " " + std::to_string(std::lround(1000 * object["for"].get<double>()));
    add(events, object.at("t_us").get<int>() / 1000, said);
  }
  return events;
}

Events expected_events(const std::string& program, const std::vector<Feed>& feeds, int end_ms) {
  const oracle::Analysed analysed("robot.rsl", program, robosync::test::kPlainRobot);
  std::vector<oracle::Reading> readings;
  for (const Feed& feed : feeds)
    readings.push_back({feed.at_ms,
                        analysed.channel(feed.is_x ? "near" : "far", feed.is_x ? "X" : "Y"),
                        feed.value * 1000});
  std::stringstream out;
  oracle::Trace trace(out, analysed.program(), analysed.robot());
  oracle::Interpreter(analysed.program(), analysed.robot(), 1, trace).run(readings, end_ms);
  return events_of(out);
}

// --- drawing ---

rc::Gen<std::vector<Step>> some_steps(std::size_t least) {
  // Lengths of 1 modulo 10, at most 3 of them, and feeds at multiples of 10: an end never falls on
  // a feed, where the order would be a matter of ranks.
  return rc::gen::resize(
      3, rc::gen::suchThat(rc::gen::container<std::vector<Step>>(rc::gen::map(
                               rc::gen::pair(rc::gen::inRange(0U, 4U), rc::gen::inRange(0, 12)),
                               [](const std::pair<unsigned, int>& p) {
                                 return Step{p.first, p.second * 10 + 1};
                               })),
                           [least](const std::vector<Step>& steps) {
                             return steps.size() >= least && steps.size() <= 3;
                           }));
}

std::vector<Rule> draw_rules() {
  std::vector<Rule> rules;
  const auto count = *rc::gen::inRange<std::size_t>(1, 8);
  unsigned behavior = 0;
  for (std::size_t r = 0; r < count; ++r) {
    if (r > 0 && *rc::gen::arbitrary<bool>()) ++behavior;
    const Condition condition{*rc::gen::inRange(0, 5), *rc::gen::inRange(0, 5),
                              *rc::gen::inRange(0, 5)};
    const auto otherwise = *rc::gen::arbitrary<bool>() ? *some_steps(1) : std::vector<Step>{};
    rules.push_back({behavior, condition, *some_steps(1), otherwise});
  }
  return rules;
}

std::vector<Feed> draw_feeds() {
  std::vector<Feed> feeds;
  const int count = *rc::gen::inRange(1, 40);
  int at = 0;
  for (int i = 0; i < count; ++i) {
    at += 10 * *rc::gen::inRange(0, 6);
    feeds.push_back({at, *rc::gen::arbitrary<bool>(), *rc::gen::inRange(0, 7)});
  }
  return feeds;
}

}  // namespace

TEST_CASE("random robots do what the reference interpreter says") {
  std::size_t events_compared = 0;
  const bool holds = rc::check("runtime against the reference interpreter", [&] {
    const std::vector<Rule> rules = draw_rules();
    const std::vector<Feed> feeds = draw_feeds();
    const std::string program = text_of(rules);
    RC_LOG() << program;

    Robot robot(program);
    for (const Feed& feed : feeds) {
      RC_LOG() << feed.at_ms << (feed.is_x ? " X " : " Y ") << feed.value << "\n";
      const char* channel = feed.is_x ? "X" : "Y";
      if (!robot.has(channel)) continue;  // no rule reads it
      robot.feed(static_cast<std::uint64_t>(feed.at_ms), channel, feed.value);
    }
    const int end = feeds.back().at_ms + 1000;
    robot.run(static_cast<std::uint64_t>(end));
    const Events actual = events_of(robot);
    const Events expected = expected_events(program, feeds, end);
    for (int now = 0; now <= end; ++now) {
      const auto at = [now](const Events& events) {
        const auto found = events.find(now);
        return found == events.end() ? std::vector<std::string>{} : found->second;
      };
      RC_ASSERT(at(actual) == at(expected));
      events_compared += at(actual).size();
    }
  });
  CHECK(holds);
  CHECK(events_compared > 1000);
}
