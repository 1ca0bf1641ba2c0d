// May assume that the recording reaches the end of the test. Windows include both their ends.
#include "rsc/trace/expectations.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "rsc/trace/event_reader.hpp"
#include "rsc/trace/time_units.hpp"
#include "rsc/trace/trace_format.hpp"

namespace robosync::tool {
namespace {

using compiler::test_plan::Expectation;
using compiler::test_plan::ExpectedCommand;
using compiler::test_plan::ExpectedSilence;
using compiler::test_plan::ExpectedStop;
using compiler::test_plan::ExpectedText;
using compiler::test_plan::ExpectedTruth;
using link::EventKind;

class Judge {
public:
  Judge(const Expectation& expectation, const Recording& recording)
      : recording_(recording),
        names_{recording.image, {}, recording.origin},
        from_us_(expectation.from * kMicroseconds),
        until_us_(expectation.until * kMicroseconds) {}

  std::optional<std::string> judge(const ExpectedCommand& expected) const {
    for (const std::string& actuator : expected.actuators) {
      const auto matches = [&](const link::Event& event, const Playback& playback) {
        return is_command(event, playback, actuator, expected);
      };
      if (expected.times) {
        if (auto wrong = miscounted(actuator, expected, matches)) return wrong;
        continue;
      }
      const link::Event* const found = find(matches);
      if (expected.no && found != nullptr) {
        return fmt::format("it came at {}: {}", seconds_text(found->time_us),
                           trace_words(*found, names_));
      }
      if (!expected.no && found == nullptr) {
        const std::string other = elsewhere(matches);
        return fmt::format("no `{}` for {} came {}{}", expected.verb, actuator, window(),
                           other.empty() ? nearest(actuator, expected) : other);
      }
    }
    return std::nullopt;
  }

  std::optional<std::string> judge(const ExpectedText& expected) const {
    const auto matches = [&](const link::Event& event, const Playback&) {
      return is_text(event, expected) && goes_on(EventReader(event, names_).text(), expected.text);
    };
    const link::Event* const found = find(matches);
    if (expected.no == (found != nullptr)) {
      if (found != nullptr)
        return fmt::format("it was written at {}: {}", seconds_text(found->time_us),
                           EventReader(*found, names_).text());
      const std::string other = elsewhere(matches);
      return fmt::format("it was not written {}{}", window(),
                         other.empty() ? nearest(expected) : other);
    }
    return std::nullopt;
  }

  std::optional<std::string> judge(const ExpectedStop& expected) const {
    for (const std::string& actuator : expected.actuators) {
      const auto stops = [&](const link::Event& event, const Playback&) {
        return is_stop(event, actuator);
      };
      const link::Event* const found = find(stops);
      const bool stopped = found != nullptr || is_halted(actuator);
      if (expected.no && stopped) {
        return found != nullptr
                   ? fmt::format("{} was stopped at {}", actuator, seconds_text(found->time_us))
                   : fmt::format("{} was halted before {}", actuator, seconds_text(from_us_));
      }
      if (!expected.no && !stopped) {
        return fmt::format("{} was not stopped {}", actuator, window());
      }
    }
    return std::nullopt;
  }

  std::optional<std::string> judge(const ExpectedSilence&) const {
    const link::Event* const found = find([this](const link::Event& event, const Playback&) {
      return EventReader(event, names_).is_carried_out();
    });
    if (found == nullptr) return std::nullopt;
    return fmt::format("there was a command at {}: {}", seconds_text(found->time_us),
                       trace_words(*found, names_));
  }

  std::optional<std::string> judge(const ExpectedTruth& expected) const {
    Playback playback(recording_);
    playback.advance(from_us_);
    vm::Value truth = compiler::test_plan::evaluate(expected.condition, playback);
    // A TIMER may change it every millisecond.
    const bool always = compiler::reads_time(expected.condition);
    for (std::uint64_t at = from_us_; truth != vm::kTrue;) {
      at = always ? at + kMicroseconds : playback.next_time();
      if (at > until_us_) break;
      playback.advance(at);
      truth = compiler::test_plan::evaluate(expected.condition, playback);
    }
    if (truth == vm::kTrue) return std::nullopt;
    return fmt::format("it was {} {}", truth == vm::kUnknown ? "unknown" : "false", window());
  }

private:
  std::string window() const {
    if (from_us_ == until_us_) return fmt::format("at {}", seconds_text(from_us_));
    return fmt::format("from {} to {}", seconds_text(from_us_), seconds_text(until_us_));
  }

  // The first event in the window for which `matches` is true, given the values at that time.
  template <typename Matches>
  const link::Event* find(Matches matches) const {
    return find(matches, from_us_, until_us_);
  }
  template <typename Matches>
  const link::Event* find(Matches matches, std::uint64_t from_us, std::uint64_t until_us) const {
    Playback playback(recording_);
    while (const link::Event* const event = playback.next()) {
      if (event->time_us < from_us) continue;
      if (event->time_us > until_us) return nullptr;
      if (matches(*event, playback)) return event;
    }
    return nullptr;
  }

  // A window that is slightly off is the most common mistake in a test.
  template <typename Matches>
  std::string elsewhere(Matches matches) const {
    const link::Event* const found = find(matches, 0, UINT64_MAX);
    return found == nullptr ? std::string()
                            : fmt::format("; it was at {}", seconds_text(found->time_us));
  }

  template <typename Matches>
  std::optional<std::string> miscounted(const std::string& actuator,
                                        const ExpectedCommand& expected, Matches matches) const {
    std::uint32_t count = 0;
    Playback playback(recording_);
    while (const link::Event* const event = playback.next())
      if (event->time_us >= from_us_ && event->time_us <= until_us_ && matches(*event, playback))
        ++count;
    if (count == *expected.times) return std::nullopt;
    return fmt::format("`{}` came {} time{} for {} {}, not {}", expected.verb, count,
                       count == 1 ? "" : "s", actuator, window(), *expected.times);
  }

  // The command closest to what was expected: with this verb, and in the window if there is one.
  std::string nearest(const std::string& actuator, const ExpectedCommand& expected) const {
    const auto similar = [&](const link::Event& event, const Playback&) {
      if (event.kind != EventKind::command) return false;
      const EventReader reader(event, names_);
      return reader.actuator_name() == actuator &&
             compiler::ascii::same(reader.verb_name(), expected.verb);
    };
    const link::Event* found = find(similar);
    if (found == nullptr) found = find(similar, 0, UINT64_MAX);
    if (found == nullptr) return {};
    const std::string time = seconds_text(found->time_us);
    const EventReader reader(*found, names_);
    if (!is_word(reader, expected))
      return fmt::format("; {} at {}: {}; expected {}", expected.verb, time,
                         shown_word(reader.word_name().value_or("")), shown_word(*expected.word));
    return fmt::format("; at {} it was {}", time, trace_words(*found, names_));
  }

  bool is_text(const link::Event& event, const ExpectedText& expected) const {
    return event.kind == (expected.alert ? EventKind::alert : EventKind::log);
  }

  static bool goes_on(std::string_view text, std::string_view expected) {
    if (!text.starts_with(expected)) return false;
    return text.size() == expected.size() || text[expected.size()] == ' ';
  }

  std::string nearest(const ExpectedText& expected) const {
    const auto similar = [&](const link::Event& event, const Playback&) {
      return is_text(event, expected);
    };
    const link::Event* found = find(similar);
    if (found == nullptr) found = find(similar, 0, UINT64_MAX);
    if (found == nullptr) return {};
    return fmt::format("; at {} it was: {}; expected {}", seconds_text(found->time_us),
                       EventReader(*found, names_).text(), expected.text);
  }

  static bool is_word(const EventReader& reader, const ExpectedCommand& expected) {
    if (!expected.word) return true;
    const std::string word = reader.word_name().value_or("");
    return expected.is_text ? word == *expected.word : compiler::ascii::same(word, *expected.word);
  }

  bool is_command(const link::Event& event, const Playback& playback, const std::string& actuator,
                  const ExpectedCommand& expected) const {
    const EventReader reader(event, names_);
    if (!reader.is_carried_out() || reader.actuator_name() != actuator ||
        !compiler::ascii::same(reader.verb_name(), expected.verb) || !is_word(reader, expected)) {
      return false;
    }
    return std::ranges::all_of(expected.arguments, [&](const compiler::ir::Argument& argument) {
      const vm::Value wanted = compiler::test_plan::evaluate(argument.value, playback);
      bool found = false;
      reader.for_each_param([&](std::size_t param, vm::Value given) {
        found = found || (param == static_cast<std::size_t>(argument.param) && given == wanted);
      });
      return found;
    });
  }

  bool is_stop(const link::Event& event, const std::string& actuator) const {
    const EventReader reader(event, names_);
    if (reader.shape().subject != About::actuator || reader.actuator_name() != actuator) {
      return false;
    }
    return event.kind == EventKind::halt || event.kind == EventKind::cancel ||
           (event.kind == EventKind::command && compiler::ascii::same(reader.verb_name(), "STOP"));
  }

  // At the start of the window.
  bool is_halted(const std::string& actuator) const {
    bool halted = false;
    for (const link::Event& event : recording_.events) {
      if (event.time_us > from_us_) break;
      if (event.kind != EventKind::halt && event.kind != EventKind::release) continue;
      if (EventReader(event, names_).actuator_name() == actuator) {
        halted = event.kind == EventKind::halt;
      }
    }
    return halted;
  }

  const Recording& recording_;
  TraceNames names_;
  std::uint64_t from_us_;
  std::uint64_t until_us_;
};

}  // namespace

std::optional<std::string> disappointment(const Expectation& expectation,
                                          const Recording& recording) {
  const Judge judge(expectation, recording);
  return std::visit([&](const auto& expected) { return judge.judge(expected); }, expectation.what);
}

TestResult run_test(const Program& program, const compiler::test_plan::TestPlan& plan,
                    const compiler::test_plan::PlannedTest& test) {
  TestResult result{&test, nullptr, {}, record(program, plan, test)};
  for (const Expectation& expectation : test.expectations) {
    auto reason = disappointment(expectation, result.recording);
    if (!reason) continue;
    result.failed = &expectation;
    result.reason = std::move(*reason);
    break;
  }
  return result;
}

}  // namespace robosync::tool
