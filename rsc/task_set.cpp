// See task_set.hpp. What is known of each source, and what is supposed where nothing is known,
// stands in docs/timing.md.
#include "rsc/task_set.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "rsc/response_costs.hpp"
#include "rsc/step_work.hpp"
#include "runtime-m4/safety/period.hpp"

namespace robosync::tool {
namespace {

constexpr Instructions milliseconds(Instructions ms) {
  return ms * costs::kPerMillisecond;
}

bool is_fed(const vm::Sensor& sensor) {
  return sensor.period_ms == 0 || sensor.driver == vm::DriverId::virtual_sensor;
}

Instructions read_cost(vm::DriverId driver) {
  switch (driver) {
    case vm::DriverId::max34451:
      return costs::kReadMax34451;
    case vm::DriverId::i2c_register:
      return costs::kReadI2cWord;
    default:
      return 0;
  }
}

class Builder {
public:
  Builder(const vm::Image& image, int cap) : image_(image), cap_(cap), work_(image) {}

  TaskSet build() {
    for (unsigned s = 0; s < image_.sensors.size(); ++s)
      add_sensor(s);
    for (unsigned r = 0; r < image_.rules.size(); ++r)
      if (work_.period_ms(r) != 0) add_rule(r);
    add_fading();
    add_checks();
    add_firings();
    add_interferences();
    set_.longest_lock = costs::kLongestLock;
    return set_;
  }

private:
  // --- priorities: as runtime-m4/layers/program.cpp has them ---

  unsigned first_behavior() const { return image_.has_safety() ? vm::kSafetyBehavior + 1U : 0; }
  int lowest_priority() const { return image_.behaviors.back().priority; }

  // Of the most important behaviour that reads the sensor; none of them: below all.
  int priority_of(const Inputs& channels, bool raised) const {
    int priority = image_.behaviors.empty() ? 0 : lowest_priority() - 1;
    for (unsigned b = 0; b < image_.behaviors.size(); ++b) {
      const vm::Behavior& behavior = image_.behaviors[b];
      const auto inputs = image_.inputs.subspan(behavior.first_input, behavior.input_count);
      if (std::ranges::none_of(inputs, [&](std::uint8_t input) { return channels.test(input); }))
        continue;
      const bool adapts = raised && b >= first_behavior();
      priority = std::max(priority,
                          adapts ? std::max<int>(behavior.priority, cap_) : int{behavior.priority});
    }
    return priority;
  }

  // The lower outranks; threads of one priority in the order in which they are started, and all fed
  // sensors have one thread.
  static unsigned rank_of(int priority, unsigned order) {
    constexpr int kAbove = 1000;  // any priority
    constexpr unsigned kThreads = 1000;
    return static_cast<unsigned>(kAbove - priority) * kThreads + order;
  }

  void place(Source& source, unsigned sensor, const Inputs& channels) const {
    const bool fed = is_fed(image_.sensors[sensor]);
    const unsigned order = fed ? static_cast<unsigned>(image_.sensors.size()) : sensor;
    const int base = fed ? fed_priority(false) : priority_of(channels, false);
    const int raised = fed ? fed_priority(true) : priority_of(channels, true);
    source.rank = rank_of(base, order);
    source.raised = raised == base ? source.rank : rank_of(raised, 0);
    const bool has_behavior = image_.behaviors.size() > first_behavior();
    source.outranks_a_behavior = has_behavior && base > lowest_priority();
    source.may_outrank_one = has_behavior && raised > lowest_priority();
  }

  int fed_priority(bool raised) const {
    Inputs channels;
    for (unsigned s = 0; s < image_.sensors.size(); ++s)
      if (is_fed(image_.sensors[s])) channels |= channels_of(image_.sensors[s]);
    return priority_of(channels, raised);
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
    const Inputs channels = channels_of(sensor);
    const Inputs changed = work_.with_bands(channels);
    const Rules rules = work_.concerned(changed);
    Source source;
    source.name = image_.string(sensor.name);
    source.period =
        milliseconds(is_fed(sensor) ? costs::kFedPeriodMs : std::uint32_t{sensor.period_ms});
    if (!is_fed(sensor))
      source.sample =
          costs::kWakeByTimer + sensor.channel_count * (read_cost(sensor.driver) + costs::kChannel);
    if ((channels & work_.watched()).any()) source.sample += costs::kWake + looks() + work_.trips();
    source.step = work_.step(rules, changed);
    place(source, s, channels);
    const Rules fire = work_.stirred(rules, changed);
    for (unsigned a = 0; a < image_.actuators.size(); ++a)
      if ((work_.actuators(fire) >> a & 1) != 0)
        source.actuators.emplace_back(image_.string(image_.actuators[a].name));
    add_with_followers(std::move(source), rules, fire, work_.sets(fire));
  }

  // Due by itself, in the step thread.
  void add_timed(std::string name, std::uint32_t period_ms, const Rules& rules,
                 const Inputs& changed, const Rules& fire, const Inputs& set) {
    Source source;
    source.name = std::move(name);
    source.period = milliseconds(period_ms);
    source.step = work_.step(rules, changed);
    source.outranks_a_behavior = true;
    source.may_outrank_one = true;
    by_itself_ = set_.sources.size();
    add_with_followers(std::move(source), rules, fire, set);
  }

  // A time word of a SAFETY rule may call for one look more after each.
  Instructions looks() const {
    const unsigned rules =
        image_.has_safety() ? image_.behaviors[vm::kSafetyBehavior].rule_count : 0;
    for (unsigned r = 0; r < rules; ++r)
      if (work_.is_timed(r)) return 2 * work_.look() + costs::kWakeByTimer;
    return work_.look();
  }

  // A step may make others, a millisecond later each: what it sets changes, and a time word that
  // was true for one step, or is due, wants to be looked at. Each rule answers a reading once:
  // those that set each other off for ever are told (StepWork::cyclic()), not counted.
  void add_with_followers(Source source, Rules evaluated, const Rules& fired, Inputs set) {
    Source follower;
    follower.name = fmt::format("what follows {}", source.name);
    follower.period = source.period;
    follower.outranks_a_behavior = true;
    follower.may_outrank_one = true;
    add(std::move(source), fired);
    Rules seen = fired;
    for (std::size_t round = 0; round <= image_.rules.size(); ++round) {
      const Inputs changed = work_.with_bands(set);
      Rules next = work_.concerned(changed);
      Rules fire = work_.stirred(next, changed);
      for (const unsigned rule : evaluated)
        if (work_.is_timed(rule)) {
          next.insert(rule);
          fire.insert(rule);
        }
      if (next.empty() && changed.none()) return;
      std::erase_if(fire, [&](unsigned rule) { return round > 0 && seen.contains(rule); });
      std::erase_if(next, [&](unsigned rule) { return round > 1 && seen.contains(rule); });
      if (next.empty() && round > 1) return;
      seen.insert(next.begin(), next.end());
      follower.step = work_.step(next, changed);
      follower.follows = set_.sources.size() - 1;
      add(follower, fire);
      evaluated = std::move(next);
      set = work_.sets(fire);
    }
  }

  // The rules that may fire in its steps.
  void add(Source source, const Rules& fired) {
    for (const unsigned rule : fired)
      triggered_by_[rule].push_back(set_.sources.size());
    set_.sources.push_back(std::move(source));
  }

  void add_firings() {
    for (const auto& [rule, sources] : triggered_by_)
      if (!sources.empty()) set_.firings.push_back(firing(rule, work_.alternates(rule), sources));
    for (const auto& [rule, sources] : goes_on_)
      set_.firings.push_back(firing(rule, false, sources));
  }

  Firing firing(unsigned rule, bool alternates, const std::vector<std::size_t>& sources) const {
    return {fmt::format("the rule at line {}", image_.rules[rule].line),
            work_.firing(rule),
            alternates,
            sources,
            milliseconds(work_.gap_ms(rule)),
            work_.burst(rule)};
  }

  void add_rule(unsigned r) {
    const auto line = image_.rules[r].line;
    // A response that goes on evaluates nothing.
    const bool evaluated = image_.rules[r].kind == vm::RuleKind::every;
    add_timed(fmt::format("the rule at line {}, by itself", line), work_.period_ms(r),
              evaluated ? Rules{r} : Rules{}, {}, {r},
              evaluated ? work_.sets({r}) : work_.later_sets(r));
    // What it says of triggers does not hold for what goes on.
    auto& triggers = triggered_by_[r];
    goes_on_[r].push_back(std::exchange(by_itself_, 0));
    std::erase(triggers, goes_on_[r].back());
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
                std::max<std::uint32_t>(check.sample_ms, 1), rules, band,
                work_.stirred(rules, band), work_.sets(work_.stirred(rules, band)));
    }
  }

  // --- what outranks the sources ---

  void add_interferences() {
    const Instructions period = milliseconds(robosync::safety::kPeriod / kernel::milliseconds(1));
    set_.interferences.push_back({"the tick", milliseconds(1), costs::kTick + costs::kSwitch});
    set_.interferences.push_back(
        {"the serial line", Instructions{costs::kPerMillisecond} * 1000 / costs::kBytesPerSecond,
         costs::kReceive + costs::kSend});
    set_.interferences.push_back(
        {"the safety thread", period, costs::kWakeByTimer + costs::kMonitor + looks()});
    if (work_.trips() != 0)
      set_.interferences.push_back({"SAFETY rules that trip by time alone",
                                    milliseconds(costs::kTripPeriodMs), work_.trips()});
    for (const vm::Behavior& behavior : image_.behaviors.subspan(first_behavior()))
      commanded_ |= behavior.actuators;
    // Its next setpoint, or the command that is done and the next one in its queue.
    for (unsigned a = 0; a < image_.actuators.size(); ++a)
      if ((commanded_ >> a & 1) != 0)
        set_.interferences.push_back({std::string(image_.string(image_.actuators[a].name)),
                                      milliseconds(costs::kServicePeriodMs),
                                      costs::kWakeByTimer + costs::kDone + costs::kCommand});
  }

  const vm::Image& image_;
  int cap_;
  StepWork work_;
  TaskSet set_;
  // By rule: the sources whose steps may trigger it, or let it go on.
  std::map<unsigned, std::vector<std::size_t>> triggered_by_, goes_on_;
  std::size_t by_itself_ = 0;  // the source that add_timed() has made last
  Actuators commanded_ = 0;
};

}  // namespace

TaskSet task_set_of(const vm::Image& image, int cap) {
  TaskSet set = Builder(image, cap).build();
  settle(set, cap > 0 ? Priorities::adapted : Priorities::base);
  return set;
}

}  // namespace robosync::tool
