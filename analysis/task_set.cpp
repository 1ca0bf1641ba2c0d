// See task_set.hpp. docs/timing.md lists what is known of each source, and what is assumed where
// nothing is known.
#include "analysis/task_set.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "analysis/bus_load.hpp"
#include "analysis/costs.hpp"
#include "analysis/exclusive.hpp"
#include "analysis/step_work.hpp"
#include "runtime-m4/policy/adaptation.hpp"
#include "runtime-m4/policy/link_share.hpp"
#include "runtime-m4/policy/player.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "runtime-m4/policy/threads.hpp"
#include "runtime-m4/policy/travel.hpp"
#include "vm/drivers.hpp"

namespace robosync::analysis {
namespace {

using policy::Category;

constexpr unsigned kAgeBits = 8;  // of rank_of()

// The period of what happens once: longer than any response time.
constexpr Instructions kOnce = Instructions{1} << 40;

Rules common(const Rules& a, const Rules& b) {
  Rules rules;
  std::ranges::set_intersection(a, b, std::inserter(rules, rules.end()));
  return rules;
}

class Builder {
public:
  Builder(const vm::Image& image, const policy::BoardCosts& board, ModuleCost module_cost, int cap)
      : image_(image),
        board_(board),
        module_cost_(module_cost),
        cap_(static_cast<std::int8_t>(cap)),
        work_(image) {}

  TaskSet build() {
    for (unsigned s = 0; s < image_.sensors.size(); ++s)
      vm::is_served(image_.sensors[s].driver) ? add_served(s) : add_sensor(s);
    for (unsigned r = 0; r < image_.rules.size(); ++r) {
      if (work_.pauses(r).any()) add_pauses(r);
      if (work_.begins_ms(r) != Pauses::kNever) add_beginnings(r);
      if (work_.held_ms(r) != 0 && !work_.is_safety(r)) add_held(r);
    }
    for (const Holders& holders : holders_)
      holders.rules.size() == 1 ? add_going_on(*holders.rules.begin(), holders.period_ms)
                                : add_holders(holders);
    add_fading();
    add_checks();
    add_firings();
    add_interferences();
    set_.lost = costs::kClaim;
    set_.longest_lock = longest_lock();
    return set_;
  }

private:
  // Rules whose responses have a common actuator, and pause for at least this time.
  struct Holders {
    Actuators held;
    std::uint32_t period_ms;
    Rules rules;
  };
  // In each step of the source this rule, or another one that costs no more, goes on or begins by itself.
  struct ByItself {
    unsigned rule;
    Instructions cost;
    std::size_t source;
  };

  Instructions instructions_in_ms(Instructions ms) const {
    return ms * board_.instructions_per_ms();
  }

  // --- ranks ---

  static bool reads(const vm::Image& image, unsigned b, const Inputs& channels) {
    const vm::Behavior& behavior = image.behaviors[b];
    const auto inputs = image.inputs.subspan(behavior.first_input, behavior.input_count);
    return std::ranges::any_of(inputs, [&](std::uint8_t input) { return channels.test(input); });
  }

  // For a sensor's thread with these channels; `adapted`: with all behaviours at their highest.
  policy::Standing standing_of(const Inputs& channels, bool adapted) const {
    std::int8_t priority = policy::idle_priority(image_);
    for (unsigned b = 0; b < image_.behaviors.size(); ++b) {
      if (!policy::needs(image_, b, Category::sensor, 0, reads(image_, b, channels))) continue;
      const auto base = static_cast<std::int8_t>(image_.behaviors[b].priority);
      const bool adapts = adapted && b >= policy::first_behavior(image_);
      priority = std::max(priority, adapts ? policy::ceiling(base, cap_) : base);
    }
    return policy::standing(Category::sensor, priority);
  }

  // Does it preempt the behaviour of the lowest priority?
  bool outranks_a_behavior(policy::Standing standing) const {
    if (image_.behaviors.size() <= policy::first_behavior(image_)) return false;
    const auto lowest = static_cast<std::int8_t>(image_.behaviors.back().priority);
    return standing > policy::standing(Category::behavior, lowest);
  }

  // As a number: the lower outranks; threads of the same standing rank by age, which is their order.
  static unsigned rank_of(policy::Standing standing, unsigned order) {
    return (policy::standing(Category::safety, std::int8_t{0}) - standing) << kAgeBits | order;
  }

  void place(Source& source, unsigned sensor) const {
    const unsigned thread = policy::thread_of(image_, sensor);
    Inputs channels;
    policy::each_channel_of_thread(image_, thread, [&](unsigned c) { channels.set(c); });
    const policy::Standing base = standing_of(channels, false);
    const policy::Standing raised = standing_of(channels, true);
    source.rank = rank_of(base, thread);
    source.raised = raised == base ? source.rank : rank_of(raised, 0);
    source.outranks_a_behavior = outranks_a_behavior(base);
    source.may_outrank_one = outranks_a_behavior(raised);
  }

  static Inputs channels_of(const vm::Sensor& sensor) {
    Inputs channels;
    for (unsigned i = 0; i < sensor.channel_count; ++i)
      channels.set(sensor.first_channel + i);
    return channels;
  }

  // --- sources ---

  void add_sensor(unsigned s) {
    const vm::Sensor& sensor = image_.sensors[s];
    source_of_sensor_.push_back(set_.sources.size());
    const Inputs channels = channels_of(sensor);
    const Inputs changed = work_.with_bands(channels);
    const Rules rules = work_.concerned(changed);
    Source source;
    source.name = image_.string(sensor.name);
    source.period =
        instructions_in_ms(policy::is_fed(sensor) ? kFedPeriodMs : std::uint32_t{sensor.period_ms});
    if (policy::is_algorithm(sensor)) {
      source.sample = Instructions{board_.wake_by_timer} + costs::kAlgorithm +
                      (sensor.channel_count - Instructions{1}) * costs::kChannel;
      source.follows = sampled_input_of(sensor);
    } else if (!policy::is_fed(sensor))
      source.sample =
          board_.wake_by_timer + policy::sample_cost(image_, sensor, board_) +
          (sensor.channel_count - Instructions{1}) * costs::kChannel;  // the first is in the step
    if (const Instructions asking = cost_of_asking(sensor); asking != 0) {
      const std::size_t asked = add_asking(sensor, s, asking, source.period);
      if (vm::is_by_echo(sensor.driver)) {
        source.measuring = instructions_in_ms(policy::kEchoMs);
      } else {
        source.follows = asked;
        source.early = instructions_in_ms(board_.bus_ahead_ms);
        source.delay = instructions_in_ms(answered_in_us(image_, board_, sensor)) / 1000;
      }
    }
    if (const Instructions measuring = time_of_measuring(sensor, source.period); measuring != 0)
      source.measuring = measuring;
    if ((channels & work_.watched()).any()) source.sample += board_.wake + looks() + work_.trips();
    source.step = work_.step(rules, changed);
    place(source, s);
    const Rules fire = work_.stirred(rules, changed);
    for (unsigned a = 0; a < image_.actuators.size(); ++a)
      if ((work_.actuators(fire) >> a & 1) != 0)
        source.actuators.emplace_back(image_.string(image_.actuators[a].name));
    add_with_followers(std::move(source), rules, fire, work_.sets(fire));
  }

  // How long before its sample the measurement began, if that is a period or more; else 0.
  static Instructions time_of_measuring(const vm::Sensor& sensor, Instructions period) {
    // With the sample before.
    if (vm::measures_when_told(sensor.driver)) return period;
    // Its block of sound ended half a period before, or later, and is as long as a period.
    if (vm::is_microphone(sensor.driver)) return period + period / 2;
    // With the sample before, and the result is given twice.
    return vm::is_board_part(sensor.driver) ? 2 * period : 0;
  }

  // Nothing reads it, so its thread ranks below everything that behaviours need.
  void add_served(unsigned s) {
    source_of_sensor_.push_back(set_.sources.size());
    const vm::Sensor& sensor = image_.sensors[s];
    const auto servos = std::ranges::count_if(image_.actuators, [&](const vm::Actuator& actuator) {
      return vm::drives_channel(actuator.driver) && actuator.bus == s;
    });
    Source source;
    source.name = image_.string(sensor.name);
    source.period = instructions_in_ms(std::uint32_t{sensor.period_ms});
    source.sample = board_.wake_by_timer +
                    (vm::is_display(sensor.driver)
                         ? policy::display_frame_cost(board_)
                         : policy::frame_cost(static_cast<std::uint32_t>(servos), board_));
    place(source, s);
    set_.sources.push_back(std::move(source));
  }

  // Its bus works on its own, from a tick before the sample, and is waited for; or an echo is under way, and the sample is
  // taken when it is due, whether the echo is there or not (layers/sensor.cpp). 0: it is not asked.
  Instructions cost_of_asking(const vm::Sensor& sensor) const {
    if (policy::is_fed(sensor)) return 0;
    if (vm::is_by_echo(sensor.driver)) return board_.ping;
    return sensor.channel_count * Instructions{policy::ask_cost(sensor.driver, board_)};
  }

  // The cost arises in its thread, and in the interrupts of its bus or its pin.
  std::size_t add_asking(const vm::Sensor& sensor, unsigned s, Instructions cost,
                         Instructions period) {
    Source source;
    source.name = fmt::format("asking for {}", image_.string(sensor.name));
    source.period = period;
    source.sample = board_.wake_by_timer + cost;
    place(source, s);
    set_.sources.push_back(std::move(source));
    source_of_sensor_.back() = set_.sources.size();
    return set_.sources.size() - 1;
  }

  // An algorithm is released by the sampling of its input or, if the input is fed, by its own period.
  std::size_t sampled_input_of(const vm::Sensor& algorithm) const {
    const unsigned input = policy::input_of(image_, algorithm);
    return policy::is_fed(image_.sensors[input]) ? Source::kNone : source_of_sensor_[input];
  }

  // Due on its own, in the step thread. Returns which source it is.
  std::size_t add_timed(std::string name, std::uint32_t period_ms, const Rules& rules,
                        const Inputs& changed, const Rules& fire, const Inputs& set) {
    Source source;
    source.name = std::move(name);
    source.period = instructions_in_ms(period_ms);
    source.step = work_.step(rules, changed);
    source.outranks_a_behavior = true;
    source.may_outrank_one = true;
    const std::size_t added = set_.sources.size();
    add_with_followers(std::move(source), rules, fire, set);
    return added;
  }

  // A time word of a SAFETY rule may require one more look after each.
  Instructions looks() const {
    const unsigned rules =
        image_.has_safety() ? image_.behaviors[vm::kSafetyBehavior].rule_count : 0;
    for (unsigned r = 0; r < rules; ++r)
      if (work_.is_timed(r)) return 2 * work_.look() + board_.wake_by_timer;
    return work_.look();
  }

  // A step may cause others, each a millisecond later: what it sets changes, and a rule with a word
  // that was true for one step is evaluated again. Each rule answers a reading once, also by way of
  // others: repeated answers are not looked for.
  void add_with_followers(Source source, const Rules& evaluated_in_it, const Rules& fired,
                          Inputs set) {
    Source follower;
    follower.name = fmt::format("what follows {}", source.name);
    follower.period = source.period;
    follower.delay = instructions_in_ms(1);
    follower.outranks_a_behavior = true;
    follower.may_outrank_one = true;
    add(std::move(source), fired);
    Rules seen = fired;
    Rules before = common(evaluated_in_it, fired);
    for (std::size_t level = 0; level <= image_.rules.size() + 1; ++level) {
      const Inputs changed = work_.with_bands(set);
      Rules evaluated = work_.concerned(changed);
      Rules fire = work_.stirred(evaluated, changed);
      std::erase_if(fire, [&](unsigned rule) { return seen.contains(rule); });
      seen.insert(fire.begin(), fire.end());
      for (const unsigned rule : before)
        if (work_.has_events(rule)) {
          evaluated.insert(rule);
          if (work_.fires_after_event(rule)) fire.insert(rule);
        }
      if (evaluated.empty() && changed.none()) return;
      follower.step = work_.step(evaluated, changed);
      follower.follows = set_.sources.size() - 1;
      add(follower, fire);
      set = work_.sets(fire);
      before = std::move(fire);
    }
  }

  // `fired`: the rules that may fire in its steps.
  void add(Source source, const Rules& fired) {
    for (const unsigned rule : fired)
      triggered_by_[rule].push_back(set_.sources.size());
    set_.sources.push_back(std::move(source));
  }

  // Starts of responses, of which a step may have only some; and responses that go on.
  void add_firings() {
    std::vector<unsigned> rules;
    for (const auto& [rule, sources] : triggered_by_) {
      if (sources.empty() || work_.firing(rule) == 0) continue;
      rules.push_back(rule);
      set_.firings.push_back({name_of(rule), work_.firing(rule), work_.alternates(rule), sources,
                              instructions_in_ms(work_.gap_ms(rule)),
                              instructions_in_ms(work_.cooldown_ms(rule))});
    }
    group(rules);
    for (const ByItself& one : by_itself_)
      set_.firings.push_back({name_of(one.rule), one.cost, false, {one.source}});
  }

  // Which of the firings so far, those of `rules`, exclude each other, and which want the same
  // actuator.
  void group(const std::vector<unsigned>& rules) {
    std::vector<Needs> needs;
    needs.reserve(rules.size());
    for (const unsigned rule : rules) {
      needs.push_back(
          needs_of(image_, image_.behaviors[work_.behavior_of(rule)], image_.rules[rule]));
    }
    put_together(&Firing::choice, [&](std::size_t a, std::size_t b) {
      return exclude_each_other(needs[a], needs[b]);
    });
    // A choice is in a contest as a whole or not at all, so counting the most expensive first is the worst case.
    const std::vector<std::vector<std::size_t>> choices = choices_of(rules.size());
    const auto all_contend = [&](std::size_t a, std::size_t b) {
      return std::ranges::all_of(choices[a], [&](std::size_t x) {
        return std::ranges::all_of(
            choices[b], [&](std::size_t y) { return work_.contend(rules[x], rules[y]); });
      });
    };
    std::map<std::pair<std::size_t, std::size_t>, bool> known;  // a choice has many firings
    put_together(&Firing::contest, [&](std::size_t a, std::size_t b) {
      const std::pair pair(choice_of(a), choice_of(b));
      if (pair.first == pair.second) return true;
      const auto found = known.find(pair);
      if (found != known.end()) return found->second;
      return known[pair] = all_contend(pair.first, pair.second);
    });
  }

  // A firing without a choice counts as a choice of its own.
  std::size_t choice_of(std::size_t firing) const {
    const std::size_t choice = set_.firings[firing].choice;
    return choice == Firing::kNone ? firing : choice;
  }

  // The firings of each choice, indexed by its number.
  std::vector<std::vector<std::size_t>> choices_of(std::size_t firings) const {
    std::vector<std::vector<std::size_t>> choices(firings);
    for (std::size_t i = 0; i < firings; ++i)
      choices[choice_of(i)].push_back(i);
    return choices;
  }

  // Groups each with the first others that go together with it and with each other.
  template <class Together>
  void put_together(std::size_t Firing::*which, Together together) {
    for (std::size_t first = 0; first < set_.firings.size(); ++first) {
      if (set_.firings[first].*which != Firing::kNone) continue;
      std::vector<std::size_t> members{first};
      for (std::size_t i = first + 1; i < set_.firings.size(); ++i)
        if (set_.firings[i].*which == Firing::kNone &&
            std::ranges::all_of(members, [&](std::size_t m) { return together(m, i); }))
          members.push_back(i);
      if (members.size() == 1) continue;
      for (const std::size_t member : members)
        set_.firings[member].*which = first;
    }
  }

  std::string name_of(unsigned rule) const {
    if (image_.rules[rule].line != 0)
      return fmt::format("the rule at line {}", image_.rules[rule].line);
    const auto name = image_.string(image_.behaviors[work_.behavior_of(rule)].name);
    return fmt::format("rule {} of the module's {}", rule, name);
  }

  // A FOR of the rule is over, or a TIMER has come as far as the rule asks.
  void add_held(unsigned r) {
    const bool fires = image_.rules[r].then_response != vm::kNoIndex;
    add_timed(fmt::format("{}, FOR or TIMER", name_of(r)), work_.held_ms(r), {r}, {},
              fires ? Rules{r} : Rules{}, work_.sets({r}));
  }

  void add_pauses(unsigned r) {
    const Pauses& pauses = work_.pauses(r);
    const bool apart = pauses.better_apart();
    if (!apart)
      join_holders(r, pauses.least_ms);
    else if (pauses.others_ms != Pauses::kNever)
      add_going_on(r, pauses.others_ms);
    for (unsigned i = 0; apart && i < pauses.at_once; ++i)
      add_going_on(r, pauses.again_ms);
    const bool often = !apart || pauses.again_ms <= policy::kLeastPauseMs;
    if (often && set_.short_wait == TaskSet::kNoWait) set_.short_wait = pauses.line;
  }

  // A response holds its actuators while it pauses. So, of responses with a common actuator, one pauses at a time, and all
  // together go on as often as one does.
  void join_holders(unsigned r, std::uint32_t period_ms) {
    const Actuators held = work_.held_while_pausing(r);
    const auto joined = std::ranges::find_if(holders_, [&](const Holders& holders) {
      return holders.period_ms == period_ms && (holders.held & held) != 0;
    });
    if (joined == holders_.end()) {
      holders_.push_back({held, period_ms, {r}});
      return;
    }
    joined->held &= held;
    joined->rules.insert(r);
  }

  // One that goes on may start another, so none of them counts as fired.
  void add_holders(const Holders& holders) {
    Inputs set;
    for (const unsigned rule : holders.rules)
      set |= work_.later_sets(rule);
    const auto actuator = static_cast<unsigned>(std::countr_zero(holders.held));
    const std::string_view name = image_.string(image_.actuators[actuator].name);
    const std::size_t source =
        add_timed(fmt::format("responses that hold {}", name), holders.period_ms, {}, {}, {}, set);
    const unsigned worst = *std::ranges::max_element(
        holders.rules, {}, [this](unsigned rule) { return work_.going_on(rule); });
    by_itself_.push_back({worst, work_.going_on(worst), source});
  }

  // A response that goes on evaluates no condition.
  void add_going_on(unsigned r, std::uint32_t period_ms) {
    add_by_itself(r, "after a pause", period_ms, {}, work_.later_sets(r), work_.going_on(r));
  }

  // Its response begins without a trigger from outside.
  void add_beginnings(unsigned r) {
    const bool evaluated = image_.rules[r].kind == vm::RuleKind::every;
    add_by_itself(r, "by itself", work_.begins_ms(r), evaluated ? Rules{r} : Rules{},
                  work_.sets({r}), work_.firing(r));
  }

  void add_by_itself(unsigned r, std::string_view how, std::uint32_t period_ms,
                     const Rules& evaluated, const Inputs& set, Instructions cost) {
    const std::size_t source =
        add_timed(fmt::format("{}, {}", name_of(r), how), period_ms, evaluated, {}, {r}, set);
    std::erase(triggered_by_[r], source);  // what is known of triggers does not apply
    by_itself_.push_back({r, cost, source});
  }

  void add_fading() {
    Inputs fading;
    for (unsigned v = 0; v < image_.variables.size(); ++v)
      if (image_.variables[v].fade != 0) fading.set(image_.channels.size() + v);
    if (fading.none()) return;
    const Inputs changed = work_.with_bands(fading);
    const Rules rules = work_.concerned(changed);
    add_timed("feelings that fade", vm::kFadeTickMs, rules, changed, work_.stirred(rules, changed),
              work_.sets(work_.stirred(rules, changed)));
  }

  void add_checks() {
    for (const vm::Check& check : image_.checks) {
      if (check.window <= 1) continue;
      Inputs band;
      band.set(image_.channels.size() + check.variable);
      const Rules rules = work_.concerned(band);
      const vm::Variable& variable = image_.variables[check.variable];
      add_timed(fmt::format("samples of {}", image_.string(variable.name)),
                policy::sample_period_ms(check), rules, band, work_.stirred(rules, band),
                work_.sets(work_.stirred(rules, band)));
    }
  }

  // --- what outranks the sources ---

  // A transfer of another sensor on the bus, which no sensor preempts; or a trace message.
  Instructions longest_lock() const {
    Instructions longest = 0;
    unsigned on_bus = 0;
    for (const vm::Sensor& sensor : image_.sensors) {
      const Instructions transfer = policy::is_fed(sensor) || vm::is_microphone(sensor.driver) ||
                                            vm::counts_edges(sensor.driver)
                                        ? 0  // it holds no bus
                                        : policy::sample_cost(sensor.driver, board_);
      on_bus += transfer != 0 ? 1 : 0;
      longest = std::max(longest, transfer);
    }
    return costs::kLongestLock + (on_bus > 1 ? longest : 0);
  }

  bool any_actuator(bool (*is)(vm::DriverId)) const {
    return std::ranges::any_of(image_.actuators,
                               [is](const vm::Actuator& actuator) { return is(actuator.driver); });
  }

  // Lights and sound players, which a board sends their orders besides its pins.
  void add_parts_that_are_told() {
    const Instructions period = instructions_in_ms(policy::kSafetyPeriodMs);
    if (any_actuator(vm::drives_lights))
      set_.interferences.push_back({"the lights", instructions_in_ms(policy::kRowMs), board_.row});
    if (any_actuator(vm::drives_player))
      set_.interferences.push_back(
          {"the sound player", instructions_in_ms(policy::kPlayerGapMs), board_.say});
    if (any_actuator(vm::is_strip))
      set_.interferences.push_back({"the strip of lights", period, board_.strip});
    else if (any_actuator(vm::drives_panel))
      set_.interferences.push_back({"the panel", period, board_.panel});
  }

  // All the edges that the board counts in a period may come at once.
  void add_edges() {
    if (board_.edge == 0) return;
    for (const vm::Sensor& sensor : image_.sensors)
      if (vm::counts_edges(sensor.driver))
        set_.interferences.push_back(
            {fmt::format("the edges of {}", image_.string(sensor.name)),
             instructions_in_ms(std::uint32_t{sensor.period_ms}),
             Instructions{board_.edge} * policy::most_edges(sensor.period_ms)});
  }

  void add_interferences() {
    const Instructions period = instructions_in_ms(policy::kSafetyPeriodMs);
    add_edges();
    set_.interferences.push_back(
        {"the tick", instructions_in_ms(1), Instructions{board_.tick} + board_.switch_threads});
    set_.interferences.push_back({"the serial line",
                                  instructions_in_ms(1000) / board_.line_bytes_per_second,
                                  Instructions{board_.receive} + board_.send});
    add_parts_that_are_told();
    set_.interferences.push_back(
        {"the safety thread", period, board_.wake_by_timer + costs::kMonitor + looks()});
    if (work_.trips() != 0)
      set_.interferences.push_back({"SAFETY rules that trip by time alone",
                                    instructions_in_ms(kTripPeriodMs), work_.trips()});
    for (const vm::Adaptation& adaptation : image_.adaptations)
      set_.interferences.push_back(
          {"priorities that adapt", instructions_in_ms(adaptation.window_ms),
           costs::kRank * (image_.behaviors.size() - policy::first_behavior(image_))});
    // By its category a module outranks sensors of its priority: it counts as if it outranked all.
    for (const vm::Sensor& sensor : image_.sensors)
      if (policy::is_algorithm(sensor))
        set_.interferences.push_back({fmt::format("the module of {}", image_.string(sensor.name)),
                                      instructions_in_ms(sensor.period_ms),
                                      Instructions{board_.wake} + module_cost_(image_, sensor)});
    for (const vm::Behavior& behavior : image_.behaviors.subspan(policy::first_behavior(image_)))
      commanded_ |= behavior.actuators;
    // Its next setpoint; or its command is done, and the next one in its queue begins.
    for (unsigned a = 0; a < image_.actuators.size(); ++a) {
      if ((commanded_ >> a & 1) == 0) continue;
      const policy::ActuatorCosts driver = policy::actuator_costs(image_, a);
      set_.interferences.push_back({std::string(image_.string(image_.actuators[a].name)),
                                    instructions_in_ms(policy::shortest_setpoint_ms(image_, a)),
                                    costs::kService + driver.advance + driver.start});
    }
  }

  const vm::Image& image_;
  const policy::BoardCosts& board_;
  ModuleCost module_cost_;
  std::int8_t cap_;
  StepWork work_;
  TaskSet set_;
  std::map<unsigned, std::vector<std::size_t>>
      triggered_by_;  // by rule: the sources whose steps may trigger it
  std::vector<Holders> holders_;
  std::vector<ByItself> by_itself_;
  std::vector<std::size_t> source_of_sensor_;
  Actuators commanded_ = 0;
};

// May the program keep the link's thread, which ranks below all of it, from the processor for this long?
bool may_keep_waiting(const TaskSet& set, Priorities priorities, Instructions time) {
  TaskSet with_link = set;
  Source link;
  link.name = "the link";
  link.period = kOnce;
  link.sample = 1;
  link.rank = std::numeric_limits<unsigned>::max();
  with_link.sources.push_back(link);
  const ResponseTime response = response_time_of(with_link, set.sources.size(), priorities);
  return !response.bounded || response.time >= time;
}

// The step thread waits for the link if the link got nothing for its patience. Its turns take a fixed part of the time, and one
// that has just begun may have the full length.
void add_link(TaskSet& set, const vm::Image& image, Instructions ms, Priorities priorities) {
  const std::uint32_t patience_us = policy::link_patience_us(image.header->step_cost);
  const std::uint32_t known_us =
      patience_us - std::min(patience_us, 1000U);  // patience is counted in ticks
  if (!may_keep_waiting(set, priorities, ms * known_us / 1000)) return;
  set.interferences.push_back({"the link's turns", ms, ceil_div(ms, policy::kLinkParts)});
  set.interferences.push_back({"a long turn of the link", kOnce, policy::kLinkTurnMs * ms});
  settle(set, priorities);
}

}  // namespace

TaskSet task_set_of(const vm::Image& image, const policy::BoardCosts& board, ModuleCost module_cost,
                    int cap) {
  const Priorities priorities = cap > 0 ? Priorities::adapted : Priorities::base;
  TaskSet set = Builder(image, board, module_cost, cap).build();
  settle(set, priorities);
  add_link(set, image, board.instructions_per_ms(), priorities);
  return set;
}

}  // namespace robosync::analysis
