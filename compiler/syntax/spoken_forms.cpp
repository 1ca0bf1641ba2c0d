// What people say in English for a form of RSL. See habits.hpp.
#include "compiler/source/ascii.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/mistaken_line.hpp"

namespace robosync::compiler {
namespace {

class SpokenForms : private MistakenLine {
public:
  using MistakenLine::MistakenLine;

  std::optional<Edit> find() {
    if (stop_ >= tokens_.size()) return std::nullopt;
    using Form = std::optional<Edit> (SpokenForms::*)();
    for (const Form form :
         {&SpokenForms::within_before_then, &SpokenForms::pick_without_option,
          &SpokenForms::repeat_as_spoken, &SpokenForms::every_time, &SpokenForms::every_range,
          &SpokenForms::counted_step, &SpokenForms::band_as_condition})
      if (auto edit = (this->*form)()) return edit;
    return std::nullopt;
  }

private:
  // `EVERY 10s AND 20s`, `EVERY BETWEEN 10s AND 20s`
  std::optional<Edit> every_range() {
    const std::size_t between = is(statement_ + 1, Kinds::BETWEEN) ? 1 : 0;
    const std::size_t low = statement_ + 1 + between, word = low + 1;
    if (!begins_with(Kinds::EVERY) || stop_ != (between == 1 ? statement_ + 1 : word) ||
        !is(low, Kinds::QUANTITY) || !is(word + 1, Kinds::QUANTITY) ||
        !(is(word, Kinds::AND) || is(word, Kinds::UNTIL) || is(word, Kinds::TO)))
      return std::nullopt;
    const std::string better = text(low, word) + " TO " + text(word + 1, word + 2);
    const Span all = span(statement_ + 1, word + 2);
    say(Code::E0001, all, "a random time between two is written with `TO`", "write `EVERY {0}`",
        better)
        .fix(all, better, Applicability::likely);
    return change(statement_ + 1, word + 1 - statement_,
                  {tokens_[low], {Kinds::TO, tokens_[word].span}, tokens_[word + 1]});
  }

  // `EXPECT 5 TIMES LOG "x" WITHIN 10s`, `EXPECT LOG "x" 5 TIMES`, `EXPECT SAY "x" WITHIN 10s 5 TIMES`
  std::optional<Edit> counted_step() {
    if (!is(begin_, Kinds::EXPECT)) return std::nullopt;
    const bool first = is(begin_ + 1, Kinds::QUANTITY) && is(begin_ + 2, Kinds::TIMES);
    const std::size_t count = first ? begin_ + 1 : stop_, what = begin_ + (first ? 3 : 1);
    if (!is(count, Kinds::QUANTITY) || !is(count + 1, Kinds::TIMES) || (first && stop_ != what))
      return std::nullopt;
    std::string step = text(what, first ? end_ : count);
    if (!first && count + 2 < end_) step += " " + text(count + 2, end_);
    const bool is_text = is(what, Kinds::LOG) || is(what, Kinds::ALERT);
    if (is_text || is(what, Kinds::THAT)) {
      say(Code::E0001, span(count, first ? what + 1 : count + 2),
          "a TEST counts commands, and {1} is not one",
          "write `EXPECT {0}`, or count with a REMEMBER and check it with `EXPECT THAT`", step,
          is_text ? quote(what) : "a condition");
      return change(count, 2);
    }
    if (first || !is(what, Kinds::NAME)) return std::nullopt;
    const std::string times = text(count, count + 2);
    const std::string better = fmt::format("EXPECT {} {}", times, step);
    say(Code::E0010, span(count, count + 2), "in an `EXPECT`, `{0}` goes before the command",
        "write `{1}`", times, better)
        .fix(span(begin_, end_), better, Applicability::likely);
    return change(count, 2);
  }

  // `touch LEVEL > 3 WITHIN 5s THEN touch LEVEL < 2`
  std::optional<Edit> within_before_then() {
    if (!is(stop_, Kinds::WITHIN) || !is(stop_ + 1, Kinds::QUANTITY) ||
        !is(stop_ + 2, Kinds::THEN) || !asks_before(stop_))
      return std::nullopt;
    const std::size_t end = statement_end_from(stop_ + 3);
    const std::string better = text(stop_ + 2, end) + " " + text(stop_, stop_ + 2);
    report(Code::E0001, "`WITHIN` and its time go to the end of the condition",
           span(stop_, stop_ + 2))
        .helps("write `" + better + "`")
        .fix(span(stop_, end), better, Applicability::likely);
    Tokens tokens(at(stop_ + 2), at(end));
    tokens.insert(tokens.end(), at(stop_), at(stop_ + 2));
    return change(stop_, end - stop_, tokens);
  }

  // `PICK ONE`, and then commands
  std::optional<Edit> pick_without_option() {
    if (!begins_with(Kinds::PICK) || stop_ != statement_ + 2 || !is(stop_ - 1, Kinds::ONE) ||
        !is(stop_, Kinds::NEWLINE))
      return std::nullopt;
    const std::size_t first = after_line_ends(stop_);
    if (first == tokens_.size() || is_one_of(tokens_[first].kind, {Kinds::OPTION, Kinds::END}))
      return std::nullopt;
    report(Code::E0008, "`PICK ONE` takes an `OPTION` for each choice", span(statement_, stop_))
        .helps("write `OPTION` on a line of its own before the commands of each choice");
    return change(first, 0, {missing(Kinds::OPTION, first), missing(Kinds::NEWLINE, first)});
  }

  // `REPEAT UNTIL touch LEVEL < 3`, `REPEAT 3x`
  std::optional<Edit> repeat_as_spoken() {
    if (!begins_with(Kinds::REPEAT) || stop_ == tokens_.size()) return std::nullopt;
    const Span here = tokens_[stop_].span;
    if (stop_ == statement_ + 1 && is(stop_, Kinds::UNTIL)) {
      const std::string asked = text(stop_ + 1, end_);
      report(Code::E0001, "`REPEAT UNTIL` is written `REPEAT WHILE NOT` in RSL", here)
          .helps("write `REPEAT WHILE NOT (" + asked + ")`")
          .fix(span(stop_, end_), "WHILE NOT (" + asked + ")", Applicability::likely);
      Tokens tokens = {{Kinds::WHILE, here}, {Kinds::NOT, here}, {Kinds::OPEN, here}};
      tokens.insert(tokens.end(), at(stop_ + 1), at(end_));
      tokens.push_back({Kinds::CLOSE, here});
      return change(stop_, end_ - stop_, tokens);
    }
    if (stop_ != statement_ + 2 || !is(stop_ - 1, Kinds::QUANTITY)) return std::nullopt;
    Span number = tokens_[stop_ - 1].span;
    if (ascii::lower(text(stop_ - 1).back()) != 'x') return std::nullopt;
    --number.end;
    const std::string better = std::string(source_.text(number)) + " TIMES";
    report(Code::E0001, quote(stop_ - 1) + " is written `" + better + "` in RSL",
           tokens_[stop_ - 1].span)
        .fix(tokens_[stop_ - 1].span, better, Applicability::likely);
    return change(stop_ - 1, 1, {{Kinds::QUANTITY, number}, missing(Kinds::TIMES, stop_)});
  }

  // `EVERY TIME touch LEVEL > 3`
  std::optional<Edit> every_time() {
    if (!begins_with(Kinds::EVERY) || !is_name(statement_ + 1, "TIME") || stop_ < statement_ + 2)
      return std::nullopt;
    const Span both = span(statement_, statement_ + 2);
    report(Code::E0001, "`EVERY TIME` is written `WHEN` in RSL", both)
        .fix(both, "WHEN", Applicability::likely);
    return change(statement_, 2, {{Kinds::WHEN, both}});
  }

  // Lines of a CHECK: `far ELSE`, `far > 30cm`
  std::optional<Edit> band_as_condition() {
    if (!is(0, Kinds::CHECK) || stop_ == begin_ || begin_ == 0) return std::nullopt;
    const bool is_else = is(stop_, Kinds::ELSE) && stop_ + 1 == end_;
    const bool above = is(stop_, Kinds::GREATER) || is(stop_, Kinds::GREATER_EQUAL);
    const bool below = is(stop_, Kinds::LESS) || is(stop_, Kinds::LESS_EQUAL);
    if (!is_else && !above && !below) return std::nullopt;
    const std::string better = is_else ? "OTHERWISE" : above ? "ABOVE" : "BELOW";
    const TokenKind kind = is_else ? Kinds::OTHERWISE : above ? Kinds::ABOVE : Kinds::BELOW;
    const Span here = tokens_[stop_].span;
    report(Code::E0001, "a line of a CHECK says `" + better + "`, not " + quote(stop_), here)
        .fix(here, better, Applicability::likely);
    return change(stop_, 1, {{kind, here}});
  }
};

}  // namespace

std::optional<Edit> explain_spoken_form(const Tokens& tokens, const SourceFile& source,
                                        const Attempt& failure, Diagnostics& diagnostics) {
  return SpokenForms(tokens, source, failure, diagnostics).find();
}

}  // namespace robosync::compiler
