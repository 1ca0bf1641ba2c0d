// Habits from other languages. The lexer reports those that it can detect on its own (`&&`, braces, comments); see
// habits.hpp.
#include <fmt/format.h>

#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/mistaken_line.hpp"
#include "compiler/syntax/unit_apart.hpp"
#include "compiler/units/foreign_units.hpp"

namespace robosync::compiler {

namespace {

class ForeignHabits : private MistakenLine {
public:
  using MistakenLine::MistakenLine;

  std::optional<Edit> find() {
    if (stop_ >= tokens_.size()) return std::nullopt;
    using Habit = std::optional<Edit> (ForeignHabits::*)();
    for (const Habit habit :
         {&ForeignHabits::name_of_test, &ForeignHabits::rule_with_if, &ForeignHabits::foreign_else,
          &ForeignHabits::head, &ForeignHabits::again_outside, &ForeignHabits::set_outside,
          &ForeignHabits::comparison, &ForeignHabits::declaration,
          &ForeignHabits::declared_in_block, &ForeignHabits::definition,
          &ForeignHabits::text_in_brackets, &ForeignHabits::set_with_sign,
          &ForeignHabits::assignment, &ForeignHabits::colon, &ForeignHabits::end_of_what,
          &ForeignHabits::negated_truth, &ForeignHabits::truth, &ForeignHabits::decimal_comma}) {
      if (auto edit = (this->*habit)()) return edit;
    }
    return std::nullopt;
  }

private:
  // `TEST who is near is greeted`
  std::optional<Edit> name_of_test() {
    if (!is(0, Kinds::TEST) && !is_name(0, "TEST")) return std::nullopt;
    std::size_t end = 1;
    while (end < tokens_.size() && !is(end, Kinds::NEWLINE))
      ++end;
    if (end == 1 || is(1, Kinds::STRING) || has(1, end, Kinds::STRING)) return std::nullopt;
    const Span name = span(1, end);
    const std::string quoted = "\"" + text(1, end) + "\"";
    report(Code::E0001, "the name of a TEST goes in quotes", name)
        .helps("write `TEST " + quoted + "`")
        .fix(name, quoted);
    return change(0, end, {{Kinds::TEST, tokens_[0].span}, {Kinds::STRING, name}});
  }

  // `IF touch LEVEL > 3 DO` outside of a rule; `ON touch LEVEL > 3 DO`
  std::optional<Edit> rule_with_if() {
    const auto block = open_block();
    const bool outside = stop_ == begin_ && (!block || is(*block, Kinds::BEHAVIOR));
    const bool foreign =
        is_any_name(stop_, {"ON", "WHENEVER", "UPON", "ONCE"}) &&
        (has(stop_, end_, Kinds::DO) || is(end_ + 1, Kinds::DO) || is(end_ - 1, Kinds::COLON));
    if (!outside || is(stop_ + 1, Kinds::START) || !(is(stop_, Kinds::IF) || foreign))
      return std::nullopt;
    report(Code::E0010,
           foreign ? "a rule begins with `WHEN`, not with " + quote(stop_)
                   : "`IF` checks once, inside a rule; a rule begins with `WHEN`",
           tokens_[stop_].span)
        .helps("write `WHEN` instead of this " + quote(stop_))
        .fix(tokens_[stop_].span, "WHEN", Applicability::likely);
    return change(stop_, 1, {{Kinds::WHEN, tokens_[stop_].span}});
  }

  // `ON START`, `ATSTART`, `AFTER 5s DO`, `import moves`, outside of a rule
  std::optional<Edit> head() {
    const auto block = open_block();
    if (stop_ != begin_ || (block && !is(*block, Kinds::BEHAVIOR))) return std::nullopt;
    const Span here = tokens_[stop_].span;
    const bool apart = is_any_name(stop_, {"ON", "UPON"}) && is(stop_ + 1, Kinds::START);
    if (apart || is_any_name(stop_, {"ATSTART", "AT_START", "ONSTART", "ON_START"})) {
      const Span all = apart ? span(stop_, stop_ + 2) : here;
      report(Code::E0007, "`" + std::string(source_.text(all)) + "` is written `AT START` in RSL",
             all)
          .fix(all, "AT START", Applicability::likely);
      return change(stop_, apart ? 2 : 1, {{Kinds::AT, here}, {Kinds::START, all}});
    }
    const bool asks = is(stop_ + 2, Kinds::DO) || is(stop_ + 3, Kinds::DO);
    if (is_any_name(stop_, {"AFTER", "IN"}) && is(stop_ + 1, Kinds::QUANTITY) && asks) {
      const std::string time(text(stop_ + 1));
      report(Code::E0010, "a rule cannot begin with " + quote(stop_), here)
          .helps("to act once after the start, write `AT START DO`, then `WAIT " + time + "`")
          .helps("to act again and again, write `EVERY " + time + " DO`");
      return change(stop_, 1, {{Kinds::EVERY, here}});
    }
    if (block || !is_any_name(stop_, {"IMPORT", "INCLUDE", "USING", "REQUIRE"}) ||
        end_ != stop_ + 2)
      return std::nullopt;
    if (is_any_name(stop_ + 1, {"TIME", "RANDOM", "MATH", "SYS", "OS", "MACHINE", "MICROBIT"})) {
      report(Code::E0001, "RSL has no module " + quote(stop_ + 1) + " and needs none", here)
          .helps("leave this line out")
          .fix(span(stop_, end_), "", Applicability::likely);
      return change(stop_, 2);
    }
    report(Code::E0001, "a module is included with `USE`", here)
        .helps("write `USE " + std::string(text(stop_ + 1)) + "`")
        .fix(here, "USE", Applicability::likely);
    return change(stop_, 2);
  }

  // `FOREVER`, `LOOP:`, `ALWAYS DO`, outside of a rule
  std::optional<Edit> again_outside() {
    const auto block = open_block();
    if (stop_ != begin_ || (block && !is(*block, Kinds::BEHAVIOR))) return std::nullopt;
    const bool forever = ascii::same(text(stop_), "FOREVER");
    if (!forever && !is_any_name(stop_, {"LOOP", "ALWAYS"})) return std::nullopt;
    std::size_t behind = stop_ + 1;
    if (is(behind, Kinds::COLON)) ++behind;
    if (!is(behind, Kinds::NEWLINE) && !is(behind, Kinds::DO)) return std::nullopt;
    const std::size_t next = after_line_ends(behind);
    if (is(next, Kinds::DO)) behind = next + 1;
    const Span all = span(stop_, behind);
    report(Code::E0010, "a rule cannot begin with " + quote(stop_), all)
        .helps("to act again and again, write `EVERY 1s DO`, the commands, and `END`")
        .fix(all, "EVERY 1s DO", Applicability::likely);
    return change(
        stop_, behind - stop_,
        {{Kinds::EVERY, all}, missing(Kinds::QUANTITY, behind), missing(Kinds::DO, behind)});
  }

  // `SET score TO 0`, outside of a rule
  std::optional<Edit> set_outside() {
    const std::size_t name = stop_ + 1, to = stop_ + 2;
    if (stop_ != begin_ || open_block() || !is(stop_, Kinds::SET) || !is(name, Kinds::NAME) ||
        !(is(to, Kinds::TO) || is(to, Kinds::EQUAL)) || to + 1 >= end_)
      return std::nullopt;
    const std::string better = fmt::format("REMEMBER {} = {}", text(name), text(to + 1, end_));
    report(Code::E0010, quote(stop_) + " changes a variable inside a rule", tokens_[stop_].span)
        .helps("the value at the start is written `" + better + "`")
        .fix(span(stop_, end_), better, Applicability::likely);
    return change(stop_, end_ - stop_);
  }

  // `touch LEVEL EQUALS 3`, `IS AT LEAST 3`, `red_button WAS pressed`
  std::optional<Edit> comparison() {
    for (const std::size_t at : {stop_ - 1, stop_, stop_ - 2, before_ - 1}) {
      if (at < 2 || at >= tokens_.size() || !asks_before(at)) continue;
      for (const Phrase& phrase : kPhrases) {
        const std::size_t end = end_of(phrase.words, at);
        const bool reaches = end >= stop_ || (end == before_ && is(end, Kinds::QUANTITY));
        const bool compares = phrase.kind == Kinds::CHANGES || !is(end, Kinds::NEWLINE);
        if (end == at || !reaches || !compares) continue;
        return written_as(phrase, is(at - 1, Kinds::IS) ? at - 1 : at, end);
      }
    }
    return std::nullopt;
  }

  struct Phrase {
    std::string_view words;
    TokenKind kind;
    std::string_view sign;
  };
  static constexpr Phrase kPhrases[] = {
      {"EQUALS", Kinds::EQUAL, "="},
      {"EQUAL TO", Kinds::EQUAL, "="},
      {"EQUAL", Kinds::EQUAL, "="},
      {"WAS", Kinds::IS, "IS"},
      {"ARE", Kinds::IS, "IS"},
      {"CONTAINS", Kinds::IS, "IS"},
      {"AT LEAST", Kinds::GREATER_EQUAL, ">="},
      {"AT MOST", Kinds::LESS_EQUAL, "<="},
      {"REACHES", Kinds::GREATER_EQUAL, ">="},
      {"EXCEEDS", Kinds::GREATER, ">"},
      {"ABOVE", Kinds::GREATER, ">"},
      {"OVER", Kinds::GREATER, ">"},
      {"BELOW", Kinds::LESS, "<"},
      {"UNDER", Kinds::LESS, "<"},
      {"AFTER", Kinds::FOR, "FOR"},
      {"INCREASES", Kinds::CHANGES, "CHANGES"},
      {"DECREASES", Kinds::CHANGES, "CHANGES"},
      {"RISES", Kinds::CHANGES, "CHANGES"},
      {"FALLS", Kinds::CHANGES, "CHANGES"},
  };

  // The index after the words if they are at `at`, otherwise `at`.
  std::size_t end_of(std::string_view words, std::size_t at) const {
    const std::size_t begin = at;
    while (!words.empty()) {
      const std::size_t length = std::min(words.find(' '), words.size());
      if (!ascii::same(text(at), words.substr(0, length))) return begin;
      words.remove_prefix(std::min(length + 1, words.size()));
      ++at;
    }
    return at;
  }

  // A word is tested with IS; a number is compared with a sign.
  Edit written_as(const Phrase& phrase, std::size_t begin, std::size_t end) {
    const Span all = span(begin, end);
    const std::string what = "`" + std::string(source_.text(all)) + "`";
    if (phrase.kind == Kinds::CHANGES) {
      report(Code::E0001, "a condition cannot use " + what, all)
          .helps("`CHANGES` is any change, up or down; for a value above a threshold, write `> 3`");
      return change(begin, end - begin, {{Kinds::CHANGES, all}});
    }
    if (phrase.kind == Kinds::IS && end < tokens_.size() && is_relation(tokens_[end].kind)) {
      report(Code::E0001, quote(end) + " takes no " + what + " before it", all)
          .fix({all.file, all.begin, tokens_[end].span.begin}, "", Applicability::likely);
      return change(begin, end - begin);
    }
    const bool sign = is_relation(phrase.kind), word = is(end, Kinds::STRING);
    const bool asks_number = phrase.kind == Kinds::IS && is(end, Kinds::QUANTITY);
    TokenKind kind = sign && word ? TokenKind(Kinds::IS) : phrase.kind;
    if (asks_number) kind = Kinds::EQUAL;
    const std::string better = sign && word ? "IS" : asks_number ? "=" : std::string(phrase.sign);
    report(Code::E0001, "in a condition " + what + " is written `" + better + "`", all)
        .fix(all, better, Applicability::likely);
    return change(begin, end - begin, {{kind, all}});
  }

  // `ELIF x > 3 DO`
  std::optional<Edit> foreign_else() {
    const std::size_t first = statement_;
    if (!is_any_name(first, {"ELIF", "ELSIF", "ELSEIF", "ELSE_IF"}) || first == stop_)
      return std::nullopt;
    report(Code::E0007, quote(first) + " is written `ELSE IF` in RSL", tokens_[first].span)
        .fix(tokens_[first].span, "ELSE IF");
    return change(first, 1, {{Kinds::ELSE_IF, tokens_[first].span}});
  }

  // `VAR count = 0`
  std::optional<Edit> declaration() {
    const std::size_t name = statement_ + 1, sign = statement_ + 2;
    const bool named =
        is_any_name(statement_, {"VAR", "VARIABLE", "INT", "INTEGER", "FLOAT", "DOUBLE", "NUMBER",
                                 "BOOL", "BOOLEAN", "DIM", "LOCAL", "GLOBAL", "DECLARE", "CONST"});
    if (!named || !is(name, Kinds::NAME) || !is(sign, Kinds::EQUAL)) return std::nullopt;
    const bool fixed = is_name(statement_, "CONST");
    const std::string word = fixed ? "LET" : "REMEMBER";
    Diagnostic& d = report(
        Code::E0001,
        fixed ? "a named number is declared with `LET`" : "a variable is declared with `REMEMBER`",
        tokens_[statement_].span);
    const std::string better = word + " " + text(name, statement_end());
    if (open_block()) {
      d.helps("write `" + better + "` at the top, outside all blocks");
      return change(statement_, statement_end() - statement_, nothing_to_do());
    }
    d.helps("write `" + better + "`").fix(tokens_[statement_].span, word, Applicability::likely);
    return change(statement_, statement_end() - statement_);
  }

  // `LET near = 30cm` in a response
  std::optional<Edit> declared_in_block() {
    const auto block = open_block();
    if (stop_ != begin_ || !block || !starts_line(tokens_, *block) ||
        !is_one_of(tokens_[stop_].kind, {Kinds::LET, Kinds::REMEMBER, Kinds::STATE, Kinds::FEELING,
                                         Kinds::TIMER, Kinds::LIST, Kinds::LIMIT, Kinds::USE}) ||
        is_one_of(tokens_[*block].kind,
                  {Kinds::BEHAVIOR, Kinds::SAFETY, Kinds::CHECK, Kinds::MOTION, Kinds::TEST}) ||
        indentation(tokens_[stop_], source_) <= indentation(tokens_[*block], source_))
      return std::nullopt;
    const bool counts = is(stop_, Kinds::LET);
    Diagnostic& d = report(Code::E0010, quote(stop_) + " cannot be used inside a response",
                           tokens_[stop_].span);
    d.label(tokens_[*block].span, "this block continues until its `END`", false)
        .helps("move the line to the top of the program");
    if (counts)
      d.helps("for a value that changes while the robot runs, use `REMEMBER`, and `SET` it here");
    return change(statement_, end_ - statement_, nothing_to_do());
  }

  Tokens nothing_to_do() const {
    return {missing(Kinds::LOG, statement_), missing(Kinds::STRING, statement_)};
  }

  // `FUNCTION wave`
  std::optional<Edit> definition() {
    const std::size_t first = begin_, name = first + 1, open = first + 2;
    const bool named = stop_ == first && !open_block() && is(name, Kinds::NAME) &&
                       std::ranges::any_of(kForeignDefines, [&](std::string_view word) {
                         return is_name(first, word);
                       });
    if (!named) return std::nullopt;
    Tokens head{{Kinds::DEFINE, tokens_[first].span}, tokens_[name]};
    std::string better = "DEFINE " + std::string(text(name));
    const std::size_t values = open + 1, close = is(open, Kinds::OPEN) ? closing(open) : open;
    if (close > values) {
      better += " WITH " + text(values, close);
      head.push_back({Kinds::WITH, tokens_[open].span});
      head.insert(head.end(), token_at(values), token_at(close));
    }
    report(Code::E0001, "commands get a name with `DEFINE`, not with " + quote(first),
           tokens_[first].span)
        .helps("write `" + better + "`")
        .fix(span(first, end_), better, Applicability::likely);
    const std::size_t behind = behind_indented(first);
    if (is(behind, Kinds::END)) return change(first, end_ - first, std::move(head));
    // Other languages end it with a brace, or with nothing.
    head.insert(head.end(), token_at(end_), token_at(behind));
    for (const TokenKind kind : {Kinds::NEWLINE, Kinds::END, Kinds::NEWLINE})
      head.push_back(missing(kind, behind));
    return change(first, behind - first, std::move(head));
  }

  // The first word of the next line that is not indented more than this one.
  std::size_t behind_indented(std::size_t first) const {
    std::size_t at = end_;
    while (at < tokens_.size() &&
           (is(at, Kinds::NEWLINE) || !starts_line(tokens_, at) ||
            indentation(tokens_[at], source_) > indentation(tokens_[first], source_)))
      ++at;
    return at;
  }

  Tokens::const_iterator token_at(std::size_t at) const {
    return tokens_.begin() + static_cast<std::ptrdiff_t>(at);
  }

  // `print("x")`, `SAY voice ("x")`
  std::optional<Edit> text_in_brackets() {
    if (stop_ == 0 || !begins_with(Kinds::NAME)) return std::nullopt;
    const bool says = is_name(statement_, "SAY") && is_call(statement_ + 1);
    const std::size_t open = says ? statement_ + 1 : is(stop_, Kinds::OPEN) ? stop_ : stop_ - 1;
    if (!is(open, Kinds::OPEN) || !(says || is(open + 1, Kinds::STRING))) return std::nullopt;
    const std::size_t close = closing(open), end = std::min(close + 1, end_);
    if (open == statement_ + 1 && is_call(open) && behind_declaration("DEFINE", text(statement_)))
      return std::nullopt;  // a text passed to a DEFINE
    const bool prints = is_name(statement_, "PRINT");
    const std::string command = prints ? "LOG" : text(statement_, open);
    const std::string better = command + " " + text(open + 1, close);
    report(Code::E0001, "text takes no brackets around it", tokens_[open].span)
        .helps("write `" + better + "`")
        .fix(span(statement_, end), better, Applicability::likely);
    return change(open, end - open, Tokens(token_at(open + 1), token_at(close)));
  }

  // `SET x = 5`
  std::optional<Edit> set_with_sign() {
    if (!begins_with(Kinds::SET) || !is(stop_, Kinds::EQUAL) || stop_ != statement_ + 2)
      return std::nullopt;
    report(Code::E0001, "`SET` takes `TO` before the value, not " + quote(stop_),
           tokens_[stop_].span)
        .helps("write `SET " + std::string(text(statement_ + 1)) + " TO " +
               text(stop_ + 1, statement_end()) + "`")
        .fix(tokens_[stop_].span, "TO");
    return change(stop_, 1, {{Kinds::TO, tokens_[stop_].span}});
  }

  // `x = 5`, `x += 1`, `x *= 2`, `x++`
  std::optional<Edit> assignment() {
    const std::size_t sign = statement_ + 1;
    const bool step = is(begin_, Kinds::AT) || is(begin_, Kinds::EXPECT);
    const bool here = stop_ == 0 || stop_ == sign || stop_ == sign + 1;
    if (!begins_with(Kinds::NAME) || step || !here) return std::nullopt;
    const bool adds = is(sign, Kinds::PLUS) || is(sign, Kinds::MINUS);
    if (is(sign, Kinds::EQUAL)) return assignment("SET ", " TO ", sign + 1);
    const bool scales = is(sign, Kinds::STAR) || is(sign, Kinds::SLASH);
    if (scales && touches_next(sign) && is(sign + 1, Kinds::EQUAL) && statement_ != 0)
      return assignment("SET ", " TO " + text(statement_, sign + 1) + " ", sign + 2);
    if (!adds || !touches_next(sign)) return std::nullopt;
    const std::string word = is(sign, Kinds::PLUS) ? "RAISE " : "LOWER ";
    if (is(sign + 1, Kinds::EQUAL)) return assignment(word, " BY ", sign + 2);
    const bool twice = tokens_[sign].kind == tokens_[sign + 1].kind && sign + 2 == statement_end();
    return twice ? assignment(word, " BY ", sign + 2) : std::nullopt;
  }

  // Written in RSL; the value begins at `value`, and is 1 if none is written.
  std::optional<Edit> assignment(const std::string& word, const std::string& preposition,
                                 std::size_t value) {
    const std::size_t end = statement_end();
    const std::string name(text(statement_));
    const bool brackets = is(value - 2, Kinds::STAR) || is(value - 2, Kinds::SLASH);
    std::string written = value < end ? text(value, end) : "1";
    if (brackets && value + 1 < end) written = "(" + written + ")";
    const bool outside = statement_ == 0;
    const std::string better =
        outside ? "REMEMBER " + name + " = " + written : word + name + preposition + written;
    const Span all = span(statement_, end);
    report(Code::E0001,
           outside ? "a variable is declared with `REMEMBER`"
                   : "a value is changed with `SET`, `RAISE` or `LOWER`",
           span(statement_ + 1, value))
        .helps("write `" + better + "`")
        .fix(all, better, Applicability::likely);
    if (outside) return change(0, end, {});
    const bool sets = word == "SET ";
    Tokens said{missing(sets ? Kinds::SET : Kinds::RAISE, statement_), tokens_[statement_],
                missing(sets ? Kinds::TO : Kinds::BY, statement_)};
    if (value >= end) said.push_back(missing(Kinds::QUANTITY, statement_));
    return change(statement_, value - statement_, std::move(said));
  }

  // `+=`, not `+ =`
  bool touches_next(std::size_t at) const {
    return at + 1 < tokens_.size() && tokens_[at].span.end == tokens_[at + 1].span.begin;
  }

  // `WHEN touch LEVEL > 3:`, `ELSE:`
  std::optional<Edit> colon() {
    if (!is(stop_, Kinds::COLON) || !is(stop_ + 1, Kinds::NEWLINE) || stop_ == begin_)
      return std::nullopt;
    const bool asks = begins_with(Kinds::WHEN) || begins_with(Kinds::WHILE) ||
                      begins_with(Kinds::IF) || begins_with(Kinds::ELSE_IF) ||
                      begins_with(Kinds::EVERY) || is(begin_, Kinds::AT);
    const bool has_do = is(stop_ - 1, Kinds::DO) || is(stop_ + 2, Kinds::DO);
    const Span here = tokens_[stop_].span;
    if (!asks || has_do) {
      report(Code::E0009, "a line of RSL does not end with a colon", here).fix(here, "");
      return change(stop_, 1);
    }
    Diagnostic& d = report(Code::E0001, "this line ends with `DO`, not with a colon", here);
    d.fix(here, " DO");
    const bool as_written =
        std::all_of(tokens_.begin() + static_cast<std::ptrdiff_t>(begin_),
                    tokens_.begin() + static_cast<std::ptrdiff_t>(stop_),
                    [](const Token& token) { return token.span.begin < token.span.end; });
    if (as_written && (!is(begin_, Kinds::WHEN) || ascii::same(text(begin_), "WHEN")))
      d.helps("write `" + text(begin_, stop_) + " DO`");
    return change(stop_, 1, {{Kinds::DO, here}});
  }

  // `END IF`
  std::optional<Edit> end_of_what() {
    if (stop_ == 0 || !is(stop_ - 1, Kinds::END) || stop_ - 1 != begin_) return std::nullopt;
    if ((roles_of(tokens_[stop_].kind) & role::opens) == 0 || stop_ + 1 != end_)
      return std::nullopt;
    const Span here = tokens_[stop_].span;
    report(Code::E0009, "`END` stands alone: it does not name what it ends", here).fix(here, "");
    return change(stop_, 1);
  }

  // `wave IS NOT TRUE`
  std::optional<Edit> negated_truth() {
    const bool is_true = is(stop_, Kinds::TRUE);
    if (stop_ < 2 || (!is_true && !is(stop_, Kinds::FALSE)) || !is(stop_ - 1, Kinds::NOT) ||
        !is(stop_ - 2, Kinds::IS))
      return std::nullopt;
    const Span both = span(stop_ - 1, stop_ + 1);
    const std::string opposite = is_true ? "FALSE" : "TRUE";
    report(Code::E0007,
           "`IS NOT " + text(stop_, stop_ + 1) + "` is written `IS " + opposite + "` in RSL", both)
        .fix(both, opposite, Applicability::likely);
    return change(stop_ - 1, 2, {{is_true ? Kinds::FALSE : Kinds::TRUE, both}});
  }

  // `WHEN TRUE DO`
  std::optional<Edit> truth() {
    for (const std::size_t at : {stop_, before_}) {
      const bool word = is(at, Kinds::TRUE) || is(at, Kinds::FALSE);
      if (!word || at == 0 || !asks(tokens_[at - 1].kind)) continue;
      const bool rule = is(at - 1, Kinds::WHEN) || is(at - 1, Kinds::WHILE);
      Diagnostic& message = report(
          Code::E0302, quote(at) + " is not a condition: a condition checks a sensor or a variable",
          tokens_[at].span);
      if (rule)
        message.helps("to act again and again, write `EVERY 1s DO`; to act once, `AT START DO`");
      else
        message.helps("write a condition such as `touch LEVEL > 3`, or leave it out");
      return change(
          at, 1,
          {missing(Kinds::QUANTITY, at), missing(Kinds::LESS, at), missing(Kinds::QUANTITY, at)});
    }
    return std::nullopt;
  }

  static bool asks(TokenKind kind) {
    return begins_question(kind) || is_one_of(kind, {Kinds::AND, Kinds::OR, Kinds::NOT});
  }

  // `3,5%`: the comma touches the numbers on both sides.
  std::optional<Edit> decimal_comma() {
    const std::size_t comma = is(stop_, Kinds::NAME) && stop_ >= 2 ? stop_ - 2 : stop_;
    if (!is_decimal_comma(tokens_, source_, comma)) return std::nullopt;
    // `2,5 s`
    const bool apart = is_behind_digits(tokens_, source_, comma + 2);
    std::string decimals = text(comma + 1, comma + 2);
    Span whole = span(comma - 1, comma + 2);
    if (apart) {
      const std::string_view unit = text(comma + 2), ours = unit_word(unit);
      decimals += ours.empty() ? unit : ours;
      whole.end = tokens_[comma + 2].span.end;
    }
    report_decimal_comma(diagnostics_, whole, text(comma - 1), decimals);
    return change(comma, apart ? 3 : 2);
  }
};

}  // namespace

std::optional<Edit> explain_foreign_habit(const Tokens& tokens, const SourceFile& source,
                                          const Attempt& failure, Diagnostics& diagnostics) {
  return ForeignHabits(tokens, source, failure, diagnostics).find();
}

}  // namespace robosync::compiler
