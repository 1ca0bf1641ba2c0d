// See response_time.hpp. Fixed points of R = C + B + sum of ceil(R / T) * C, by iteration from
// below; every loop is bounded, and what does not end in time is called unbounded.
//
// Steps do not preempt steps, so besides the classic terms:
//  * A lower-ranked source may have its step under way: it blocks, once.
//  * A source that outranks a behaviour may announce while a step is under way. What it has announced
//    goes before a later reading even of a source that outranks it, so it counts as if it outranked
//    that source.
//  * All other higher-ranked sources can begin a step only until this one has begun its own.
//  * As steps are not preempted, the first release need not be the worst: every release of the busy
//    period is examined (Davis et al., Controller Area Network schedulability analysis, 2007).
#include "analysis/response_time.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace robosync::analysis {
namespace {

constexpr unsigned kMostRounds = 10'000;       // of one fixed point
constexpr Instructions kMostReleases = 1'000;  // of one busy period
constexpr Instructions kForeverLate = Instructions{1} << 40;

double share(Instructions cost, Instructions period) {
  return static_cast<double>(cost) / static_cast<double>(period);
}

// A chain of followers, up to the release of the one in question, and the time that passes besides
// work. Empty: the response of the source itself is in question.
struct Chain {
  unsigned length = 0;
  Instructions delays = 0;
};

class Analysis {
public:
  Analysis(const TaskSet& set, std::size_t mine, Priorities priorities, Chain chain = {})
      : set_(set), mine_(mine), chain_(chain), adapted_(priorities == Priorities::adapted) {
    for (std::size_t j = 0; j < set.sources.size(); ++j)
      if (j != mine && preemption_by(j) == Preemption::none)
        blocking_ = std::max(blocking_, set.sources[j].step);
    blocking_ = (blocking_ + set.longest_lock) * (chain_.length + 1);
  }

  ResponseTime solve() const {
    ResponseTime response;
    const std::optional<Instructions> busy = fixed_point([this](Instructions t) {
      return demand({t, t, own_releases(t)});
    });
    if (!busy) return response;
    response.bounded = true;
    const Instructions releases = own_releases(*busy);
    for (Instructions q = 1; q <= std::min(releases, kMostReleases); ++q)
      if (!look_at(q, response)) return unbounded(response);
    return releases > kMostReleases ? unbounded(response) : response;
  }

private:
  enum class Preemption : std::uint8_t {
    none,         // it blocks at most
    before_step,  // it goes first until our own step has begun
    any_time,     // … and its announcements join in at any time
  };

  // A part of a busy period: its end, the beginning of its last own step, and the number of own steps.
  struct Window {
    Instructions until, begun, own;
  };

  const Source& mine() const { return set_.sources[mine_]; }

  Preemption preemption_by(std::size_t j) const {
    const Source& other = set_.sources[j];
    if (adapted_ ? other.may_outrank_one : other.outranks_a_behavior) return Preemption::any_time;
    const unsigned rank = adapted_ ? other.raised : other.rank;
    if (rank > mine().rank) return Preemption::none;
    return chain_.length == 0 ? Preemption::before_step
                              : Preemption::any_time;  // between the steps, it goes first
  }

  // The smallest t with demand(t) <= t, or none.
  template <class Demand>
  static std::optional<Instructions> fixed_point(Demand demand) {
    Instructions t = 1;
    for (unsigned round = 0; round < kMostRounds && t < kForeverLate; ++round) {
      const Instructions next = demand(t);
      if (next <= t) return t;
      t = next;
    }
    return std::nullopt;
  }

  Instructions own_releases(Instructions until) const {
    return ceil_div(until + mine().jitter, mine().period);
  }

  Instructions releases_of(std::size_t j, const Window& window) const {
    if (j == mine_) return window.own;
    const Source& other = set_.sources[j];
    // What its own steps release comes after them: the releases of the last step no longer count, and
    // those of steps before the busy period count if they are late.
    if (chain_.length == 0 && follows_mine(j))
      return window.own - 1 + ceil_div(other.jitter, other.period);
    switch (preemption_by(j)) {
      case Preemption::any_time:
        return ceil_div(window.until + other.jitter, other.period);
      case Preemption::before_step:
        return (window.begun + other.jitter) / other.period + 1;
      default:
        return 0;
    }
  }

  bool follows_mine(std::size_t j) const {
    for (std::size_t depth = 0; depth < set_.sources.size() && j != Source::kNone; ++depth) {
      j = set_.sources[j].follows;
      if (j == mine_) return true;
    }
    return false;
  }

  // The number of steps in which a rule with these sources is evaluated, including the step that blocks.
  Instructions evaluations(const std::vector<std::size_t>& sources, const Window& window) const {
    Instructions sum = 0;
    bool may_block = false;
    for (const std::size_t j : sources) {
      sum += releases_of(j, window);
      may_block = may_block || (j != mine_ && preemption_by(j) == Preemption::none);
    }
    return sum + (may_block ? chain_.length + 1 : 0);
  }

  // How often a rule fires: at most as often as it is evaluated.
  Instructions fires(const Firing& rule, const Window& window) const {
    Instructions most = evaluations(rule.sources, window);
    if (rule.alternates) most = ceil_div(most, 2);
    return std::min(most, once_in(rule.gap, window));
  }

  static Instructions once_in(Instructions time, const Window& window) {
    return time == 0 ? kForeverLate : window.until / time + 1;
  }

  // How often each rule wins, and how often it fires and loses, which costs no more. So, of the rules
  // in a choice or a contest, the most expensive ones win, in different steps.
  struct Outcome {
    const Firing* rule;
    Instructions won, lost;
  };

  std::vector<Outcome> outcomes(const Window& window) const {
    std::vector<Outcome> all;
    for (const Firing& rule : set_.firings) {
      const Instructions fired = fires(rule, window);
      const Instructions won = std::min(fired, once_in(rule.cooldown, window));
      all.push_back({&rule, won, fired - won});
    }
    std::ranges::stable_sort(all, std::ranges::greater{},
                             [](const Outcome& one) { return one.rule->cost; });
    const auto win = [](Outcome& one, Instructions& left) {
      const Instructions won = std::min(one.won, left);
      one.lost += one.won - won;
      one.won = won;
      left -= won;
    };
    limit(all, &Firing::choice, window, win);
    limit(all, &Firing::contest, window, win);
    leave_out_losers(all, window);
    return all;
  }

  // A rule without contenders cannot lose; and at most one rule of a choice fires in a step.
  void leave_out_losers(std::vector<Outcome>& all, const Window& window) const {
    for (Outcome& one : all)
      if (one.rule->contest == Firing::kNone) one.lost = 0;
    std::map<std::size_t, Instructions> winners;
    for (const Outcome& one : all)
      winners[one.rule->choice] += one.won;
    limit(all, &Firing::choice, window, [&](Outcome& one, Instructions& left) {
      Instructions& others = winners[one.rule->choice];
      left -= std::exchange(others, 0);
      one.lost = std::min(one.lost, left);
      left -= one.lost;
    });
  }

  // Calls take(outcome, left) for all rules of one choice, or of one contest; `left` is the number of
  // steps that they have together.
  template <class Take>
  void limit(std::vector<Outcome>& all, std::size_t Firing::*which, const Window& window,
             Take take) const {
    std::map<std::size_t, std::vector<std::size_t>> sources;
    for (const Firing& rule : set_.firings)
      if (rule.*which != Firing::kNone) {
        std::vector<std::size_t>& its = sources[rule.*which];
        its.insert(its.end(), rule.sources.begin(), rule.sources.end());
      }
    for (auto& [number, its] : sources) {
      std::ranges::sort(its);
      its.erase(std::unique(its.begin(), its.end()), its.end());
      Instructions left = evaluations(its, window);
      for (Outcome& one : all)
        if (one.rule->*which == number) take(one, left);
    }
  }

  // Calls take(name, cost) for each share of the work in the window.
  template <class Take>
  void each_share(const Window& window, Take take) const {
    for (std::size_t j = 0; j < set_.sources.size(); ++j) {
      const Source& source = set_.sources[j];
      take(source.name, releases_of(j, window) * (source.sample + source.step));
    }
    for (const Outcome& one : outcomes(window))
      take(one.rule->name, one.won * one.rule->cost + one.lost * set_.lost);
    for (const Interference& one : set_.interferences)
      take(one.name, ceil_div(window.until, one.period) * one.cost);
  }

  Instructions demand(const Window& window) const {
    Instructions sum = blocking_ + chain_.delays;
    each_share(window, [&](const std::string&, Instructions cost) { sum += cost; });
    return sum;
  }

  std::vector<Contributor> contributors(const Window& window) const {
    std::vector<Contributor> list{{"a step that is under way, or a lock", blocking_}};
    each_share(window,
               [&](const std::string& name, Instructions cost) { add_share(list, name, cost); });
    std::erase_if(list, [](const Contributor& one) { return one.cost == 0; });
    std::ranges::stable_sort(list, std::ranges::greater{}, &Contributor::cost);
    return list;
  }

  // Examines the `q`-th release of the busy period. False if its response is unbounded.
  bool look_at(Instructions q, ResponseTime& worst) const {
    // A source that outranks a behaviour may even join its own earlier announcement.
    const bool joins = adapted_ ? mine().may_outrank_one : mine().outranks_a_behavior;
    const auto window = [&](Instructions t) {
      return Window{t, t - std::min(t, mine().step), joins ? std::max(q, own_releases(t)) : q};
    };
    const std::optional<Instructions> end =
        fixed_point([&](Instructions t) { return demand(window(t)); });
    if (!end) return false;
    const Instructions first = (q - 1) * mine().period;  // without jitter
    const Instructions released = first - std::min(first, mine().jitter);
    const Instructions time = *end - std::min(*end, released);
    if (time <= worst.time) return true;
    worst.time = time;
    worst.contributors = contributors(window(*end));
    return true;
  }

  static ResponseTime unbounded(ResponseTime response) {
    response.bounded = false;
    return response;
  }

  const TaskSet& set_;
  std::size_t mine_;
  Chain chain_;
  bool adapted_;
  Instructions blocking_ = 0;
};

ResponseTime solve(const TaskSet& set, std::size_t mine, Priorities priorities, Chain chain) {
  return Analysis(set, mine, priorities, chain).solve();
}

// From the release at the beginning of the chain to the release of this one.
Instructions lateness(const TaskSet& set, const Source& follower, Priorities priorities) {
  Chain chain{1, follower.delay};
  std::size_t root = follower.follows;
  while (set.sources[root].follows != Source::kNone) {  // each follows an earlier one
    ++chain.length;
    chain.delays += set.sources[root].delay;
    root = set.sources[root].follows;
  }
  const ResponseTime response = solve(set, root, priorities, chain);
  return response.bounded ? response.time : kForeverLate;
}

}  // namespace

// What follows a step is as late as that step may be, and its own followers are later still: all the
// work up to then is done in one stretch, which is idle at most for the delays in between. How late
// a source is depends on the other followers. Iterated from below, like response times; what does not
// settle may be arbitrarily late.
void settle(TaskSet& set, Priorities priorities) {
  constexpr unsigned kMostPasses = 100;
  for (unsigned pass = 0; pass < kMostPasses; ++pass) {
    bool settled = true;
    for (Source& source : set.sources) {
      if (source.follows == Source::kNone) continue;
      const Instructions jitter = std::max(lateness(set, source, priorities), source.jitter);
      settled = settled && jitter == source.jitter;
      source.jitter = jitter;
    }
    if (settled) return;
  }
  for (Source& source : set.sources)
    if (source.follows != Source::kNone) source.jitter = kForeverLate;
}

void add_share(std::vector<Contributor>& shares, const std::string& name, Instructions cost) {
  const auto same = std::ranges::find(shares, name, &Contributor::name);
  if (same == shares.end())
    shares.push_back({name, cost});
  else
    same->cost += cost;
}

double utilization(const TaskSet& set, const Firing& rule) {
  double sum = 0;
  for (const std::size_t j : rule.sources)
    sum += share(rule.cost, set.sources[j].period) / (rule.alternates ? 2 : 1);
  return rule.gap == 0 ? sum : std::min(sum, share(rule.cost, rule.gap));
}

namespace {

// Of the rules in this choice: in each step, at most the most expensive one fires.
double utilization_of_choice(const TaskSet& set, std::size_t choice) {
  double sum = 0;
  std::map<std::size_t, Instructions> most;  // by source
  for (const Firing& rule : set.firings) {
    if (rule.choice != choice) continue;
    sum += utilization(set, rule);
    for (const std::size_t j : rule.sources)
      most[j] = std::max(most[j], rule.cost);
  }
  double together = 0;
  for (const auto& [j, cost] : most)
    together += share(cost, set.sources[j].period);
  return std::min(sum, together);
}

}  // namespace

double utilization(const TaskSet& set) {
  double sum = 0;
  for (const Source& source : set.sources)
    sum += share(source.sample + source.step, source.period);
  std::set<std::size_t> choices;
  for (const Firing& rule : set.firings) {
    if (rule.choice == Firing::kNone)
      sum += utilization(set, rule);
    else if (choices.insert(rule.choice).second)
      sum += utilization_of_choice(set, rule.choice);
  }
  for (const Interference& one : set.interferences)
    sum += share(one.cost, one.period);
  return sum;
}

// The same thread asks and samples, so that what the sample releases counts as work before the end of this chain.
ResponseTime response_time_from_asking(const TaskSet& set, std::size_t source,
                                       Priorities priorities) {
  const Source& sample = set.sources[source];
  if (sample.follows == Source::kNone) return {};
  const Source& asking = set.sources[sample.follows];
  if (asking.follows != Source::kNone || asking.step != 0 || asking.rank != sample.rank ||
      asking.raised != sample.raised)
    return {};
  return solve(set, sample.follows, priorities, Chain{1, sample.delay});
}

ResponseTime response_time_of(const TaskSet& set, std::size_t source, Priorities priorities) {
  return solve(set, source, priorities, {});
}

}  // namespace robosync::analysis
