// Words of RSL that mean something else where they are. Leaving one of them out would often invert what the program
// does, so each has its own message, and no fix that drops it. See habits.hpp.
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/mistaken_line.hpp"
#include "compiler/syntax/word_list.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {
namespace {

struct Opposite {
  TokenKind relation, kind;
  std::string_view spelling;
};

constexpr Opposite kOpposites[] = {
    {Kinds::LESS, Kinds::GREATER_EQUAL, ">="}, {Kinds::GREATER, Kinds::LESS_EQUAL, "<="},
    {Kinds::LESS_EQUAL, Kinds::GREATER, ">"},  {Kinds::GREATER_EQUAL, Kinds::LESS, "<"},
    {Kinds::EQUAL, Kinds::NOT_EQUAL, "<>"},    {Kinds::NOT_EQUAL, Kinds::EQUAL, "="},
};

const Opposite& opposite_of(TokenKind relation) {
  return *std::ranges::find(kOpposites, relation, &Opposite::relation);
}

constexpr const char* kMoreWords =
    "more greater larger higher bigger farther further louder brighter faster hotter warmer "
    "stronger harder heavier";
constexpr const char* kLessWords =
    "less fewer smaller lower closer nearer quieter darker dimmer slower colder cooler weaker "
    "softer lighter";

// A one-line statement, such as SET or WAIT.
bool is_plain_statement(TokenKind kind) {
  return (roles_of(kind) & role::statement) != 0 && (roles_of(kind) & role::opens) == 0;
}

class MisplacedWords : private MistakenLine {
public:
  using MistakenLine::MistakenLine;

  std::optional<Edit> find() {
    if (auto edit = safety_without_when()) return edit;
    if (stop_ >= tokens_.size()) return std::nullopt;
    using Habit = std::optional<Edit> (MisplacedWords::*)();
    for (const Habit habit : {&MisplacedWords::negated_comparison,
                              &MisplacedWords::negation,
                              &MisplacedWords::end_before_else,
                              &MisplacedWords::rule_in_rule,
                              &MisplacedWords::step_in_response,
                              &MisplacedWords::do_without_when,
                              &MisplacedWords::lonely_else,
                              &MisplacedWords::then_in_line,
                              &MisplacedWords::commands_with_and,
                              &MisplacedWords::commands_with_comma,
                              &MisplacedWords::second_statement,
                              &MisplacedWords::second_stopped,
                              &MisplacedWords::goes_on_above,
                              &MisplacedWords::times_of_name,
                              &MisplacedWords::set_of_channel,
                              &MisplacedWords::rate_apart,
                              &MisplacedWords::foreign_rate,
                              &MisplacedWords::command_in_behavior,
                              &MisplacedWords::within,
                              &MisplacedWords::columns_of_motion,
                              &MisplacedWords::word_with_sign,
                              &MisplacedWords::changed_wrongly,
                              &MisplacedWords::repeat_how_often,
                              &MisplacedWords::resume_after,
                              &MisplacedWords::modifier_behind_do,
                              &MisplacedWords::otherwise,
                              &MisplacedWords::more_than})
      if (auto edit = (this->*habit)()) return edit;
    return std::nullopt;
  }

private:
  // `SAFETY careful`, and then END, DO or nothing
  std::optional<Edit> safety_without_when() {
    const bool named = is(0, Kinds::SAFETY) && !is(1, Kinds::WHEN) && !text(1).empty();
    if (!named || (tokens_.size() > 2 && !is(2, Kinds::NEWLINE))) return std::nullopt;
    const std::size_t next = after_line_ends(2);
    const bool lacks = next >= tokens_.size() ||
                       is_one_of(tokens_[next].kind, {Kinds::END, Kinds::DO, Kinds::RESUME});
    if (!lacks || tokens_.size() < 2) return std::nullopt;
    const Span name = tokens_[1].span;
    Diagnostic& message =
        report(Code::E0008, "`WHEN` is missing after " + quote(1), {name.file, name.end, name.end});
    message.helps("a SAFETY rule is `WHEN` and a condition, then `DO`, `STOP ALL` and `END`");
    return change(0, tokens_.size());
  }

  // `60 deg/s`: a space before the unit of a speed
  std::optional<Edit> rate_apart() {
    if (!is(stop_, Kinds::SLASH) || stop_ < begin_ + 2 || !is(stop_ - 1, Kinds::NAME) ||
        !is(stop_ - 2, Kinds::QUANTITY) || !is(stop_ + 1, Kinds::NAME))
      return std::nullopt;
    const bool touches = tokens_[stop_ - 1].span.end == tokens_[stop_].span.begin &&
                         tokens_[stop_].span.end == tokens_[stop_ + 1].span.begin;
    const char last = text(stop_ - 2).back();
    if (!touches || last < '0' || last > '9') return std::nullopt;
    Span gap = tokens_[stop_ - 2].span;
    gap.begin = gap.end;
    gap.end = tokens_[stop_ - 1].span.begin;
    report(Code::E0505, "a unit follows its number without a space", span(stop_ - 2, stop_ + 2))
        .helps("write `" + std::string(text(stop_ - 2)) + text(stop_ - 1, stop_ + 2) + "`")
        .fix(gap, "", Applicability::likely);
    return change(stop_ - 2, 4, {missing(Kinds::QUANTITY, stop_ - 2)});
  }

  // `touch LEVEL IS NOT > 4`, `touch LEVEL isn't 4`
  std::optional<Edit> negated_comparison() {
    if (stop_ < begin_ + 2 || !is(stop_ - 1, Kinds::NOT) || !is(stop_ - 2, Kinds::IS))
      return std::nullopt;
    const Span words = span(stop_ - 2, stop_);
    const std::string what = "`" + std::string(source_.text(words)) + "`";
    if (is(stop_, Kinds::QUANTITY)) {
      report(Code::E0001, what + " compares words, but " + quote(stop_) + " is a number", words)
          .helps("to compare numbers, use `<>`")
          .fix(words, "<>", Applicability::likely);
      return change(stop_ - 2, 2, {{Kinds::NOT_EQUAL, words}});
    }
    for (const Opposite& one : kOpposites) {
      if (!is(stop_, one.relation)) continue;
      const Span all = span(stop_ - 2, stop_ + 1);
      report(Code::E0001, quote(stop_) + " takes no " + what + " before it", all)
          .helps("the opposite of " + quote(stop_) + " is `" + std::string(one.spelling) + "`")
          .fix(all, std::string(one.spelling), Applicability::likely);
      return change(stop_ - 2, 3, {{one.kind, all}});
    }
    return std::nullopt;
  }

  // `touch LEVEL NOT > 4`, `mood BECOMES NOT happy`
  std::optional<Edit> negation() {
    if (!is(stop_, Kinds::NOT) || stop_ == begin_) return std::nullopt;
    if (is(stop_ - 1, Kinds::BECOMES)) {
      const Span both = span(stop_ - 1, stop_ + 1);
      report(Code::E0001, "`BECOMES` takes no `NOT`", tokens_[stop_].span)
          .helps("for what is no longer so, use `IS NOT`")
          .fix(both, "IS NOT", Applicability::likely);
      return change(stop_ - 1, 2,
                    {{Kinds::IS, tokens_[stop_ - 1].span}, {Kinds::NOT, tokens_[stop_].span}});
    }
    for (const Opposite& one : kOpposites) {
      if (!is(stop_ + 1, one.relation)) continue;
      const Span both = span(stop_, stop_ + 2);
      report(Code::E0001, quote(stop_ + 1) + " takes no `NOT` before it", both)
          .helps("the opposite of " + quote(stop_ + 1) + " is `" + std::string(one.spelling) + "`")
          .fix(both, std::string(one.spelling), Applicability::likely);
      return change(stop_, 2, {{one.kind, both}});
    }
    return std::nullopt;
  }

  // `END` on the line above the ELSE
  std::optional<Edit> end_before_else() {
    if (!is(stop_, Kinds::ELSE) || before_ >= stop_ || !is(before_, Kinds::END))
      return std::nullopt;
    BlockWalk walk(tokens_);
    for (std::size_t at = 0; at <= before_; ++at)
      walk.step(at);
    if (walk.end_was_idle() || !is_one_of(tokens_[walk.closed()].kind, {Kinds::WHEN, Kinds::IF}))
      return std::nullopt;
    report(Code::E0010, "`ELSE` takes no `END` before it", tokens_[before_].span)
        .label(tokens_[walk.closed()].span, "the block begins here", false)
        .helps("one `END`, after the `ELSE` part, closes both")
        .fix(tokens_[before_].span, "", Applicability::likely);
    return change(before_, 1);
  }

  // A WHEN in a response: it is indented deeper than the block that holds it.
  std::optional<Edit> rule_in_rule() {
    if (stop_ != begin_ ||
        !is_one_of(tokens_[stop_].kind, {Kinds::WHEN, Kinds::WHILE, Kinds::EVERY}))
      return std::nullopt;
    const auto block = open_block();
    if (!block || !starts_line(tokens_, *block) ||
        is_one_of(tokens_[*block].kind,
                  {Kinds::BEHAVIOR, Kinds::SAFETY, Kinds::TEST, Kinds::CHECK, Kinds::MOTION}) ||
        indentation(tokens_[stop_], source_) <= indentation(tokens_[*block], source_))
      return std::nullopt;
    const bool asks_first =
        !is_one_of(tokens_[*block].kind, {Kinds::DEFINE, Kinds::REPEAT, Kinds::PICK});
    std::size_t begins = stop_;
    while (begins < tokens_.size() && !is_one_of(tokens_[begins].kind, {Kinds::DO, Kinds::END}))
      ++begins;
    if (!is(begins, Kinds::DO) || (asks_first && !has(*block, stop_, Kinds::DO)))
      return std::nullopt;
    report(Code::E0010, quote(stop_) + " cannot be used inside a response", tokens_[stop_].span)
        .label(tokens_[*block].span, "this block continues until its `END`", false)
        .helps("rules follow one another: close the first with `END` before the next begins")
        .helps(std::string(in_response(tokens_[stop_].kind)));
    return change(stop_, begins - stop_,
                  {missing(Kinds::IF, stop_), missing(Kinds::QUANTITY, stop_),
                   missing(Kinds::LESS, stop_), missing(Kinds::QUANTITY, stop_)});
  }

  // `AT 8s touch LEVEL = 3`, `EXPECT …`
  bool is_step(std::size_t at) const {
    if (is(at, Kinds::EXPECT)) return true;
    return is(at, Kinds::AT) && is(at + 1, Kinds::QUANTITY) && has(at, line_end(at), Kinds::EQUAL);
  }

  std::size_t line_end(std::size_t at) const {
    while (at < tokens_.size() && !is(at, Kinds::NEWLINE))
      ++at;
    return at;
  }

  // Steps in a response. Takes all that follow too: each is misplaced in the same way.
  std::optional<Edit> step_in_response() {
    if (stop_ != begin_ || !is_step(stop_)) return std::nullopt;
    const auto block = open_block();
    if (!block || (!is_one_of(tokens_[*block].kind, {Kinds::DEFINE, Kinds::REPEAT, Kinds::PICK}) &&
                   !has(*block, stop_, Kinds::DO)))
      return std::nullopt;
    std::size_t last = line_end(stop_);
    while (last + 1 < tokens_.size() && is_step(last + 1))
      last = line_end(last + 1);
    report(Code::E0010,
           quote(stop_) + " begins a step of a TEST and cannot be used inside a response",
           tokens_[stop_].span)
        .label(tokens_[*block].span, "this block continues until its `END`", false)
        .helps("close it with `END` and write `TEST \"…\"` above the steps");
    return change(stop_, last - stop_, {missing(Kinds::THEN, stop_)});
  }

  // `DO SAY "b"` after the END of a rule
  std::optional<Edit> do_without_when() {
    if (!is(stop_, Kinds::DO) || stop_ != begin_ || !(stop_ == 0 || is(before_, Kinds::END)))
      return std::nullopt;
    const auto block = open_block();
    if (block && !is(*block, Kinds::BEHAVIOR)) return std::nullopt;
    report(Code::E0008, "a line with `WHEN` and a condition is missing above this `DO`",
           tokens_[stop_].span)
        .helps("a rule begins with `WHEN`, `WHILE`, `EVERY` or `AT START`");
    return change(stop_, 0,
                  {missing(Kinds::NEWLINE, stop_), missing(Kinds::WHEN, stop_),
                   missing(Kinds::QUANTITY, stop_), missing(Kinds::LESS, stop_),
                   missing(Kinds::QUANTITY, stop_)});
  }

  // An ELSE of a WHILE, an EVERY, a REPEAT: only a WHEN and an IF have one.
  std::optional<Edit> lonely_else() {
    if (!is(stop_, Kinds::ELSE) || stop_ != begin_) return std::nullopt;
    const auto block = open_block();
    if (!block || is_one_of(tokens_[*block].kind, {Kinds::WHEN, Kinds::IF, Kinds::DEFINE}))
      return std::nullopt;
    Diagnostic& message =
        report(Code::E0010, "`ELSE` belongs to a WHEN or an IF; " + quote(*block) + " takes none",
               tokens_[stop_].span);
    message.label(tokens_[*block].span, "the block begins here", false);
    if (is(*block, Kinds::WHILE))
      message.helps("for what happens otherwise, write another rule with the opposite condition");
    return change(stop_, 1, {missing(Kinds::NEWLINE, stop_)});
  }

  // `MOVE left_arm UP THEN SAY "x"`
  std::optional<Edit> then_in_line() {
    const bool may_end = contains(expected_, Kinds::NEWLINE) && contains(expected_, Kinds::END);
    if (!is(stop_, Kinds::THEN) || stop_ <= statement_ || asks_before(stop_) || !may_end)
      return std::nullopt;
    const std::size_t column = indentation(tokens_[begin_], source_);
    const std::string line = "\n" + std::string(column, ' ');
    const bool more = stop_ + 1 < end_;
    Span place = tokens_[stop_].span;
    place.begin = tokens_[stop_ - 1].span.end;
    if (more) place.end = tokens_[stop_ + 1].span.begin;
    report(Code::E0001, "`THEN` goes on a line of its own", tokens_[stop_].span)
        .helps("what comes before it is done first, and then what comes after it")
        .fix(place, line + "THEN" + (more ? line : ""), Applicability::likely);
    return change(stop_, 1,
                  {missing(Kinds::NEWLINE, stop_), tokens_[stop_], missing(Kinds::NEWLINE, stop_)});
  }

  // Is this statement, up to where the grammar stopped, a command and not a question?
  bool is_command() const {
    const auto block = open_block();
    return statement_ < stop_ && begins_with(Kinds::NAME) && !asks_before(stop_) && block &&
           !is_one_of(tokens_[*block].kind,
                      {Kinds::CHECK, Kinds::MOTION, Kinds::TEST, Kinds::BEHAVIOR, Kinds::SAFETY});
  }
  bool is_whole_command() const { return is_command() && contains(expected_, Kinds::NEWLINE); }

  // `MOVE head LEFT AND SAY "x"`
  std::optional<Edit> commands_with_and() {
    if (!is(stop_, Kinds::AND) || !is_whole_command()) return std::nullopt;
    report(Code::E0001, "`AND` joins conditions, not commands", tokens_[stop_].span)
        .helps(kOwnLine)
        .helps("if several actuators do the same, make them a group in robot.json");
    return change(stop_, end_of_command(stop_) - stop_);
  }

  // `MOVE head LEFT, SAY "x"`: the grammar has read the words after the comma as parts of a text.
  std::optional<Edit> commands_with_comma() {
    if (!is_command() || has(statement_, stop_, Kinds::WITH)) return std::nullopt;
    for (std::size_t at = statement_; at < stop_ && !is(at, Kinds::STRING); ++at) {
      if (!is(at, Kinds::COMMA) || !is(at + 1, Kinds::NAME)) continue;
      report(Code::E0001, "a comma cannot join two commands", tokens_[at].span).helps(kOwnLine);
      return change(at, end_of_command(at) - at);
    }
    return std::nullopt;
  }

  // Does the line begin with a complete statement, such as LOG or WAIT?
  bool is_behind_statement() const {
    const auto block = open_block();
    return statement_ < stop_ && is_plain_statement(tokens_[statement_].kind) &&
           !asks_before(stop_) && contains(expected_, Kinds::NEWLINE) && block &&
           !is_one_of(tokens_[*block].kind,
                      {Kinds::CHECK, Kinds::MOTION, Kinds::TEST, Kinds::BEHAVIOR, Kinds::SAFETY});
  }

  // `SAY "x" WAIT 2s`, `WAIT 2s SAY "x"`, `THEN SAY "x"`
  std::optional<Edit> second_statement() {
    const bool plain = is_plain_statement(tokens_[stop_].kind);
    const bool named = is(stop_, Kinds::NAME) && stop_ + 1 < end_ && !is(statement_, Kinds::STOP) &&
                       (is_one_of(tokens_[stop_ + 1].kind, {Kinds::NAME, Kinds::STRING}));
    if (part_of_text()) return comma_missing();
    if (!(plain && is_whole_command()) && !((plain || named) && is_behind_statement()))
      return std::nullopt;
    Span gap = tokens_[stop_ - 1].span;
    gap.begin = gap.end;
    gap.end = tokens_[stop_].span.begin;
    report(Code::E0001, quote(stop_) + " begins a second command on this line", tokens_[stop_].span)
        .helps("each command goes on a line of its own")
        .fix(gap, "\n", Applicability::likely);
    return change(stop_, end_of_command(stop_) - stop_);
  }

  // `LOG "level" touch LEVEL`: the name of a sensor is in lower case, a verb in capitals.
  bool part_of_text() const {
    const bool text = is(statement_, Kinds::LOG) || is(statement_, Kinds::ALERT);
    const std::string_view name = text_of_name(stop_);
    const bool small = std::ranges::any_of(name, [](char c) { return c >= 'a' && c <= 'z'; });
    const bool ends = stop_ + 1 >= statement_end() || is(stop_ + 1, Kinds::COMMA) ||
                      (is(stop_ + 1, Kinds::NAME) &&
                       (stop_ + 2 >= statement_end() || is(stop_ + 2, Kinds::COMMA)));
    return text && small && ends && is(stop_ - 1, Kinds::STRING) && is_behind_statement();
  }
  std::string_view text_of_name(std::size_t at) const {
    return is(at, Kinds::NAME) ? text(at) : std::string_view();
  }

  Edit comma_missing() {
    Span gap = tokens_[stop_ - 1].span;
    gap.begin = gap.end;
    gap.end = tokens_[stop_].span.begin;
    report(Code::E0008, "a comma is missing between the parts of a text", tokens_[stop_].span)
        .helps("put commas between them: `" + std::string(text(statement_)) + " " +
               text(stop_ - 1, stop_) + ", " + text(stop_, statement_end()) + "`")
        .fix(gap, ", ", Applicability::likely);
    return change(stop_, 0, {missing(Kinds::COMMA, stop_)});
  }

  // `STOP arms head`, `STOP arms, head`
  std::optional<Edit> second_stopped() {
    if (!is(statement_, Kinds::STOP) || stop_ != statement_ + 2 || !is_behind_statement() ||
        !is_one_of(tokens_[stop_].kind, {Kinds::NAME, Kinds::COMMA, Kinds::AND}))
      return std::nullopt;
    report(Code::E0001, "`STOP` takes one name", tokens_[stop_].span)
        .helps("write a `STOP` for each on a line of its own, or make them a group in robot.json");
    return change(stop_, end_of_command(stop_) - stop_);
  }

  // `BY 2` or `FOR 3s` on the line below the one it belongs to
  std::optional<Edit> goes_on_above() {
    const std::size_t at = is(stop_, Kinds::NEWLINE) ? stop_ + 1 : stop_;
    if (at < 2 || at + 1 >= tokens_.size() || !is(at - 1, Kinds::NEWLINE) ||
        !is_one_of(tokens_[at].kind,
                   {Kinds::BY, Kinds::FOR, Kinds::OVER, Kinds::TO, Kinds::WITHIN}) ||
        !is_one_of(tokens_[at - 2].kind, {Kinds::NAME, Kinds::QUANTITY, Kinds::STRING, Kinds::CLOSE,
                                          Kinds::CHANGES, Kinds::TIMES}))
      return std::nullopt;
    std::size_t above = at - 2;
    while (above > 0 && !is(above - 1, Kinds::NEWLINE))
      --above;
    if (is_one_of(tokens_[above].kind, {Kinds::PRIORITY, Kinds::COOLDOWN, Kinds::MARGIN,
                                        Kinds::RESTARTING, Kinds::WAITING}))
      return std::nullopt;
    Span gap = tokens_[at - 2].span;
    gap.begin = gap.end;
    gap.end = tokens_[at].span.begin;
    Diagnostic& message =
        report(Code::E0001, "`" + text(at, at + 2) + "` belongs at the end of the line above",
               span(at, at + 2));
    if (source_.text(gap).find_first_of("#%") == std::string_view::npos)
      message.fix(gap, " ", Applicability::likely);
    return change(at - 1, 1);
  }

  // `PERFORM wave k TIMES`
  std::optional<Edit> times_of_name() {
    if (!is(stop_, Kinds::TIMES) || stop_ < statement_ + 2 || !is(stop_ - 1, Kinds::NAME) ||
        !is_command())
      return std::nullopt;
    const Span here = tokens_[stop_].span;
    if (is(stop_ + 1, Kinds::QUANTITY)) {
      const Span both = span(stop_, stop_ + 2);
      const std::string better = std::string(text(stop_ + 1)) + " TIMES";
      report(Code::E0001, "the number goes before `TIMES`", both)
          .helps("write `" + better + "`")
          .fix(both, better, Applicability::likely);
      return change(stop_, 2, {tokens_[stop_ + 1], tokens_[stop_]});
    }
    if (stop_ == statement_ + 2) {
      report(Code::E0008, "this does not say how many `TIMES`", here)
          .helps("write a number before it: `2 TIMES`");
      return change(stop_, 0, {missing(Kinds::QUANTITY, stop_)});
    }
    const Token name = tokens_[stop_ - 1];
    const std::string better = "(" + std::string(text(stop_ - 1)) + ")";
    report(Code::E0505, "a named number needs brackets here", name.span)
        .helps("write `" + better + " TIMES`")
        .fix(name.span, better, Applicability::likely);
    return change(stop_ - 1, 1, {{Kinds::QUANTITY, name.span}});
  }

  // `SET touch LEVEL TO 3`
  std::optional<Edit> set_of_channel() {
    const bool by = begins_with(Kinds::RAISE) || begins_with(Kinds::LOWER);
    if (!(by || begins_with(Kinds::SET)) || stop_ != statement_ + 2 || !is(stop_, Kinds::NAME) ||
        !is(stop_ + 1, by ? Kinds::BY : Kinds::TO))
      return std::nullopt;
    const Span both = span(stop_ - 1, stop_ + 1);
    Diagnostic& d =
        report(Code::E0001,
               "`" + text(stop_ - 1, stop_ + 1) + "` is two words, but a variable is one", both);
    const std::string joined = std::string(text(stop_ - 1)).append("_").append(text(stop_));
    if (behind_declaration("REMEMBER", joined) || behind_declaration("FEELING", joined) ||
        behind_declaration("STATE", joined))
      d.helps("write `" + joined + "`").fix(both, joined);
    else
      d.helps("write a variable as one word, with `_`; a sensor's value cannot be changed")
          .helps("`SET`, `RAISE` and `LOWER` change a REMEMBER, a FEELING or a STATE");
    return change(stop_, 1);
  }

  std::size_t end_of_command(std::size_t at) const {
    while (at < end_ && !is_one_of(tokens_[at].kind, {Kinds::ELSE, Kinds::END}))
      ++at;
    return at;
  }

  // `3km/h`: the lexer ends the unit before the /, because only `/s` belongs to a unit
  std::optional<Edit> foreign_rate() {
    if (!is(stop_, Kinds::SLASH) || stop_ == begin_ || !is(stop_ - 1, Kinds::QUANTITY) ||
        !is_any_name(stop_ + 1, {"h", "hr", "hour", "min", "minute"}))
      return std::nullopt;
    const std::string_view number = text(stop_ - 1);
    const std::string_view unit = written_unit(number);
    if (unit.empty()) return std::nullopt;
    Span place = span(stop_ - 1, stop_ + 2);
    place.begin += static_cast<std::uint32_t>(number.size() - unit.size());
    report(Code::E0303, "there is no unit `" + std::string(source_.text(place)) + "`", place)
        .helps("speeds are per second, such as `20cm/s` or `30deg/s`");
    return change(stop_ - 1, 3, {missing(Kinds::QUANTITY, stop_ - 1)});
  }

  // `SAY voice "x"` in a BEHAVIOR, outside of its rules
  std::optional<Edit> command_in_behavior() {
    if (!is(0, Kinds::BEHAVIOR) || stop_ != begin_ || begin_ == 0 || open_block() != 0)
      return std::nullopt;
    if (!begins_command(stop_) && !is(stop_, Kinds::DO)) return std::nullopt;
    report(Code::E0010, quote(stop_) + " cannot be used in a BEHAVIOR outside its rules",
           tokens_[stop_].span)
        .helps("put it in a rule: begin with `WHEN` or `AT START DO`, and end with `END`");
    return change(begin_, end_of_commands() - begin_,
                  {missing(Kinds::USE, begin_), missing(Kinds::NAME, begin_)});
  }

  // A line that is a command, not a question without its WHEN.
  bool begins_command(std::size_t at) const {
    constexpr unsigned kBeginsLine = role::item | role::part | role::after;
    const bool named = is(at, Kinds::NAME) && !is(at + 1, Kinds::EQUAL) &&
                       nearest_keyword(text(at), kBeginsLine) == nullptr;
    if (!(named || is_plain_statement(tokens_[at].kind)) || is(at + 1, Kinds::NEWLINE))
      return false;
    std::size_t next = at + 1;
    for (; next < tokens_.size() && !is(next, Kinds::NEWLINE); ++next)
      if (asks(tokens_[next].kind)) return false;
    return is(next + 1, Kinds::END) || next + 1 >= tokens_.size() ||
           (roles_of(tokens_[next + 1].kind) & role::after) == 0;
  }
  static bool asks(TokenKind kind) {
    return is_relation(kind) || (roles_of(kind) & role::opens) != 0 ||
           is_one_of(kind, {Kinds::IS, Kinds::BECOMES, Kinds::CHANGES, Kinds::DO});
  }

  // The end of the commands: the line in which a rule begins or the block ends.
  std::size_t end_of_commands() const {
    std::size_t last = end_;
    while (last + 1 < tokens_.size()) {
      const TokenKind next = tokens_[last + 1].kind;
      const bool goes_on =
          next == Kinds::NAME || next == Kinds::NEWLINE || is_plain_statement(next);
      if (!goes_on) break;
      for (++last; last < tokens_.size() && !is(last, Kinds::NEWLINE);)
        ++last;
    }
    return std::min(last, tokens_.size());
  }

  // `touch LEVEL > 4 3 TIMES`, `wave_detect THEN touch LEVEL > 0`, each without its WITHIN; and THEN instead of DO
  std::optional<Edit> within() {
    if (!contains(expected_, Kinds::WITHIN) || is_near(text(stop_), "WITHIN")) return std::nullopt;
    const std::size_t next = after_line_ends(before_ + 1);
    const bool asked = is(next, Kinds::DO);
    const Tokens lacking{missing(Kinds::WITHIN, before_ + 1),
                         missing(Kinds::QUANTITY, before_ + 1)};
    if (asked && is(before_, Kinds::TIMES) && before_ > 0 && is(before_ - 1, Kinds::QUANTITY)) {
      report(Code::E0008, "this does not say within what time to count",
             span(before_ - 1, before_ + 1))
          .helps("write `" + text(before_ - 1, before_ + 1) + " WITHIN 5s`");
      return change(before_ + 1, 0, lacking);
    }
    const auto then = then_before(before_);
    if (!then) return std::nullopt;
    if (asked) {
      report(Code::E0008, "this does not say how soon the second part must follow the first",
             tokens_[*then].span)
          .helps("write the time at the end of the condition: `WITHIN 5s`");
      return change(before_ + 1, 0, lacking);
    }
    for (std::size_t at = *then; at < end_; ++at)  // a condition or a duration follows THEN
      if (is_relation(tokens_[at].kind) ||
          is_one_of(tokens_[at].kind, {Kinds::IS, Kinds::WITHIN, Kinds::DO}))
        return std::nullopt;
    report(Code::E0001, "a condition ends with `DO` in RSL, not with `THEN`", tokens_[*then].span)
        .fix(tokens_[*then].span, "DO", Applicability::likely);
    return change(*then, 1, {{Kinds::DO, tokens_[*then].span}});
  }

  // The THEN between the word that asks and `at`.
  std::optional<std::size_t> then_before(std::size_t at) const {
    for (; at > 0 && !is_one_of(tokens_[at].kind, {Kinds::DO, Kinds::ELSE, Kinds::END}); --at)
      if (is(at, Kinds::THEN) && asks_before(at)) return at;
    return std::nullopt;
  }

  // `MOTION wave`
  std::optional<Edit> columns_of_motion() {
    if (!is(0, Kinds::MOTION) || stop_ != 2 || !is(stop_, Kinds::NEWLINE)) return std::nullopt;
    const Span name = tokens_[1].span;
    report(Code::E0008, "this MOTION does not say which actuators it moves", name)
        .helps("write `MOTION " + std::string(text(1)) +
               " OF` and their names, separated by commas");
    return change(0, tokens_.size());
  }

  // `voice WORD = "hello"`, `wave_detect = TRUE`
  std::optional<Edit> word_with_sign() {
    const bool text = is(stop_, Kinds::STRING);
    const bool truth = is(stop_, Kinds::TRUE) || is(stop_, Kinds::FALSE);
    if (!(text || truth) || stop_ < 2 || !asks_before(stop_)) return std::nullopt;
    const Span sign = tokens_[stop_ - 1].span;
    if (is(stop_ - 1, Kinds::EQUAL)) {
      report(Code::E0001, "words are compared with `IS`, not with " + quote(stop_ - 1), sign)
          .fix(sign, "IS", Applicability::likely);
      return change(stop_ - 1, 1, {{Kinds::IS, sign}});
    }
    if (!is(stop_ - 1, Kinds::NOT_EQUAL) || truth) return std::nullopt;
    report(Code::E0001, "words are compared with `IS NOT`, not with " + quote(stop_ - 1), sign)
        .fix(sign, "IS NOT", Applicability::likely);
    return change(stop_ - 1, 1, {{Kinds::IS, sign}, {Kinds::NOT, sign}});
  }

  // `SET x BY 3`, `SET x`, `RAISE x TO 3`, `RAISE x 3`, `RAISE x`
  std::optional<Edit> changed_wrongly() {
    const bool raises = begins_with(Kinds::RAISE) || begins_with(Kinds::LOWER);
    if (stop_ != statement_ + 2 || !(raises || begins_with(Kinds::SET))) return std::nullopt;
    const std::string word(text(statement_)), name(text(statement_ + 1));
    const std::string rest = text(stop_ + 1, statement_end());
    const Span here = tokens_[stop_].span, all = span(statement_, stop_);
    const bool ends = stop_ == statement_end();
    if (!raises && is(stop_, Kinds::BY)) {
      say(Code::E0001, here, "`SET` takes `TO` and a new value; `BY` goes with `RAISE` or `LOWER`",
          "write `{0} {1} TO {2}` or `RAISE {1} BY {2}`", word, name, rest);
      return change(stop_, 1, {{Kinds::TO, here}});
    }
    if (raises && is(stop_, Kinds::TO)) {
      say(Code::E0001, here, "`{0}` takes `BY` and an amount; to give a new value, use `SET`",
          "write `{0} {1} BY {2}` or `SET {1} TO {2}`", word, name, rest);
      return change(stop_, 1, {{Kinds::BY, here}});
    }
    if (!is(stop_ - 1, Kinds::NAME)) return std::nullopt;
    if (raises && is(stop_, Kinds::QUANTITY)) {
      say(Code::E0008, here, "`BY` is missing after `{1}`", "write `{0} {1} BY {2}`", word, name,
          text(stop_, statement_end()))
          .fix({here.file, here.begin, here.begin}, "BY ", Applicability::likely);
      return change(stop_, 0, {missing(Kinds::BY, stop_)});
    }
    if (!ends) return std::nullopt;
    say(Code::E0008, all,
        raises ? "this does not say by how much `{1}` changes"
               : "this does not say what `{1}` becomes",
        raises ? "write `{0} {1} BY 1`" : "write `{0} {1} TO` and a value, such as `{0} {1} TO 1`",
        word, name, rest);
    return change(
        stop_, 0,
        {missing(raises ? Kinds::BY : Kinds::TO, stop_), missing(Kinds::QUANTITY, stop_)});
  }

  // `REPEAT`
  std::optional<Edit> repeat_how_often() {
    if (!begins_with(Kinds::REPEAT) || stop_ != statement_ + 1 || !is(stop_, Kinds::NEWLINE))
      return std::nullopt;
    report(Code::E0008, "this does not say how often to repeat", tokens_[statement_].span)
        .helps("write `REPEAT 3 TIMES`, `REPEAT WHILE` and a condition, or `REPEAT FOREVER`");
    return change(stop_, 0, {missing(Kinds::QUANTITY, stop_), missing(Kinds::TIMES, stop_)});
  }

  // `RESUME AFTER 2s`
  std::optional<Edit> resume_after() {
    if (stop_ == 0 || !is(stop_ - 1, Kinds::RESUME)) return std::nullopt;
    if (!is_any_name(stop_, {"AFTER", "IN"}) && !is(stop_, Kinds::QUANTITY) &&
        !is(stop_, Kinds::FOR))
      return std::nullopt;
    const std::string time = is(end_ - 1, Kinds::QUANTITY) ? text(end_ - 1, end_) : "2s";
    report(Code::E0001, "the robot resumes when a condition holds, not after a time alone",
           span(stop_ - 1, end_))
        .helps("write `RESUME WHEN`, a condition and `FOR " + time + "`");
    return change(stop_, end_ - stop_,
                  {missing(Kinds::WHEN, stop_), missing(Kinds::QUANTITY, stop_),
                   missing(Kinds::LESS, stop_), missing(Kinds::QUANTITY, stop_)});
  }

  // COOLDOWN and the like, below DO
  std::optional<Edit> modifier_behind_do() {
    const bool modifier = is_one_of(
        tokens_[stop_].kind, {Kinds::PRIORITY, Kinds::COOLDOWN, Kinds::WAITING, Kinds::RESTARTING});
    const auto block = open_block();
    const bool whole = is(stop_, Kinds::RESTARTING) || is(stop_ + 1, Kinds::QUANTITY);
    if (!modifier || !whole || stop_ != begin_ || !block || !has(*block, stop_, Kinds::DO))
      return std::nullopt;
    report(Code::E0010, quote(stop_) + " goes before the `DO` of its rule", tokens_[stop_].span)
        .label(tokens_[*block].span, "the rule begins here", false);
    return change(stop_, end_ - stop_);
  }

  // `OTHERWISE SAY "y"`
  std::optional<Edit> otherwise() {
    if (!is(stop_, Kinds::OTHERWISE) || stop_ != begin_ || is(0, Kinds::CHECK)) return std::nullopt;
    const auto block = open_block();
    if (!block || !(is(*block, Kinds::WHEN) || is(*block, Kinds::IF))) return std::nullopt;
    const Span here = tokens_[stop_].span;
    report(Code::E0007, quote(stop_) + " is written `ELSE` in a rule", here)
        .fix(here, "ELSE", Applicability::likely);
    return change(stop_, 1, {{Kinds::ELSE, here}});
  }

  // `touch LEVEL more than 4`, `touch LEVEL IS less than 4`, `proximity IS NOT closer than 30cm`
  std::optional<Edit> more_than() {
    for (const std::size_t than : {stop_ + 1, stop_, stop_ - 1, before_ - 1}) {
      if (!is_name(than, "than") || than == 0) continue;
      const std::size_t first = than - 1;
      const bool more = has_word(kMoreWords, text(first));
      const bool less = has_word(kLessWords, text(first));
      if (!(more || less) || first == 0 || !asks_before(first)) return std::nullopt;
      const bool negated = is(first - 1, Kinds::NOT) && is(first - 2, Kinds::IS);
      const std::size_t begin = first - (negated ? 2 : is(first - 1, Kinds::IS) ? 1 : 0);
      return compared(begin, than, more, negated);
    }
    return std::nullopt;
  }
  // From `begin` to `than`.
  Edit compared(std::size_t begin, std::size_t than, bool more, bool negated) {
    const Span all = span(begin, than + 1);
    const TokenKind plain = more ? Kinds::GREATER : Kinds::LESS;
    const TokenKind kind = negated ? opposite_of(plain).kind : plain;
    const std::string sign(opposite_of(opposite_of(kind).kind).spelling);
    Diagnostic& d =
        report(Code::E0001, "`" + text(begin, than + 1) + "` is written `" + sign + "`", all)
            .fix(all, sign, Applicability::likely);
    std::size_t value = begin;
    while (value > 0 && is(value - 1, Kinds::NAME))
      --value;
    if (value < begin && is(than + 1, Kinds::QUANTITY))
      d.helps(fmt::format("write `{} {} {}`", text(value, begin), sign, text(than + 1)));
    return change(begin, than + 1 - begin, {{kind, all}});
  }
};

}  // namespace

std::optional<Edit> explain_misplaced_word(const Tokens& tokens, const SourceFile& source,
                                           const Attempt& failure, Diagnostics& diagnostics) {
  return MisplacedWords(tokens, source, failure, diagnostics).find();
}

}  // namespace robosync::compiler
