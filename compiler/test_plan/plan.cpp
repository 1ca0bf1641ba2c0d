// A small layer on top of sema, which handles names, units and commands. Assumes a program that sema has accepted.
#include "compiler/test_plan/plan.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "compiler/sema/commands.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/variables.hpp"
#include "compiler/source/ascii.hpp"

namespace robosync::compiler::test_plan {
namespace {

constexpr std::string_view kStopped = "stopped";  // in place of a verb

// True for operations that an expectation about a single moment cannot use.
bool looks_back(const Expression& expression) {
  return has_time_word(expression) || expression.operation == Operation::random ||
         std::ranges::any_of(expression.operands, looks_back);
}

class Planner {
public:
  Planner(const Trees& trees, const Robot& robot, const SourceMap& sources)
      : robot_(robot),
        sources_(sources),
        names_(trees, robot, diagnostics_),
        expressions_(names_, diagnostics_),
        motions_(robot, names_, expressions_, ignored_),
        commands_(robot, names_, expressions_, motions_, diagnostics_) {
    ir::Program ignored;
    Variables(names_, expressions_, diagnostics_).declare(ignored);
    diagnostics_ = {};  // sema has already reported all of this
  }

  void plan(const ast::Test& test, Span span, TestPlan& plan) {
    const std::size_t before = diagnostics_.errors();
    plan_ = &plan;
    test_ = {std::string(test.title), span, {}, {}, 0, {}};
    now_ = 0;
    for (const ast::TestStep& step : test.steps)
      std::visit([&](const auto& node) { add(node, step.span); }, step.node);
    if (diagnostics_.errors() == before) plan.tests.push_back(std::move(test_));
  }

  const Diagnostics& diagnostics() const { return diagnostics_; }

private:
  // ---- times
  std::optional<Milliseconds> time(const ast::Expr& expr, const char* what) {
    const auto value = expressions_.constant_amount(
        expr, {&canonical_unit(vm::Dimension::duration), what, expr.span});
    if (!value) return std::nullopt;
    const vm::Value thousandths = value->code.constant;
    if (thousandths >= 0 && static_cast<Milliseconds>(thousandths) <= kLongestTest) {
      return static_cast<Milliseconds>(thousandths);
    }
    if (thousandths >= 0) return too_long(static_cast<std::int64_t>(thousandths), expr.span);
    diagnostics_.report(Code::E0509, "a time in a TEST cannot be negative").label(expr.span);
    return std::nullopt;
  }

  std::optional<Milliseconds> too_long(std::int64_t length, Span span) {
    const Unit& second = canonical_unit(vm::Dimension::duration);
    diagnostics_
        .report(Code::E0509, "this TEST would take " + format_value(length, second) +
                                 "; the limit is an hour, " + format_value(kLongestTest, second))
        .label(span);
    return std::nullopt;
  }

  // The time at the end of a length from now; nullopt after a mistake.
  std::optional<Milliseconds> until(const ast::Expr& expr, const char* what) {
    const auto length = time(expr, what);
    if (!length) return std::nullopt;
    if (now_ + *length > kLongestTest) return too_long(now_ + *length, expr.span);
    return now_ + *length;
  }

  void reach(Milliseconds end) { test_.end = std::max(test_.end, end); }

  void expect(Span span, Milliseconds end, decltype(Expectation::what) what) {
    reach(end);
    test_.expectations.push_back({span, now_, end, std::move(what)});
  }

  // ---- AT t sensor = value
  void add(const ast::TestFeed& node, Span span) {
    const auto at = time(*node.at, "AT");
    const auto channel = names_.find_channel(node.target);
    if (!channel || !may_feed(*channel, span)) return;
    const auto value = reading(node, *channel, span);
    if (!at || !value) return;
    if (*at < now_) {
      diagnostics_.report(Code::E0509, "this time has already passed at this point")
          .label(node.at->span)
          .helps("in a TEST, time only moves forward: move this line further up");
      return;
    }
    now_ = *at;
    reach(now_);
    name_channel(*channel);
    test_.readings.push_back({now_, *channel, *value, span});
  }

  bool may_feed(ChannelRef ref, Span span) {
    const SensorConfig& sensor = names_.sensor(ref);
    if (!sensor.algorithm) return true;
    diagnostics_.report(Code::E0509, sensor.name.shown() + " is an algorithm and cannot be fed")
        .label(span)
        .helps("feed its input instead: " + robot_.sensors[sensor.algorithm->input].name.shown());
    return false;
  }

  std::optional<vm::Value> reading(const ast::TestFeed& node, ChannelRef ref, Span span) {
    const ChannelConfig& channel = names_.channel(ref);
    if (node.text) return labelled(*node.text, ref);
    if (const auto* truth = std::get_if<ast::IsTruth>(&node.value->node)) {
      if (channel.truth) return label_value(truth->truth ? 1 : 0);
      diagnostics_.report(Code::E0306, "`" + names_.channel_name(ref) + "` is not true or false")
          .label(span);
      return std::nullopt;
    }
    if (!channel.labels.empty()) {
      report_bare_word(*node.value, ref);
      return std::nullopt;
    }
    return in_range(*node.value, ref);
  }

  // `AT 1s red_button = pressed`
  void report_bare_word(const ast::Expr& value, ChannelRef ref) {
    const std::vector<std::string>& labels = names_.channel(ref).labels;
    const auto* const operand = std::get_if<ast::Operand>(&value.node);
    std::string word(operand != nullptr ? operand->name.text : std::string_view());
    if (operand != nullptr && operand->channel) word.append(" ").append(operand->channel->text);
    Diagnostic& d =
        diagnostics_
            .report(Code::E0306, "`" + names_.channel_name(ref) + "` gives words, not numbers")
            .label(value.span);
    if (const auto place = names_.find_label(labels, word)) {
      const std::string quoted = "\"" + labels[*place] + "\"";
      d.helps("write the word in quotes: " + quoted).fix(value.span, quoted, Applicability::likely);
    } else {
      d.helps("write one of them in quotes: " + list_names(labels, "or"));
    }
  }

  std::optional<vm::Value> labelled(const ast::Name& label, ChannelRef ref) {
    const ChannelConfig& channel = names_.channel(ref);
    if (channel.labels.empty()) {
      diagnostics_
          .report(Code::E0306, "`" + names_.channel_name(ref) + "` gives numbers, not words")
          .label(label.span);
      return std::nullopt;
    }
    const auto place =
        find_label(names_, channel.labels, label, names_.channel_name(ref), diagnostics_, true);
    return place ? std::optional(label_value(*place)) : std::nullopt;
  }

  std::optional<vm::Value> in_range(const ast::Expr& expr, ChannelRef ref) {
    const ChannelConfig& channel = names_.channel(ref);
    const auto value = expressions_.constant_amount(
        expr, {channel.unit, names_.channel_name(ref), channel.unit_span});
    if (!value) return std::nullopt;
    if (value->code.constant >= channel.min && value->code.constant <= channel.max) {
      return value->code.constant;
    }
    diagnostics_
        .report(Code::E0509, "`" + names_.channel_name(ref) +
                                 "` cannot measure this: its range is " +
                                 format_value(channel.min, *channel.unit) + " to " +
                                 format_value(channel.max, *channel.unit))
        .label(expr.span)
        .label(channel.unit_span, "its range is set here", false);
    return std::nullopt;
  }

  // ---- EXPECT
  std::optional<Milliseconds> within(const ast::Box<ast::Expr>& length) {
    return length ? until(*length, "WITHIN") : std::optional(now_);
  }

  // A whole number in a step, such as a count.
  std::optional<std::uint32_t> whole(
      const ast::Name& digits, std::uint32_t least,
      std::uint32_t most = std::numeric_limits<std::uint32_t>::max()) {
    std::uint32_t number = 0;
    const char* const last = digits.text.data() + digits.text.size();
    const auto [end, error] = std::from_chars(digits.text.data(), last, number);
    if (error == std::errc() && end == last && number >= least && number <= most) return number;
    diagnostics_
        .report(Code::E0509, "this must be a whole number from " + std::to_string(least) + " to " +
                                 std::to_string(most))
        .label(digits.span);
    return std::nullopt;
  }

  static bool has_text(const ast::Command& command) {
    return std::ranges::any_of(command.arguments, [](const ast::Argument& argument) {
      return std::holds_alternative<ast::Text>(argument.value);
    });
  }

  static bool is_count(const ast::Argument& argument) {
    const auto* const amount = std::get_if<ast::Amount>(&argument.value);
    return amount != nullptr && amount->times;
  }

  // `EXPECT SAY "Hello" 2 TIMES WITHIN 3s`: a verb that takes no TIMES is counted. True: this is reported.
  bool report_count_behind(const ast::ExpectCommand& node, Span span) {
    const ast::Command& command = node.command;
    const auto count = std::ranges::find_if(command.arguments, is_count);
    bool known = false, takes_times = false;
    for (const ActuatorConfig& actuator : robot_.actuators)
      if (const VerbConfig* const verb = actuator.find_verb(command.verb.text)) {
        known = true;
        takes_times = takes_times || verb->has(vm::Param::times);
      }
    if (count == command.arguments.end() || !known || takes_times || node.times) return false;
    const std::string times(sources_.text(count->span));
    std::string better = (node.no ? "NO" : times) + " " + std::string(command.verb.text);
    for (const ast::Argument& argument : command.arguments)
      if (&argument != &*count) better.append(" ").append(sources_.text(argument.span));
    better.append(" WITHIN ").append(node.within ? sources_.text(node.within->span) : "2s");
    diagnostics_
        .report(Code::E0010, node.no ? "`EXPECT NO` takes no number of times"
                                     : "in an `EXPECT`, `" + times + "` goes before the command")
        .label(count->span)
        .helps("write `EXPECT " + better + "`")
        .fix(span, "EXPECT " + better, Applicability::likely);
    return true;
  }

  void add(const ast::ExpectCommand& node, Span span) {
    const bool stopped = ascii::same(node.command.verb.text, kStopped);
    if (!stopped && report_count_behind(node, span)) return;
    if (node.within == nullptr && !stopped) {
      diagnostics_.report(Code::E0409, "this `EXPECT` does not say how long it waits")
          .label(span)
          .helps("add how long, such as `WITHIN 1s`");
      return;
    }
    std::optional<std::uint32_t> times;
    if (node.times && !(times = whole(*node.times, 0))) return;
    const auto end = within(node.within);
    const auto behind = std::ranges::find_if(node.command.arguments, is_count);
    if (stopped && (times || behind != node.command.arguments.end())) {
      diagnostics_.report(Code::E0409, "`STOPPED` cannot be counted")
          .label(times ? node.times->span : behind->span);
      return;
    }
    if (stopped) {
      add_stop(node, span, end);
      return;
    }
    // One command for a group, or one for each of its members.
    for (ir::Command& command : commands_.translate(node.command))
      if (!add_command(node, command, times, span, end)) return;
  }

  // False: the message about it stands for all of them.
  bool add_command(const ast::ExpectCommand& node, ir::Command& command,
                   std::optional<std::uint32_t> times, Span span, std::optional<Milliseconds> end) {
    if (command.word && find_place(command.word->name)) {
      diagnostics_.report(Code::E0409, "a TEST compares the whole text that is said")
          .label(span)
          .helps("write the final text in quotes: `\"You have 3 points\"`");
      return false;
    }
    ExpectedCommand expected{node.no,
                             actuator_names(command.actuators),
                             command.verb.name,
                             command.word ? std::optional(command.word->name) : std::nullopt,
                             std::move(command.arguments),
                             times,
                             has_text(node.command)};
    const bool one_moment = std::ranges::none_of(
        expected.arguments,
        [](const ir::Argument& argument) { return looks_back(argument.value); });
    if (!one_moment) report_moment(span);
    if (end && one_moment) expect(span, *end, std::move(expected));
    return true;
  }

  void add_stop(const ast::ExpectCommand& node, Span span, std::optional<Milliseconds> end) {
    const auto* const word = node.command.arguments.size() == 1
                                 ? std::get_if<ast::Word>(&node.command.arguments.front().value)
                                 : nullptr;
    if (word == nullptr) {
      diagnostics_.report(Code::E0504, "`EXPECT STOPPED` needs one actuator or group").label(span);
      return;
    }
    const auto target = commands_.find_stopped(word->name);
    if (target && end) expect(span, *end, ExpectedStop{node.no, actuator_names(target->actuators)});
  }

  void add(const ast::ExpectText& node, Span span) {
    const auto end = within(node.within);
    if (end) expect(span, *end, ExpectedText{node.no, node.alert, std::string(node.text)});
  }

  void add(const ast::Seed& node, Span span) {
    if (test_.seed)
      diagnostics_.report(Code::E0011, "this TEST has a `SEED` already").label(span);
    else
      test_.seed = whole(node.number, 1, kMaxSeed);
  }

  void add(const ast::ExpectNothing& node, Span span) {
    const auto end = until(*node.duration, "FOR");
    if (!end) return;
    expect(span, *end, ExpectedSilence{});
    now_ = *end;
  }

  void add(const ast::ExpectThat& node, Span span) {
    const auto end = within(node.within);
    Typed condition = expressions_.condition(*node.condition);
    if (condition.type != Type::condition) return;
    if (looks_back(condition.code)) {
      report_moment(node.condition->span);
    } else if (end) {
      name_channels(condition.code);
      expect(span, *end, ExpectedTruth{std::move(condition.code)});
    }
  }

  void add(const ast::Wait& node, Span) {
    const auto end = until(*node.duration, "WAIT");
    if (!end) return;
    now_ = *end;
    reach(now_);
  }

  void report_moment(Span span) {
    diagnostics_.report(Code::E0409, "`EXPECT` can test only one moment")
        .label(span, "this depends on the past, or on chance")
        .helps("expect something that is true at one moment, WITHIN some time");
  }

  void name_channel(ChannelRef channel) {
    if (plan_->channels.contains(channel)) return;
    plan_->channels[channel] = {names_.sensor(channel).name.text,
                                names_.channel(channel).name.text};
  }

  void name_channels(const Expression& expression) {
    if (expression.operation == Operation::input) name_channel(expression.channel);
    for (const Expression& operand : expression.operands)
      name_channels(operand);
  }

  std::vector<std::string> actuator_names(const std::vector<std::size_t>& actuators) const {
    std::vector<std::string> names;
    names.reserve(actuators.size());
    for (const std::size_t actuator : actuators)
      names.push_back(robot_.actuators[actuator].name.text);
    return names;
  }

  const Robot& robot_;
  const SourceMap& sources_;
  Diagnostics diagnostics_;
  Names names_;
  Expressions expressions_;
  Diagnostics ignored_;  // sema has already reported mistakes in MOTIONs
  Motions motions_;
  Commands commands_;
  TestPlan* plan_ = nullptr;
  PlannedTest test_;
  Milliseconds now_ = 0;  // the current time in the TEST
};

}  // namespace

TestPlan plan_tests(const Trees& trees, const Robot& robot, const SourceMap& sources,
                    Diagnostics& diagnostics) {
  TestPlan plan;
  const auto is_test = [](const ast::Item& item) {
    return std::holds_alternative<ast::Test>(item.node);
  };
  if (trees.empty() || std::ranges::none_of(trees.front()->items, is_test)) return plan;
  Planner planner(trees, robot, sources);
  for (const ast::Item& item : trees.front()->items) {
    if (const auto* test = std::get_if<ast::Test>(&item.node)) planner.plan(*test, item.span, plan);
  }
  for (const Diagnostic& diagnostic : planner.diagnostics().all())
    diagnostics.add(diagnostic);
  return plan;
}

}  // namespace robosync::compiler::test_plan
