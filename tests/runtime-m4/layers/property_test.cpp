// Random robots with random stimuli against a naive interpreter of the language: rules as records,
// time as a loop over milliseconds, actuators as lists. No code is shared with the runtime; the RSL
// goes through the real compiler and the real simulator.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "tests/runtime-m4/robot.hpp"

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

// --- the naive interpreter ---

class Naive {
public:
  explicit Naive(std::vector<Rule> rules) : rules_(std::move(rules)), state_(rules_.size()) {}

  // What happens in this millisecond, as lines.
  std::vector<std::string> tick(int now, const std::vector<Feed>& feeds) {
    lines_.clear();
    now_ = now;
    finish_commands();
    std::optional<int> x = x_;
    std::optional<int> y = y_;
    for (const Feed& feed : feeds)
      (feed.is_x ? x : y) = feed.value;
    if (x != x_ || y != y_) {
      x_ = x;
      y_ = y;
      react();
    }
    return lines_;
  }

private:
  struct State {
    std::optional<bool> truth;
    std::optional<bool> running;                 // the side
    std::map<unsigned, std::vector<int>> queue;  // lengths, the first one under way
    std::map<unsigned, int> ends;
    bool won = false;  // in this step
  };

  void say(const std::string& what, const std::string& whom) {
    lines_.push_back(std::to_string(now_) + " " + what + " " + whom);
  }

  std::optional<bool> truth(const Condition& c) const {
    std::optional<bool> x;
    std::optional<bool> y;
    if (x_) x = *x_ > c.above_x;
    if (y_) y = *y_ > c.above_y;
    switch (c.form) {
      case 0:
        return x;
      case 1:
        return y;
      case 2:
        if (x == false || y == false) return false;
        return x && y ? std::optional(true) : std::nullopt;
      case 3:
        if (x == true || y == true) return true;
        return x && y ? std::optional(false) : std::nullopt;
      default:
        return x ? std::optional(!*x) : std::nullopt;
    }
  }

  void start_command(State& state, unsigned actuator) {
    say("command", kActuatorNames[actuator] + " " + std::to_string(state.queue[actuator].front()));
    state.ends[actuator] = now_ + state.queue[actuator].front();
  }

  void finish_commands() {
    for (std::size_t r = 0; r < rules_.size(); ++r) {
      State& state = state_[r];
      if (!state.running) continue;
      for (auto& [actuator, lengths] : state.queue) {
        if (lengths.empty() || state.ends[actuator] != now_) continue;
        say("done", kActuatorNames[actuator]);
        lengths.erase(lengths.begin());
        if (!lengths.empty()) start_command(state, actuator);
      }
      const bool all = std::all_of(state.queue.begin(), state.queue.end(),
                                   [](const auto& entry) { return entry.second.empty(); });
      if (!all) continue;
      say("finished", "r" + std::to_string(r));
      state.running.reset();
    }
  }

  static std::set<unsigned> actuators_of(const std::vector<Step>& steps) {
    std::set<unsigned> set;
    for (const Step& step : steps)
      set.insert(step.actuator);
    return set;
  }
  const std::vector<Step>& steps_of(std::size_t rule, bool side) const {
    return side ? rules_[rule].then : rules_[rule].otherwise;
  }

  void interrupt(std::size_t rule) {
    State& state = state_[rule];
    say("interrupt", "r" + std::to_string(rule));
    for (const unsigned actuator : actuators_of(steps_of(rule, *state.running)))
      say("cancel", kActuatorNames[actuator]);
    state.running.reset();
    state.queue.clear();
    state.ends.clear();
  }

  void react() {
    std::vector<std::pair<std::size_t, bool>> fired;
    for (std::size_t r = 0; r < rules_.size(); ++r) {
      State& state = state_[r];
      state.won = false;
      const std::optional<bool> value = truth(rules_[r].condition);
      if (!value || state.truth == value) continue;
      state.truth = value;
      if (*value || !rules_[r].otherwise.empty()) fired.emplace_back(r, *value);
    }
    for (const auto& [r, side] : fired)
      say("fire", "r" + std::to_string(r) + (side ? " DO" : " ELSE"));
    for (const auto& [r, side] : fired)
      serve(r, side);
  }

  void serve(std::size_t rule, bool side) {
    const std::string name = "r" + std::to_string(rule) + (side ? " DO" : " ELSE");
    State& own = state_[rule];
    if (own.running == side) return say("lose", name);
    if (own.running) interrupt(rule);
    const std::set<unsigned> wanted = actuators_of(steps_of(rule, side));
    std::vector<std::size_t> owners;
    for (std::size_t other = 0; other < rules_.size(); ++other) {
      if (!state_[other].running) continue;
      const std::set<unsigned> held = actuators_of(steps_of(other, *state_[other].running));
      const bool shared =
          std::any_of(wanted.begin(), wanted.end(), [&](unsigned a) { return held.count(a) != 0; });
      if (!shared) continue;
      if (rules_[other].behavior < rules_[rule].behavior || state_[other].won)
        return say("lose", name);
      owners.push_back(other);
    }
    for (const std::size_t owner : owners)
      interrupt(owner);
    say("win", name);
    own.running = side;
    own.won = true;
    own.queue.clear();
    for (const Step& step : steps_of(rule, side))
      own.queue[step.actuator].push_back(step.length_ms);
    for (const auto& entry : own.queue)
      start_command(own, entry.first);
  }

  std::vector<Rule> rules_;
  std::vector<State> state_;
  std::optional<int> x_;
  std::optional<int> y_;
  int now_ = 0;
  std::vector<std::string> lines_;
};

// --- the runtime's trace in the same words ---

// "120 #3 command a MOVE for_=0.031" → "120 command a 31"; nothing for what the model does not say.
std::optional<std::string> in_model_words(const std::string& line) {
  const std::string time = line.substr(0, line.find(' '));
  const std::size_t event_begin = line.find(' ', line.find('#')) + 1;
  const std::size_t event_end = line.find(' ', event_begin);
  if (event_end == std::string::npos) return std::nullopt;
  const std::string event = line.substr(event_begin, event_end - event_begin);
  std::string rest = line.substr(event_end + 1);
  if (event == "input") return std::nullopt;
  if (event == "command") {
    const std::size_t number = rest.find('=') + 1;
    const int ms = static_cast<int>(std::stod(rest.substr(number)) * 1000 + 0.5);
    rest = rest.substr(0, 1) + " " + std::to_string(ms);
  }
  if (event == "lose") rest = rest.substr(0, rest.find(" to"));
  if (event == "interrupt") rest = rest.substr(0, rest.find(" by"));
  return time + " " + event + " " + rest;
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

TEST_CASE("random robots do what a naive reading of the language says") {
  std::size_t lines_compared = 0;
  const bool holds = rc::check("runtime against the naive interpreter", [&] {
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
    std::map<int, std::vector<std::string>> actual;
    for (const std::string& line : robot.lines())
      if (const auto words = in_model_words(line)) actual[std::stoi(*words)].push_back(*words);

    Naive naive(rules);
    for (int now = 0; now <= end; ++now) {
      std::vector<Feed> due;
      std::copy_if(feeds.begin(), feeds.end(), std::back_inserter(due),
                   [&](const Feed& feed) { return feed.at_ms == now; });
      std::vector<std::string> expected = naive.tick(now, due);
      std::vector<std::string>& seen = actual[now];
      // Cancels and commands of one tick go by rank; their order is in the golden traces.
      std::sort(expected.begin(), expected.end());
      std::sort(seen.begin(), seen.end());
      RC_ASSERT(seen == expected);
      lines_compared += seen.size();
    }
  });
  CHECK(holds);
  CHECK(lines_compared > 1000);
}
