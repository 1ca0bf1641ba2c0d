// Lines of RSL in a form that RSL lacks, as beginners write them: two words as a name, a FOR in the middle of a condition, a
// number after BECOMES. See habits.hpp.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/mistaken_line.hpp"

namespace robosync::compiler {
namespace {

using Kindlist = std::initializer_list<TokenKind>;

bool is_small(char c) {
  return c >= 'a' && c <= 'z';
}
bool is_name_letter(char c) {
  return ascii::is_letter(c) || ascii::is_digit(c) || c == '_';
}
bool has_small(std::string_view word) {
  return std::ranges::any_of(word, is_small);
}

class WrongForms : private MistakenLine {
public:
  using MistakenLine::MistakenLine;

  std::optional<Edit> find() {
    if (auto edit = empty_define()) return edit;
    if (stop_ >= tokens_.size()) return std::nullopt;
    using Form = std::optional<Edit> (WrongForms::*)();
    for (const Form form : {&WrongForms::name_of_words,
                            &WrongForms::ended_condition,
                            &WrongForms::becomes,
                            &WrongForms::once,
                            &WrongForms::waits,
                            &WrongForms::step,
                            &WrongForms::text_before_more,
                            &WrongForms::stop_for,
                            &WrongForms::item,
                            &WrongForms::parameters,
                            &WrongForms::at_time,
                            &WrongForms::word_behind_define,
                            &WrongForms::counted_up,
                            &WrongForms::words_of_state,
                            &WrongForms::block_outside,
                            &WrongForms::channel_of,
                            &WrongForms::priority_of_safety,
                            &WrongForms::half_comparison,
                            &WrongForms::within_alone,
                            &WrongForms::value_below,
                            &WrongForms::one_of_commands,
                            &WrongForms::start_alone,
                            &WrongForms::start_modified,
                            &WrongForms::start_of_rule})
      if (auto edit = (this->*form)()) return edit;
    return std::nullopt;
  }

private:
  // These tokens, which the text lacks, instead of `removed` ones.
  Edit instead(std::size_t at, std::size_t removed, Kindlist kinds) const {
    Tokens inserted;
    for (const TokenKind kind : kinds)
      inserted.push_back(missing(kind, at));
    return change(at, removed, std::move(inserted));
  }

  // ---- names

  struct Named {
    TokenKind keyword, then, or_then;  // the word of a declaration, and what follows its name
  };
  static constexpr Named kNamed[] = {
      {Kinds::REMEMBER, Kinds::EQUAL, Kinds::EQUAL},
      {Kinds::LET, Kinds::EQUAL, Kinds::EQUAL},
      {Kinds::STATE, Kinds::COLON, Kinds::COLON},
      {Kinds::LIST, Kinds::COLON, Kinds::COLON},
      {Kinds::FEELING, Kinds::FROM, Kinds::FROM},
      {Kinds::CHECK, Kinds::OF, Kinds::OF},
      {Kinds::MOTION, Kinds::OF, Kinds::OF},
      {Kinds::TIMER, Kinds::NEWLINE, Kinds::KEPT},
      {Kinds::BEHAVIOR, Kinds::PRIORITY, Kinds::NEWLINE},
      {Kinds::SAFETY, Kinds::WHEN, Kinds::NEWLINE},
      {Kinds::DEFINE, Kinds::WITH, Kinds::NEWLINE},
  };

  // `TIMER my timer`, `REMEMBER my-number = 0`, `LET 2nd = 3`
  std::optional<Edit> name_of_words() {
    const std::size_t first = statement_ + 1;
    const bool list =
        is_name(statement_, "LIST");  // only before a name and a colon is it a keyword
    const auto* const named = std::ranges::find_if(kNamed, [&](const Named& one) {
      return begins_with(one.keyword) || (list && one.keyword == Kinds::LIST);
    });
    if (named == std::end(kNamed) || stop_ > first + 2) return std::nullopt;
    std::size_t at = first;
    while (at < end_ && is_part_of_name(at) &&
           !is_one_of(tokens_[at].kind, {named->then, named->or_then}))
      ++at;
    const bool whole = is(at, named->then) || is(at, named->or_then);
    const bool plain = at == first + 1 && !is(first, Kinds::QUANTITY);
    if (at == first || plain || !whole || !is_meant(*named, first, at)) return std::nullopt;
    Edit edit = change(statement_, at - statement_, {{named->keyword, tokens_[statement_].span}});
    edit.inserted.push_back({Kinds::NAME, span(first, at)});
    report_name(first, at);
    return edit;
  }

  bool is_part_of_name(std::size_t at) const {
    if (is(at, Kinds::QUANTITY)) return at == statement_ + 1;
    if (is(at, Kinds::KEPT)) return false;
    return is(at, Kinds::MINUS) ||
           (!text(at).empty() && std::ranges::all_of(text(at), is_name_letter));
  }

  // A word of RSL in capitals, or a slip of one, begins something else where the end of the line may follow the name.
  bool is_meant(const Named& named, std::size_t first, std::size_t end) const {
    if (is(first, Kinds::QUANTITY) && end == first + 1)
      return std::ranges::any_of(text(first), [](char c) { return !ascii::is_digit(c); });
    for (std::size_t at = first; at < end; ++at) {
      const bool touches = at > first && tokens_[at].span.begin == tokens_[at - 1].span.end;
      if (is(at, Kinds::MINUS) ? !touches : is(at - 1, Kinds::MINUS) && !touches) return false;
      if (is(at, Kinds::MINUS) || named.then == named.or_then) continue;
      if (!has_small(text(at)) || is_near(text(at), "WITH") || is_near(text(at), "WHEN"))
        return false;
    }
    return true;
  }

  void report_name(std::size_t first, std::size_t end) {
    std::string better;
    bool sign = false;
    for (std::size_t at = first; at < end; ++at) {
      sign = sign || is(at, Kinds::MINUS);
      if (is(at, Kinds::MINUS)) continue;
      better += (better.empty() ? "" : "_") + std::string(text(at));
    }
    const Span name = span(first, end);
    if (ascii::is_digit(better.front())) {
      report(Code::E0001, "a name begins with a letter", name)
          .helps("choose another name, with the number at its end: `name2`");
      return;
    }
    Diagnostic& d = report(
        Code::E0001, sign ? "a name has only letters, digits and `_`" : "a name is one word", name);
    d.helps("write `" + better + "`").fix(name, better, Applicability::likely);
    if (begins_with(Kinds::DEFINE) && !sign)
      d.helps(
          fmt::format("to pass values, write `DEFINE {0} WITH {1}`", text(first), text(first + 1)));
  }

  // ---- conditions

  // `touch LEVEL > 4 FOR 1s OR …`: FOR is about all that is asked before it. `WAIT UNTIL touch LEVEL > 4 FOR 1s WITHIN 5s`
  std::optional<Edit> ended_condition() {
    const bool counts = is(stop_, Kinds::QUANTITY) && is(stop_ + 1, Kinds::TIMES);
    const bool ends_waiting = is(stop_, Kinds::WITHIN) && begins_with(Kinds::WAIT);
    if (!counts && !ends_waiting &&
        !is_one_of(tokens_[stop_].kind, {Kinds::AND, Kinds::OR, Kinds::THEN}))
      return std::nullopt;
    std::size_t first = stop_, end = 0;
    for (int depth = 0; first > 0 && !begins_question(tokens_[first - 1].kind); --first) {
      const TokenKind kind = tokens_[first - 1].kind;
      if (kind == Kinds::CLOSE) ++depth;
      if (kind == Kinds::OPEN && depth-- == 0) break;
      if (is_one_of(kind, {Kinds::DO, Kinds::END, Kinds::COOLDOWN, Kinds::MARGIN, Kinds::PRIORITY,
                           Kinds::WAITING, Kinds::RESTARTING}))
        return std::nullopt;
      if (depth == 0 && is_one_of(kind, {Kinds::FOR, Kinds::TIMES})) end = first - 1;
    }
    if (end <= first) return std::nullopt;
    const std::string better = "(" + text(first, stop_) + ")";
    say(Code::E0001, tokens_[stop_].span, "`{0}` ends a condition, so `{1}` cannot follow it",
        "to combine it, put it in brackets: `{2} {1} …`", text(end),
        text(stop_, stop_ + (counts ? 2 : 1)), better)
        .fix(span(first, stop_), better, Applicability::likely);
    Edit edit = change(first, stop_ - first, {missing(Kinds::OPEN, first)});
    edit.inserted.insert(edit.inserted.end(), tokens_.begin() + static_cast<std::ptrdiff_t>(first),
                         tokens_.begin() + static_cast<std::ptrdiff_t>(stop_));
    edit.inserted.push_back(missing(Kinds::CLOSE, stop_));
    return edit;
  }

  // `WHEN DISTANCE OF proximity < 20cm`
  std::optional<Edit> channel_of() {
    if (stop_ < begin_ + 2 || !is(stop_, Kinds::OF) || !is(stop_ - 1, Kinds::NAME) ||
        !is(stop_ + 1, Kinds::NAME))
      return std::nullopt;
    const TokenKind before = tokens_[stop_ - 2].kind;
    if (!begins_question(before) && !is_one_of(before, {Kinds::AND, Kinds::OR, Kinds::NOT}))
      return std::nullopt;
    const Span all = span(stop_ - 1, stop_ + 2);
    const std::string better = text(stop_ + 1, stop_ + 2) + " " + text(stop_ - 1, stop_);
    report(Code::E0001, "the sensor stands before what it measures", all)
        .helps("write `" + better + "`")
        .fix(all, better, Applicability::likely);
    return change(stop_ - 1, 3, {tokens_[stop_ + 1], tokens_[stop_ - 1]});
  }

  // `SAFETY careful PRIORITY 99`
  std::optional<Edit> priority_of_safety() {
    if (!begins_with(Kinds::SAFETY) || !is(stop_, Kinds::PRIORITY)) return std::nullopt;
    const std::size_t end = is(stop_ + 1, Kinds::QUANTITY) ? stop_ + 2 : stop_ + 1;
    const Span all = span(stop_, end);
    report(Code::E0009, "SAFETY has no priority: it ranks above every behaviour", all)
        .helps("leave this out")
        .fix(all, "", Applicability::likely);
    return change(stop_, end - stop_);
  }

  // `touch LEVEL > 3 AND < 5`
  std::optional<Edit> half_comparison() {
    const bool joined =
        stop_ > begin_ + 4 && (is(stop_ - 1, Kinds::AND) || is(stop_ - 1, Kinds::OR));
    if (!joined || !is_relation(tokens_[stop_].kind) || !is(stop_ + 1, Kinds::QUANTITY) ||
        !is(stop_ - 2, Kinds::QUANTITY) || !is_relation(tokens_[stop_ - 3].kind) ||
        !asks_before(stop_))
      return std::nullopt;
    const std::string what = asked(stop_ - 3);
    const std::size_t first = first_asked(stop_ - 3);
    if (what.empty() || first == 0 || !begins_comparison(tokens_[first - 1].kind))
      return std::nullopt;
    Diagnostic& message =
        say(Code::E0001, tokens_[stop_].span, "what follows `{1}` is not a condition on its own",
            "write both conditions in full: `{0} {1} {2} {3}`", text(first, stop_ - 1),
            text(stop_ - 1), what, text(stop_, stop_ + 2));
    if (is(stop_ - 1, Kinds::AND) && is_above(stop_ - 3) && is_below(stop_))
      message.helps(fmt::format("or, including both numbers, `{} IS BETWEEN {} AND {}`", what,
                                text(stop_ - 2), text(stop_ + 1)));
    Span front = tokens_[stop_].span;
    front.end = front.begin;
    message.fix(front, what + " ", Applicability::likely);
    return change(stop_, 0,
                  Tokens(tokens_.begin() + static_cast<std::ptrdiff_t>(first),
                         tokens_.begin() + static_cast<std::ptrdiff_t>(stop_ - 3)));
  }
  // After a NOT or a sign, what was meant is not clear.
  static bool begins_comparison(TokenKind kind) {
    return begins_question(kind) || is_one_of(kind, {Kinds::AND, Kinds::OR, Kinds::OPEN});
  }
  bool is_above(std::size_t at) const {
    return is(at, Kinds::GREATER) || is(at, Kinds::GREATER_EQUAL);
  }
  bool is_below(std::size_t at) const { return is(at, Kinds::LESS) || is(at, Kinds::LESS_EQUAL); }

  // `WHEN touch LEVEL > 3 AND WITHIN 2s wave_detect`
  std::optional<Edit> within_first() {
    const std::size_t what = stop_ + 2;
    std::size_t end = what;
    while (end < end_ && !is_one_of(tokens_[end].kind, {Kinds::AND, Kinds::OR, Kinds::DO}))
      ++end;
    if (!is(stop_, Kinds::WITHIN) || !is(stop_ + 1, Kinds::QUANTITY) || end == what ||
        !is(stop_ - 1, Kinds::AND))
      return std::nullopt;
    const Span all = span(stop_ - 1, end);
    const std::string better = fmt::format("THEN {} {}", text(what, end), text(stop_, what));
    say(Code::E0001, span(stop_, what), "`WITHIN` and its time end a condition",
        "if the second comes after the first, write `… {0}`", better)
        .fix(all, better, Applicability::likely);
    return change(stop_ - 1, end - stop_ + 1);
  }

  // `WHEN touch LEVEL > 3 WITHIN 3s`
  std::optional<Edit> within_alone() {
    if (!is(stop_, Kinds::WITHIN) || !is(stop_ + 1, Kinds::QUANTITY)) return std::nullopt;
    if (is(stop_ - 1, Kinds::AND)) return within_first();
    std::size_t first = stop_;
    while (first > 0 && !begins_question(tokens_[first - 1].kind))
      if (is_one_of(tokens_[--first].kind,
                    {Kinds::DO, Kinds::FOR, Kinds::TIMES, Kinds::THEN, Kinds::END}))
        return std::nullopt;
    if (first == 0 || first == stop_ ||
        !is_one_of(tokens_[first - 1].kind, {Kinds::WHEN, Kinds::WHILE}))
      return std::nullopt;
    say(Code::E0001, span(stop_, stop_ + 2),
        "`WITHIN` counts how often a condition becomes true, but this does not say how many "
        "`TIMES`",
        "for a condition that stays true that long, write `{0} FOR {1}`", text(first, stop_),
        text(stop_ + 1))
        .helps(fmt::format("to count, write `{} 2 TIMES WITHIN {}`", text(first, stop_),
                           text(stop_ + 1)));
    return change(stop_, 1, {{Kinds::FOR, tokens_[stop_].span}});
  }

  // `COOLDOWN`, and `3s` on the line below
  std::optional<Edit> value_below() {
    const bool ends =
        stop_ > 0 && is(stop_, Kinds::NEWLINE) &&
        is_one_of(tokens_[stop_ - 1].kind, {Kinds::COOLDOWN, Kinds::MARGIN, Kinds::PRIORITY});
    const std::size_t next = after_line_ends(stop_);
    if (!ends || !is(next, Kinds::QUANTITY)) return std::nullopt;
    Span gap = tokens_[stop_ - 1].span;
    gap.begin = gap.end;
    gap.end = tokens_[next].span.begin;
    Diagnostic& message =
        say(Code::E0001, tokens_[next].span, "`{1}` belongs at the end of the line above",
            "write `{0} {1}`", text(stop_ - 1), text(next));
    if (source_.text(gap).find_first_of("#%") == std::string_view::npos)
      message.fix(gap, " ", Applicability::likely);
    return change(stop_, next - stop_);
  }

  // The first word of the sensor or variable before the word at `sign`.
  std::size_t first_asked(std::size_t sign) const {
    while (sign > begin_ && is(sign - 1, Kinds::NAME))
      --sign;
    return sign;
  }

  // The sensor or variable before the word at `sign`.
  std::string asked(std::size_t sign) const { return text(first_asked(sign), sign); }

  // `touch LEVEL BECOMES 3`, `wave_detect BECOMES TRUE`
  std::optional<Edit> becomes() {
    if (stop_ == 0 || !is(stop_ - 1, Kinds::BECOMES)) return std::nullopt;
    const Span sign = tokens_[stop_ - 1].span;
    const std::string what = asked(stop_ - 1);
    if (is(stop_, Kinds::QUANTITY)) {
      say(Code::E0001, sign, "`BECOMES` takes a word, but `{1}` is a number",
          "compare a number with a sign: `{0} = {1}`", what, text(stop_))
          .fix(sign, "=", Applicability::likely);
      return change(stop_ - 1, 1, {{Kinds::EQUAL, sign}});
    }
    if (!is(stop_, Kinds::TRUE) && !is(stop_, Kinds::FALSE)) return std::nullopt;
    say(Code::E0001, span(stop_ - 1, stop_ + 1), "`BECOMES` takes a word, not `{1}`",
        is(stop_, Kinds::TRUE) ? "`WHEN {0}` already acts once, when it becomes true"
                               : "`WHEN NOT {0}` acts once, when it becomes false",
        what, text(stop_));
    return change(stop_ - 1, 1, {{Kinds::IS, sign}});
  }

  // `WHEN touch LEVEL > 3 ONCE DO`
  std::optional<Edit> once() {
    const std::size_t at = is_name(stop_, "ONCE") ? stop_ : before_;
    if (!is_name(at, "ONCE") || at == 0 || !asks_before(at)) return std::nullopt;
    Span word = tokens_[at].span;
    Diagnostic& d =
        say(Code::E0009, word, "`WHEN` already acts once, as soon as its condition is true",
            "leave out `{0}`", text(at));
    word.begin = tokens_[at - 1].span.end;
    d.fix(word, "", Applicability::likely);
    return change(at, 1);
  }

  // ---- statements

  // `WAIT WHILE …`, `WAIT 2s UNTIL …`; WAIT UNTIL in a TEST
  std::optional<Edit> waits() {
    if (!begins_with(Kinds::WAIT)) return std::nullopt;
    const std::string asked = text(stop_ + 1, statement_end());
    const bool test = is(0, Kinds::TEST), until = is(stop_, Kinds::UNTIL);
    const Span here = tokens_[stop_].span;
    if (test && until && !asked.empty()) {
      say(Code::E0001, here, "in a TEST, `WAIT` takes a time",
          has(stop_, end_, Kinds::WITHIN)
              ? "to check a condition, write `EXPECT THAT {0}`"
              : "to check a condition, write `EXPECT THAT {0} WITHIN 5s`",
          asked);
      return instead(stop_, end_ - stop_, {Kinds::QUANTITY});
    }
    if (test || asked.empty()) return std::nullopt;
    if (is(stop_, Kinds::WHILE) && stop_ == statement_ + 1) {
      say(Code::E0001, here, "`WAIT` waits for a time or `UNTIL` a condition is true",
          "write `WAIT UNTIL NOT ({0})`", asked);
      return instead(stop_, 1, {Kinds::UNTIL});
    }
    if (!until || stop_ != statement_ + 2) return std::nullopt;
    say(Code::E0001, here, "`WAIT` takes a time or `UNTIL`, not both",
        "write two lines, `WAIT {0}` and `WAIT UNTIL {1}`, or, to wait no longer than that, "
        "`WAIT UNTIL {1} WITHIN {0}`",
        text(stop_ - 1), asked);
    return instead(stop_, 0, {Kinds::NEWLINE, Kinds::WAIT});
  }

  // Steps of a TEST: `AT 1s voice WORD IS hello`, `AT 3s hey`
  std::optional<Edit> step() {
    if (!is(0, Kinds::TEST) || !is(begin_, Kinds::AT) || !is(begin_ + 1, Kinds::QUANTITY))
      return std::nullopt;
    if (is(stop_, Kinds::IS) && !is(stop_ + 1, Kinds::NOT)) {
      const Span sign = tokens_[stop_].span;
      const char* const quote = is(stop_ + 1, Kinds::NAME) ? "\"" : "";
      say(Code::E0001, sign, "a step gives a sensor its value with `=`, not with `IS`",
          "write `{0} = {2}{1}{2}`", text(begin_ + 2, stop_), text(stop_ + 1, end_), quote)
          .fix(sign, "=", Applicability::likely);
      return change(stop_, 1, {{Kinds::EQUAL, sign}});
    }
    for (std::size_t at = begin_ + 2; at < end_; ++at)
      if (!is(at, Kinds::NAME)) return std::nullopt;
    if (end_ < begin_ + 3 || end_ > begin_ + 4) return std::nullopt;
    say(Code::E0008, span(begin_ + 2, end_), "this step does not say what the sensor measures",
        "write a value after `=`, such as `AT {0} touch LEVEL = 3`", text(begin_ + 1));
    return instead(begin_, end_ - begin_, {Kinds::WAIT, Kinds::QUANTITY});
  }

  // `SAY "Hello", touch LEVEL FOR 3s`
  std::optional<Edit> text_before_more() {
    std::size_t more = stop_, end = statement_end();
    if (!is_preposition(tokens_[more].kind) && is_preposition_at(more + 1)) ++more;
    if (!begins_with(Kinds::NAME) || !is_preposition_at(more) || !is(more + 1, Kinds::QUANTITY) ||
        !has_comma(statement_, more) || is(0, Kinds::TEST))
      return std::nullopt;
    std::size_t words = statement_;
    while (words < more && !is(words, Kinds::STRING))
      ++words;
    if (words == more || end != more + 2) return std::nullopt;
    const std::string what = text(more, end);
    const std::string better = text(statement_, words) + " " + what + " " + text(words, more);
    say(Code::E0001, span(more, end), "the text is the last part of a command", "write `{0}`",
        better)
        .fix(span(statement_, end), better, Applicability::likely);
    return change(more, end - more);
  }
  bool is_preposition_at(std::size_t at) const {
    return at < end_ && is_preposition(tokens_[at].kind);
  }

  // `STOP arms FOR 3s`
  std::optional<Edit> stop_for() {
    if (!begins_with(Kinds::STOP) || stop_ != statement_ + 2 || !is(stop_, Kinds::FOR))
      return std::nullopt;
    const std::size_t end = statement_end();
    say(Code::E0001, span(stop_, end), "`STOP` takes no `FOR`: what it stops stays still",
        "write `{0}`, and `WAIT {1}` on the next line", text(statement_, stop_),
        text(stop_ + 1, end));
    return change(stop_, end - stop_);
  }

  // `ITEM OF jokes`, `MOVE head TO ITEM 1 OF poses`
  std::optional<Edit> item() {
    if (is(stop_, Kinds::OF) && is_name(stop_ - 1, "ITEM") && is(stop_ + 1, Kinds::NAME)) {
      say(Code::E0008, span(stop_ - 1, stop_ + 2), "`ITEM` needs the position in the LIST",
          "write a number after it, such as `ITEM 1 OF {0}`", text(stop_ + 1));
      const Span word = tokens_[stop_ - 1].span;
      return change(stop_ - 1, 1, {{Kinds::ITEM, word}, missing(Kinds::QUANTITY, stop_)});
    }
    if (!is(stop_, Kinds::ITEM) || stop_ == 0 || !is_preposition(tokens_[stop_ - 1].kind))
      return std::nullopt;
    std::size_t end = stop_;
    while (end < end_ && !is(end, Kinds::OF))
      ++end;
    if (end + 2 > end_) return std::nullopt;
    const Span all = span(stop_, end + 2);
    const std::string better = "(" + text(stop_, end + 2) + ")";
    say(Code::E0505, all, "an `ITEM` needs brackets here", "write `{0}`", better)
        .fix(all, better, Applicability::likely);
    return instead(stop_, end + 2 - stop_, {Kinds::QUANTITY});
  }

  // `DEFINE foo WITH x y`
  std::optional<Edit> parameters() {
    if (!begins_with(Kinds::DEFINE) || !is(statement_ + 2, Kinds::WITH) || stop_ < statement_ + 4 ||
        !is(stop_ - 1, Kinds::NAME))
      return std::nullopt;
    for (std::size_t at = stop_; at < end_; ++at)
      if (!is(at, Kinds::COMMA) && !(is(at, Kinds::NAME) && has_small(text(at))))
        return std::nullopt;
    if (!is(stop_, Kinds::NAME)) return std::nullopt;
    Span gap = tokens_[stop_ - 1].span;
    gap.begin = gap.end;
    say(Code::E0008, tokens_[stop_].span, "a comma is missing between `{0}` and `{1}`",
        "write `{0}, {1}`", text(stop_ - 1), text(stop_))
        .fix(gap, ",", Applicability::likely);
    return instead(stop_, 0, {Kinds::COMMA});
  }

  // `DEFINE greet`, and then the next rule or the end
  std::optional<Edit> empty_define() {
    if (!is(0, Kinds::DEFINE) || !is(1, Kinds::NAME) || stop_ < 2) return std::nullopt;
    const std::size_t next = after_line_ends(2);
    const bool rule =
        is_rule(next) && indentation(tokens_[next], source_) <= indentation(tokens_[0], source_);
    if (next == 2 || stop_ > next || !(rule || next == tokens_.size())) return std::nullopt;
    Diagnostic& d = say(Code::E0005, tokens_[0].span, "this `DEFINE` has no commands and no `END`",
                        "write the commands that `{0}` stands for, then `END`", text(1));
    if (rule) d.label(tokens_[next].span, "a rule begins here", false);
    return instead(3, next - 3,
                   {Kinds::LOG, Kinds::STRING, Kinds::NEWLINE, Kinds::END, Kinds::NEWLINE});
  }
  bool is_rule(std::size_t at) const {
    return at < tokens_.size() &&
           is_one_of(tokens_[at].kind, {Kinds::WHEN, Kinds::WHILE, Kinds::EVERY, Kinds::AT});
  }

  // `DEFINE greet DO`, `DEFINE greet AS`
  std::optional<Edit> word_behind_define() {
    const std::size_t word = statement_ + 2, next = after_line_ends(word + 1);
    const bool foreign =
        is(word, Kinds::DO) || is(word, Kinds::IS) || is_any_name(word, {"AS", "MEANS"});
    if (!begins_with(Kinds::DEFINE) || !is(statement_ + 1, Kinds::NAME) || stop_ != word ||
        !foreign || next == word + 1)
      return std::nullopt;
    say(Code::E0009, tokens_[word].span,
        "the first line of a DEFINE ends with its name, without `{0}`", "write `DEFINE {1}`",
        text(word), text(statement_ + 1))
        .fix(tokens_[word].span, "", Applicability::likely);
    // That there is nothing in it is no second mistake.
    if (is(next, Kinds::END)) return instead(word, 1, {Kinds::NEWLINE, Kinds::LOG, Kinds::STRING});
    if (!is_rule(next) && next < tokens_.size()) return change(word, 1);
    return instead(word, 1,
                   {Kinds::NEWLINE, Kinds::LOG, Kinds::STRING, Kinds::NEWLINE, Kinds::END});
  }

  // `AT 5s DO`
  std::optional<Edit> at_time() {
    const bool begins = is(stop_, Kinds::QUANTITY) && stop_ == begin_ + 1 && is(begin_, Kinds::AT);
    if (!begins || !(is(stop_ + 1, Kinds::DO) || is(stop_ + 2, Kinds::DO))) return std::nullopt;
    say(Code::E0010, span(begin_, stop_ + 1), "a rule cannot begin with `AT {0}`",
        "to act once after the start, write `AT START DO`, then `WAIT {0}`", text(stop_))
        .helps(fmt::format("to act again and again, write `EVERY {0} DO`", text(stop_)));
    return change(begin_, 1, {{Kinds::EVERY, tokens_[begin_].span}});
  }

  // `SET n TO n++`
  std::optional<Edit> counted_up() {
    const bool up = is(stop_, Kinds::PLUS) && is(stop_ - 1, Kinds::PLUS);
    if (!begins_with(Kinds::SET) || !(up || is(before_, Kinds::MINUS)) || stop_ < statement_ + 5 ||
        text(statement_ + 1) != text(statement_ + 3) ||
        tokens_[statement_ + 4].kind != tokens_[statement_ + 5].kind)
      return std::nullopt;
    const Span all = span(statement_, statement_ + 6);
    const std::string better =
        fmt::format(fmt::runtime(up ? "RAISE {0} BY 1" : "LOWER {0} BY 1"), text(statement_ + 1));
    say(Code::E0001, span(statement_ + 4, statement_ + 6), "RSL does not use `{0}`", "write `{1}`",
        up ? "++" : "--", better)
        .fix(all, better, Applicability::likely);
    return change(statement_ + 4, 2);
  }

  // `RANDOM SAY "a" OR "b"`, `SAY "a" OR "b"`
  std::optional<Edit> one_of_commands() {
    const auto block = open_block();
    const bool random = is(stop_, Kinds::RANDOM) && stop_ == statement_ && stop_ + 1 < end_;
    const bool texts = is(stop_, Kinds::OR) && begins_with(Kinds::NAME) &&
                       is(stop_ - 1, Kinds::STRING) && is(stop_ + 1, Kinds::STRING);
    if (!(random || texts) || asks_before(stop_) || !block ||
        is_one_of(tokens_[*block].kind, {Kinds::TEST, Kinds::CHECK, Kinds::MOTION}))
      return std::nullopt;
    const std::size_t end = statement_end();
    const std::vector<std::string> commands = alternatives(random ? stop_ + 1 : statement_, end);
    const std::string help =
        commands.size() == 2
            ? fmt::format(
                  "write `PICK ONE`, `OPTION 50%`, `{}`, `OPTION 50%`, `{}` and `END`, "
                  "each on its own line",
                  commands[0], commands[1])
            : "write `PICK ONE` and, for each command, `OPTION` with its chance, such as `OPTION "
              "50%`";
    report(Code::E0001,
           random ? "`RANDOM` picks a number: `RANDOM(1, 6)`"
                  : "`OR` joins conditions; a command has one text",
           tokens_[stop_].span)
        .helps(random ? "to do one of several things, " + help : help);
    return change(statement_, end - statement_,
                  {missing(Kinds::LOG, statement_), missing(Kinds::STRING, statement_)});
  }

  // The commands between the ORs. A text alone is the text of the first command.
  std::vector<std::string> alternatives(std::size_t first, std::size_t end) const {
    std::size_t words = first;
    while (words < end && !is_one_of(tokens_[words].kind, {Kinds::STRING, Kinds::OR}))
      ++words;
    const std::string verb = text(first, words) + " ";
    std::vector<std::string> found;
    for (std::size_t at = first; at <= end; ++at) {
      if (at < end && !is(at, Kinds::OR)) continue;
      found.push_back((first > words && is(first, Kinds::STRING) ? verb : "") + text(first, at));
      first = at + 1;
    }
    return found;
  }

  // `START DO`
  std::optional<Edit> start_alone() {
    if (stop_ != begin_ || !is(stop_, Kinds::START)) return std::nullopt;
    const std::size_t next = after_line_ends(stop_ + 1);
    if (!is(next, Kinds::DO)) return std::nullopt;
    Span front = tokens_[stop_].span;
    front.end = front.begin;
    report(Code::E0008, "`AT` is missing before `START`", front)
        .fix(front, "AT ", Applicability::likely);
    return change(stop_, 0, {missing(Kinds::AT, stop_)});
  }

  // `AT START COOLDOWN 3s DO`
  std::optional<Edit> start_modified() {
    if (!is(before_, Kinds::START) ||
        !is_one_of(tokens_[stop_].kind, {Kinds::COOLDOWN, Kinds::MARGIN, Kinds::RESTARTING,
                                         Kinds::WAITING, Kinds::PRIORITY}))
      return std::nullopt;
    std::size_t last = stop_;
    while (last < end_ && !is(last, Kinds::DO))
      ++last;
    report(Code::E0010, quote(stop_) + " does not go with `AT START`, which happens once",
           span(stop_, last));
    return change(stop_, last - stop_);
  }

  // `START`, and commands on the lines below
  std::optional<Edit> start_of_rule() {
    const auto block = open_block();
    const std::size_t behind = stop_ + (is(stop_ + 1, Kinds::COLON) ? 2 : 1);
    if (stop_ != begin_ || !is(stop_, Kinds::START) || end_ != behind ||
        (block && !is(*block, Kinds::BEHAVIOR)))
      return std::nullopt;
    const std::size_t next = after_line_ends(end_);
    if (next >= tokens_.size() || is(next, Kinds::DO)) return std::nullopt;
    const Span here = span(stop_, behind);
    say(Code::E0001, here, "a rule cannot begin with `{0}`",
        "to act once after the start, write `AT START DO`, and `END` after the commands",
        text(stop_))
        .fix(here, "AT START DO", Applicability::likely);
    return change(stop_, behind - stop_,
                  {missing(Kinds::AT, stop_), tokens_[stop_], missing(Kinds::DO, stop_)});
  }

  // ---- items

  // `STATE mood: "calm", "happy"`
  std::optional<Edit> words_of_state() {
    const std::size_t first = statement_ + 3;
    if (!begins_with(Kinds::STATE) || !is(stop_, Kinds::STRING) || stop_ < first)
      return std::nullopt;
    Edit edit = change(first, end_ - first);
    std::string better;
    for (std::size_t at = first; at < end_; ++at) {
      Token word = tokens_[at];
      if (word.kind == Kinds::STRING && word.span.end > word.span.begin + 2)
        word = {Kinds::NAME, {word.span.file, word.span.begin + 1, word.span.end - 1}};
      if (is_one_of(word.kind, {Kinds::STRING, Kinds::COLON})) return std::nullopt;
      if (!better.empty() && word.kind != Kinds::COMMA) better += ' ';
      better += source_.text(word.span);
      edit.inserted.push_back(word);
    }
    const Span all = span(first, end_);
    say(Code::E0001, all, "the words of a STATE have no quotes", "write `{0}`", better)
        .fix(all, better, Applicability::likely);
    return edit;
  }

  // PICK ONE outside of a rule: left out with all of its lines
  std::optional<Edit> block_outside() {
    const bool block = is(stop_, Kinds::PICK) || is(stop_, Kinds::REPEAT);
    if (!block || stop_ != begin_ || open_block()) return std::nullopt;
    BlockWalk walk(tokens_);
    std::size_t end = 0;
    for (; end < tokens_.size() && (end <= stop_ || !walk.open().empty()); ++end)
      walk.step(end);
    if (!walk.open().empty()) return std::nullopt;
    say(Code::E0001, tokens_[stop_].span, "a line cannot begin with `{0}` here",
        "commands belong in a rule or a DEFINE: `WHEN ... DO ... END`", text(stop_));
    return change(stop_, after_line_ends(end) - stop_);
  }
};

}  // namespace

std::optional<Edit> explain_wrong_form(const Tokens& tokens, const SourceFile& source,
                                       const Attempt& failure, Diagnostics& diagnostics) {
  return WrongForms(tokens, source, failure, diagnostics).find();
}

}  // namespace robosync::compiler
