#include "tests/analysis/simulation.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace robosync::test {
namespace {

constexpr Time kNever = std::numeric_limits<Time>::max();

// One release that waits for its step.
struct Job {
  std::size_t source = 0;
  Time released = 0;
  Time sampling = 0;  // still to do
};

class Simulation {
public:
  Simulation(const analysis::TaskSet& set, const Pattern& pattern, Time horizon,
             std::mt19937& random)
      : set_(set),
        pattern_(pattern),
        horizon_(horizon),
        random_(random),
        next_(pattern.first),
        interference_next_(pattern.interference_first),
        was_true_(set.firings.size()),
        may_fire_(set.firings.size()),
        may_win_(set.firings.size()),
        worst_(set.sources.size()) {}

  std::vector<Time> run() {
    release();
    while (now_ < horizon_ || busy()) {
      if (!work()) {
        now_ = std::max(now_ + 1, next_event());
        if (now_ >= horizon_) break;
      }
      release();
    }
    return worst_;
  }

private:
  bool busy() const {
    return interference_ > 0 || in_step_ || !sampling_.empty() || !announced_.empty();
  }

  Time next_event() const {
    Time next = kNever;
    for (const Time time : next_)
      next = std::min(next, time);
    for (const Time time : interference_next_)
      next = std::min(next, time);
    return next < horizon_ ? next : kNever;
  }

  Time pause(Time period) {
    if (pattern_.laziness <= 0) return period;
    std::uniform_real_distribution<double> draw(0, pattern_.laziness);
    return period + static_cast<Time>(static_cast<double>(period) * draw(random_));
  }

  void release() {
    for (std::size_t j = 0; j < set_.sources.size(); ++j) {
      const analysis::Source& source = set_.sources[j];
      if (next_[j] > now_ || next_[j] >= horizon_) continue;
      const Job job{j, next_[j], source.sample};
      (source.sample == 0 && source.rank == 0 ? announced_ : sampling_).push_back(job);
      next_[j] =
          source.follows == analysis::Source::kNone ? next_[j] + pause(source.period) : kNever;
    }
    for (std::size_t i = 0; i < set_.interferences.size(); ++i) {
      if (interference_next_[i] > now_ || interference_next_[i] >= horizon_) continue;
      interference_ += set_.interferences[i].cost;
      interference_next_[i] += pause(set_.interferences[i].period);
    }
  }

  // Does something until it is done or something is released. False: there is nothing to do.
  bool work() {
    if (lock_ > 0) return spend(lock_);
    if (interference_ > 0) return spend(interference_);
    if (!in_step_ && !announced_.empty()) latch();
    Job* const next = next_sampling();
    if (in_step_ && (next == nullptr || step_done_ < pattern_.behaviors_begin)) return go_on();
    if (next != nullptr) {
      spend(next->sampling);
      if (next->sampling == 0) announce(next);
      return true;
    }
    if (!pattern_.locks || locked_at_ == now_ || set_.longest_lock == 0) return false;
    locked_at_ = now_;
    lock_ = set_.longest_lock;
    // It is entered at the last moment before the next release.
    now_ = std::max(now_, std::min(next_event(), horizon_) - 1);
    return true;
  }

  // A lock holds off all others, so nobody looks at the clock before it ends.
  bool spend(Time& left) {
    const Time until = &left == &lock_ ? kNever : next_event();
    const Time part = std::min(left, until - now_);
    left -= part;
    now_ += part;
    return true;
  }

  bool go_on() {
    Time until = next_event();
    if (step_done_ < pattern_.behaviors_begin)
      until = std::min(until, now_ + pattern_.behaviors_begin - step_done_);
    const Time part = std::min(step_left_, until - now_);
    step_left_ -= part;
    step_done_ += part;
    now_ += part;
    if (step_left_ == 0) end_step();
    return true;
  }

  // Who may sample now, the highest.
  Job* next_sampling() {
    Job* best = nullptr;
    for (Job& job : sampling_) {
      const analysis::Source& source = set_.sources[job.source];
      if (in_step_ && !source.outranks_a_behavior) continue;
      if (best == nullptr || source.rank < set_.sources[best->source].rank) best = &job;
    }
    return best;
  }

  void announce(Job* job) {
    announced_.push_back(*job);
    sampling_.erase(sampling_.begin() + (job - sampling_.data()));
  }

  void latch() {
    step_.swap(announced_);
    announced_.clear();
    in_step_ = true;
    step_done_ = 0;
    step_left_ = 0;
    for (const Job& job : step_) {
      step_left_ += set_.sources[job.source].step;
      for (std::size_t j = 0; j < set_.sources.size(); ++j)
        if (set_.sources[j].follows == job.source)
          next_[j] =
              std::min(next_[j], now_ + std::min(pattern_.follow_delay, set_.sources[j].delay));
    }
    fire();
  }

  // Of a choice, one that is drawn may be true; of a contest, one that is drawn wins.
  void fire() {
    const std::size_t favorite = random_();
    std::map<std::size_t, std::vector<std::size_t>> choices;
    for (std::size_t r = 0; r < set_.firings.size(); ++r)
      if (evaluated(r))
        choices[std::min(set_.firings[r].choice, set_.firings.size() + r)].push_back(r);
    std::map<std::size_t, std::vector<std::size_t>> contests;
    for (const auto& [choice, rules] : choices)
      for (std::size_t i = 0; i < rules.size(); ++i)
        if (fires(rules[i], i == favorite % rules.size()))
          contests[std::min(set_.firings[rules[i]].contest, set_.firings.size() + rules[i])]
              .push_back(rules[i]);
    for (const auto& [contest, rules] : contests)
      for (std::size_t i = 0; i < rules.size(); ++i) {
        const analysis::Firing& rule = set_.firings[rules[i]];
        const bool wins = i == favorite % rules.size();
        step_left_ += wins ? rule.cost : set_.lost;
        may_fire_[rules[i]] = now_ + rule.gap;
        if (wins) may_win_[rules[i]] = now_ + rule.cooldown;
      }
  }

  bool evaluated(std::size_t r) const {
    const analysis::Firing& rule = set_.firings[r];
    return std::ranges::any_of(step_, [&](const Job& job) {
      return std::ranges::find(rule.sources, job.source) != rule.sources.end();
    });
  }

  // Who cools down, or has not held for long enough, does not fire.
  bool fires(std::size_t r, bool may) {
    return is_triggered(r, may) && now_ >= may_fire_[r] && now_ >= may_win_[r];
  }

  bool is_triggered(std::size_t r, bool may) {
    const bool is = may && std::uniform_real_distribution<double>(0, 1)(random_) < pattern_.truth;
    if (!set_.firings[r].alternates) return is;
    const bool was = was_true_[r];
    was_true_[r] = is && !(pattern_.truth >= 1 && was);
    return is && !was;
  }

  void end_step() {
    in_step_ = false;
    for (const Job& job : step_)
      worst_[job.source] = std::max(worst_[job.source], now_ - job.released);
    step_.clear();
  }

  const analysis::TaskSet& set_;
  const Pattern& pattern_;
  Time horizon_;
  std::mt19937& random_;
  Time now_ = 0;
  std::vector<Time> next_, interference_next_;
  std::vector<Job> sampling_, announced_, step_;
  Time interference_ = 0;
  Time lock_ = 0;
  Time locked_at_ = kNever;
  bool in_step_ = false;
  Time step_left_ = 0, step_done_ = 0;
  std::vector<bool> was_true_;
  std::vector<Time> may_fire_, may_win_;  // from when on
  std::vector<Time> worst_;
};

}  // namespace

std::vector<Time> simulate(const analysis::TaskSet& set, const Pattern& pattern, Time horizon,
                           std::mt19937& random) {
  return Simulation(set, pattern, horizon, random).run();
}

}  // namespace robosync::test
