// See replay_comparison.hpp.
#include "rsc/trace/replay_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include "rsc/json.hpp"
#include "rsc/trace/event_reader.hpp"
#include "rsc/trace/replay_event.hpp"
#include "rsc/trace/time_units.hpp"

namespace robosync::tool {
namespace {

// A rule outside a BEHAVIOR is named by its line.
void leave_lines_out(Json& event) {
  constexpr std::string_view kByItsLine = "the rule at ";
  event.erase("line");
  for (const char* const key : {"by", "behavior"})
    if (const auto name = event.find(key); name != event.end() && name->is_string() &&
                                           name->get<std::string>().starts_with(kByItsLine))
      *name = kByItsLine;
}

// Step numbers are not compared, because a recording leaves out steps without news. Comparison checks the times. The name of a
// SAFETY rule is known with its source only.
bool same(Json a, Json b, Lines lines) {
  for (Json* const event : {&a, &b}) {
    for (const char* const key : {"step", "t_us", "safety"})
      event->erase(key);
    if (lines == Lines::of_another) leave_lines_out(*event);
  }
  return a == b;
}

// The subject of an event: an actuator, a variable or a rule; messages share one subject.
Json subject_of(const Json& event) {
  for (const char* const key : {"actuator", "variable", "rule"})
    if (const auto found = event.find(key); found != event.end()) return {{key, *found}};
  return nullptr;
}

bool is_of_safety(const Json& event) {
  return kind_of(event) == "trip" || kind_of(event) == "resume";
}

std::uint64_t apart(std::uint64_t a, std::uint64_t b) {
  return a > b ? a - b : b - a;
}

// `own` with the durations that were measured in the recording; nothing if one differs by more than `most_us`.
std::optional<Json> with_times_of(const Json& recorded, const Decided& own, const TraceNames& names,
                                  std::uint64_t most_us) {
  if (kind_of(recorded) != kind_of(own.line)) return std::nullopt;
  link::Event event = own.event;
  for (const auto& [value, place] : EventReader(own.event, names).durations()) {
    Json measured = recorded.value("value", Json(nullptr));
    if (const auto all = recorded.find("values"); all != recorded.end() && place < all->size())
      measured = (*all)[place];
    if (!measured.is_number()) return std::nullopt;
    const double apart_ms = thousandths_of(measured) - event.values[value];
    if (std::abs(apart_ms) * kMicroseconds > static_cast<double>(most_us)) return std::nullopt;
    event.values[value] += static_cast<std::int32_t>(apart_ms);
  }
  return read_json(trace_json(event, names));
}

// Within a millisecond, events are ordered only by their causes: a finished command and a step with a reading may come in either
// order. So each millisecond is compared as a whole. On a board a thread may have to wait for the processor, here none does: a
// recorded event may come a little later than here, and after what a reading caused meanwhile, but never before an earlier event
// of the same subject. The step that tells a reading may be late in the same way, and here the reading comes with that step. But
// SAFETY sees a reading when it comes: so what SAFETY does may be recorded a little earlier than here. What a TIMER measured may
// differ by as much as the events that it measured were late.
struct Millisecond {
  std::vector<const RecordedEvent*> recorded;
  std::vector<const Decided*> replayed;
};

class ReplayComparison {
public:
  ReplayComparison(Lines lines, const TraceNames& names, Replayed& result)
      : lines_(lines), names_(names), result_(result) {}

  // Call in order of time. False: there is a difference.
  [[nodiscard]] bool see(std::uint64_t at_us, const Millisecond& both) {
    if (!await(at_us)) return false;
    for (const Decided* const one : both.replayed)
      if (!was_early(*one)) open_.push_back(one);
    return std::ranges::all_of(both.recorded,
                               [this](const RecordedEvent* one) { return find(*one); });
  }

  // True if no event is overdue at this time; events of the last milliseconds may still be recorded, or replayed.
  [[nodiscard]] bool await(std::uint64_t at_us) {
    const auto is_overdue = [&](const Json& event) { return time_of(event) + kMostLateUs < at_us; };
    if (!early_.empty() && is_overdue(early_.front()->event))
      return differs(early_.front(), nullptr);
    if (!open_.empty() && is_overdue(open_.front()->line)) return differs(nullptr, open_.front());
    return true;
  }

  // The first time at which SAFETY did something in the replay only.
  [[nodiscard]] std::optional<std::uint64_t> safety_alone_us() const {
    for (const Decided* const one : open_)
      if (is_of_safety(one->line)) return time_of(one->line);
    return std::nullopt;
  }

private:
  bool differs(const RecordedEvent* recorded, const Decided* replayed) {
    result_.difference = Difference{recorded == nullptr ? 0 : recorded->line,
                                    recorded == nullptr ? "" : json_text(recorded->event),
                                    replayed == nullptr ? "" : json_text(replayed->line)};
    return false;
  }

  [[nodiscard]] bool is_same(const Json& recorded, const Decided& own) const {
    return same(recorded, own.line, lines_);
  }
  [[nodiscard]] bool is_same_but_for_times(const Json& recorded, const Decided& own) const {
    const std::uint64_t most_us =
        std::max(result_.latest_us, apart(time_of(recorded), time_of(own.line)));
    const auto as_measured = with_times_of(recorded, own, names_, std::min(most_us, kMostLateUs));
    return as_measured && same(recorded, *as_measured, lines_);
  }
  [[nodiscard]] const Decided* find_open(const Json& recorded) const {
    for (const Decided* const own : open_)
      if (is_same(recorded, *own)) return own;
    for (const Decided* const own : open_)
      if (is_same_but_for_times(recorded, *own)) return own;
    return nullptr;
  }

  // The first open event that comes before `found`: of its subject, and at an earlier time. If nothing was found, it is any.
  [[nodiscard]] const Decided* before(const Decided* found) const {
    for (const Decided* const other : open_) {
      if (other == found) return nullptr;
      if (found == nullptr || (time_of(other->line) < time_of(found->line) &&
                               subject_of(other->line) == subject_of(found->line)))
        return other;
    }
    return nullptr;
  }

  [[nodiscard]] bool find(const RecordedEvent& one) {
    const Decided* const found = find_open(one.event);
    if (found == nullptr && may_be_early(one.event)) {
      early_.push_back(&one);
      return true;
    }
    const Decided* const earlier = before(found);
    if (found == nullptr || earlier != nullptr) return differs(&one, earlier);
    count(one.event, time_of(found->line));
    std::erase(open_, found);
    return true;
  }

  // With a rule that trips or lets go comes what that does.
  [[nodiscard]] bool may_be_early(const Json& event) const {
    return is_of_safety(event) || std::ranges::any_of(early_, [&](const RecordedEvent* other) {
             return is_of_safety(other->event) && time_of(other->event) == time_of(event);
           });
  }

  // Of one subject, early events come in their order.
  [[nodiscard]] bool was_early(const Decided& own) {
    for (const RecordedEvent* const one : early_) {
      if (subject_of(one->event) != subject_of(own.line)) continue;
      if (!is_same(one->event, own) && !is_same_but_for_times(one->event, own)) return false;
      count(one->event, time_of(own.line));
      std::erase(early_, one);
      return true;
    }
    return false;
  }

  void count(const Json& recorded, std::uint64_t replayed_us) {
    const std::uint64_t at_us = time_of(recorded);
    const std::uint64_t apart_us = apart(at_us, replayed_us);
    ++result_.events;
    result_.commands += kind_of(recorded) == "command" ? 1 : 0;
    if (at_us < replayed_us) {
      ++result_.early;
      result_.earliest_us = std::max(result_.earliest_us, apart_us);
    } else if (at_us > replayed_us) {
      ++result_.late;
      result_.latest_us = std::max(result_.latest_us, apart_us);
    }
  }

  Lines lines_;
  const TraceNames& names_;
  Replayed& result_;
  std::vector<const Decided*> open_;         // replayed, but not yet found in the recording
  std::vector<const RecordedEvent*> early_;  // recorded, but not yet replayed
};

}  // namespace

bool is_compared(std::string_view kind) {
  constexpr std::string_view kOthers[] = {"activated", "input",  "stale",   "fault",  "deadline",
                                          "lowered",   "silent", "answers", "blocked"};
  return std::ranges::find(kOthers, kind) == std::end(kOthers);
}

Compared compare(const std::vector<RecordedEvent>& recorded, const std::vector<Decided>& replayed,
                 Lines lines, const TraceNames& names) {
  std::map<std::uint64_t, Millisecond> time;
  for (const RecordedEvent& one : recorded)
    if (is_compared(kind_of(one.event)) && !is_beginning(one.event))
      time[time_of(one.event)].recorded.push_back(&one);
  for (const Decided& one : replayed)
    time[time_of(one.line)].replayed.push_back(&one);
  Compared compared;
  compared.result.until_us = time_of(recorded.back().event);
  ReplayComparison comparison(lines, names, compared.result);
  const bool is_equal = std::ranges::all_of(
      time, [&](const auto& both) { return comparison.see(both.first, both.second); });
  if (is_equal) (void)comparison.await(compared.result.until_us);
  compared.safety_alone_us = comparison.safety_alone_us();
  return compared;
}

}  // namespace robosync::tool
