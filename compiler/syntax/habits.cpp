// See habits.hpp.
#include "compiler/syntax/habits.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "compiler/syntax/functions.hpp"
#include "compiler/syntax/mistaken_line.hpp"

namespace robosync::compiler {

namespace {

bool is_operator(TokenKind kind) {
  return is_one_of(kind, {Kinds::PLUS, Kinds::MINUS, Kinds::STAR, Kinds::SLASH, Kinds::MOD});
}

bool is_preposition(TokenKind kind) {
  return is_one_of(kind, {Kinds::TO, Kinds::BY, Kinds::OVER, Kinds::AT, Kinds::FOR, Kinds::MARGIN});
}

class Habits : private MistakenLine {
public:
  using MistakenLine::MistakenLine;

  std::optional<Edit> find() {
    if (stop_ >= tokens_.size()) return std::nullopt;
    using Habit = std::optional<Edit> (Habits::*)();
    for (const Habit habit :
         {&Habits::kept, &Habits::value_of_text, &Habits::list, &Habits::of, &Habits::timer,
          &Habits::table, &Habits::else_if, &Habits::is_number, &Habits::comparison_in_words,
          &Habits::expect, &Habits::function, &Habits::parameters, &Habits::worked_out}) {
      if (auto edit = (this->*habit)()) return edit;
    }
    return std::nullopt;
  }

private:
  // `LET x = 3 KEPT`, `REMEMBER x KEPT = 0`
  std::optional<Edit> kept() {
    if (begins_with(Kinds::REMEMBER)) return remember_kept();
    if (!is(stop_, Kinds::KEPT)) return std::nullopt;
    const bool item = is(statement_, Kinds::LIST) || is(statement_, Kinds::LET) ||
                      is(statement_, Kinds::MOTION) || is(statement_, Kinds::CHECK) ||
                      is(statement_, Kinds::LIMIT) || is(statement_, Kinds::USE);
    const bool first = stop_ == begin_ && is(stop_ + 1, Kinds::REMEMBER);
    if (!item && !first) return std::nullopt;
    if (first) return kept_too_early(stop_);
    report(Code::E0010, "only a REMEMBER can be KEPT", tokens_[stop_].span)
        .helps("what is kept is a number: `REMEMBER visits = 0 KEPT`");
    return change(stop_, 1);
  }

  std::optional<Edit> remember_kept() {
    for (const std::size_t at : {stop_, before_}) {
      if (!is(at, Kinds::KEPT) || at + 1 >= end_ || at < begin_) continue;
      return kept_too_early(at);
    }
    if (!is(stop_, Kinds::KEPT) || has(statement_, stop_, Kinds::EQUAL)) return std::nullopt;
    const std::string name(text(stop_ - 1));
    report(Code::E0008, "this does not say what `" + name + "` begins with",
           tokens_[stop_ - 1].span)
        .helps("write the number in front of KEPT: `REMEMBER " + name + " = 0 KEPT`");
    return change(stop_, 0, {missing(Kinds::EQUAL, stop_), missing(Kinds::QUANTITY, stop_)});
  }

  Edit kept_too_early(std::size_t at) {
    report(Code::E0001, "KEPT stands at the end of its line", tokens_[at].span)
        .helps("write `REMEMBER visits = 0 KEPT`");
    return change(at, 1);
  }

  // `REMEMBER x = "a"`, `SET x TO "a"`
  std::optional<Edit> value_of_text() {
    const bool holds = begins_with(Kinds::REMEMBER) || begins_with(Kinds::LET);
    if (!is(stop_, Kinds::STRING) || !(holds || begins_with(Kinds::SET))) return std::nullopt;
    if (!is(stop_ - 1, holds ? Kinds::EQUAL : Kinds::TO)) return std::nullopt;
    if (!holds && is_word_of_state(stop_ - 2, stop_)) return word_in_quotes();
    const std::string what = holds ? "a " + std::string(text(statement_)) + " holds" : "SET takes";
    report(Code::E0306, what + " a number, and this is a text", tokens_[stop_].span)
        .helps("texts to choose from are a LIST: `LIST words: " + std::string(text(stop_)) + "`")
        .helps("one of several words is a STATE: `STATE mood: calm, happy`, `SET mood TO happy`");
    return change(stop_, 1, {missing(Kinds::QUANTITY, stop_)});
  }

  // Does a line of the file declare the name at `name` as a STATE with the word that stands in quotes at `word`? The
  // tokens are those of this item only.
  bool is_word_of_state(std::size_t name, std::size_t word) const {
    constexpr std::string_view kBetween = " \t\r,:";
    const std::string_view quoted = text(word);
    if (quoted.size() < 3) return false;
    for (std::uint32_t line = 1; line <= source_.lines(); ++line) {
      std::string_view rest = source_.line(line);
      const auto next = [&](std::string_view ends) {
        rest.remove_prefix(std::min(rest.find_first_not_of(kBetween), rest.size()));
        std::string_view found = rest.substr(0, rest.find_first_of(ends));
        rest.remove_prefix(found.size());
        return found.substr(0, found.find_last_not_of(kBetween) + 1);
      };
      if (!ascii::same(next(kBetween), "STATE") || !ascii::same(next(kBetween), text(name)))
        continue;
      for (std::string_view label = next(",%#"); !label.empty(); label = next(",%#"))
        if (ascii::same(label, quoted.substr(1, quoted.size() - 2))) return true;
    }
    return false;
  }

  // `SET mood TO "happy"`
  Edit word_in_quotes() {
    Span word = tokens_[stop_].span;
    report(Code::E0306, "a word of a STATE stands without quotes behind SET", word)
        .helps("write `" + std::string(text(stop_).substr(1, text(stop_).size() - 2)) + "`")
        .fix(word, std::string(text(stop_).substr(1, text(stop_).size() - 2)));
    ++word.begin;
    --word.end;
    return change(stop_, 1, {{Kinds::NAME, word}});
  }

  // `LIST words = "a"`, `LIST words "a"`, `LIST words: ("a", "b")`, one text a line
  std::optional<Edit> list() {
    if (stop_ == begin_ && is_name(stop_, "LIST") && is(stop_ + 1, Kinds::NAME)) {
      const std::string name(text(stop_ + 1));
      report(Code::E0001, "a LIST has a colon behind its name", span(stop_, stop_ + 2))
          .helps("write `LIST " + name + ": \"one\", \"two\"`");
      return change(begin_, tokens_.size() - begin_);
    }
    if (!is(0, Kinds::LIST)) return std::nullopt;
    const bool text_in_brackets = is(stop_, Kinds::STRING) && is(stop_ - 1, Kinds::OPEN);
    const bool next_line = stop_ == begin_ && begin_ > 0;
    const bool sign = is(stop_ - 1, Kinds::MINUS) || is(stop_, Kinds::MINUS);
    if (!text_in_brackets && !next_line && !sign) return std::nullopt;
    report(Code::E0001,
           text_in_brackets ? "a LIST has no brackets" : "the parts of a LIST have commas between",
           tokens_[text_in_brackets ? stop_ - 1 : stop_].span)
        .helps("write `LIST " + std::string(text(1)) + ": \"one\", \"two\"`, without END");
    const std::size_t rest = rest_of_list();
    if (!text_in_brackets && !sign) return change(stop_, rest - stop_);
    return change(stop_ - 1, rest - stop_ + 1, {missing(Kinds::QUANTITY, stop_)});
  }

  // Up to the line that begins with a word that cannot belong to the LIST.
  std::size_t rest_of_list() const {
    std::size_t at = end_;
    while (at + 1 < tokens_.size() &&
           (roles_of(tokens_[at + 1].kind) & (role::item | role::part)) == 0) {
      ++at;
      while (at < tokens_.size() && !is(at, Kinds::NEWLINE))
        ++at;
    }
    return std::min(at, tokens_.size());
  }

  // `SAY ANY OF jokes`, `LENGTH OF jokes`, `SAY RANDOM jokes`
  std::optional<Edit> of() {
    if (is(before_, Kinds::RANDOM) && begins_with(Kinds::NAME)) return std::nullopt;
    if (is(stop_, Kinds::RANDOM) && is(stop_ + 1, Kinds::NAME)) {
      const std::string better = "ANY " + std::string(text(stop_ + 1));
      report(Code::E0001, "RANDOM draws a number: `RANDOM(1, 6)`", tokens_[stop_].span)
          .helps("a text of a LIST at random is `" + better + "`");
      return change(stop_, 1, {{Kinds::NAME, tokens_[stop_].span}});
    }
    if (!is(stop_, Kinds::OF) || stop_ == 0 || !is(stop_ + 1, Kinds::NAME)) return std::nullopt;
    const std::string list(text(stop_ + 1));
    if (is_any_name(stop_ - 1, {"ANY", "NEXT"})) {
      const std::string word(text(stop_ - 1));
      report(Code::E0009, quote(stop_ - 1) + " has no OF behind it", tokens_[stop_].span)
          .helps("write `" + word + " " + list + "`");
      return change(stop_, 1);
    }
    if (!is_any_name(stop_ - 1, {"LENGTH", "LEN", "SIZE", "NUMBER"})) return std::nullopt;
    report(Code::E0001, "how many a LIST has is its COUNT", span(stop_ - 1, stop_ + 2))
        .helps("write `COUNT OF " + list + "`");
    return change(stop_ - 1, 3, {missing(Kinds::QUANTITY, stop_)});
  }

  // `TIMER idle = 0s`, `START idle`
  std::optional<Edit> timer() {
    if (begins_with(Kinds::TIMER) && is(statement_ + 1, Kinds::NAME) && stop_ == statement_ + 2) {
      report(Code::E0009, "a TIMER begins at 0 by itself, and has nothing behind its name",
             span(stop_, end_))
          .helps("write `TIMER " + std::string(text(statement_ + 1)) + "`");
      return change(stop_, end_ - stop_);
    }
    if (stop_ != statement_ || !is(stop_, Kinds::START) || !is(stop_ + 1, Kinds::NAME))
      return std::nullopt;
    report(Code::E0001, "START begins nothing here", tokens_[stop_].span)
        .helps("a TIMER begins again with `RESTART " + std::string(text(stop_ + 1)) + "`")
        .helps("a MOTION begins with `PERFORM " + std::string(text(stop_ + 1)) + "`");
    return change(stop_, 1);
  }

  // Rows of a MOTION with commas, a colon, without AT, with a verb or a text.
  std::optional<Edit> table() {
    if (!is(0, Kinds::MOTION) || begin_ == 0) return columns();
    if (is(stop_, Kinds::END) || is(stop_, Kinds::NEWLINE) || before_ == stop_) return std::nullopt;
    if (is_operator(tokens_[stop_].kind) && is(begin_, Kinds::AT)) {
      const std::string better = "`(" + text(stop_ - 1, std::min(stop_ + 2, end_)) + ")`";
      report(Code::E0001, "a value that is worked out stands in brackets here",
             span(stop_ - 1, std::min(stop_ + 2, end_)))
          .helps("write " + better);
      return rows_dropped();
    }
    const bool foreign = is_one_of(tokens_[stop_].kind, {Kinds::COMMA, Kinds::COLON, Kinds::STRING,
                                                         Kinds::TO, Kinds::BY, Kinds::AT});
    const bool without_at = stop_ == begin_ && is(stop_, Kinds::QUANTITY);
    const bool command = stop_ == begin_ && is(stop_, Kinds::NAME) &&
                         !is(stop_ + 1, Kinds::QUANTITY) && !has(0, stop_, Kinds::END);
    if (!foreign && !without_at && !command) return std::nullopt;
    report(Code::E0001, "a row of a MOTION is a time and a value for each actuator",
           tokens_[stop_].span)
        .helps("with spaces between: `AT 0s 10deg 20deg`; `-` where an actuator is on its way");
    return rows_dropped();
  }

  // `MOTION wave OF left_arm AND right_arm`
  std::optional<Edit> columns() {
    if (!is(0, Kinds::MOTION) || !is(stop_, Kinds::AND)) return std::nullopt;
    report(Code::E0001, "the actuators of a MOTION have commas between them", tokens_[stop_].span)
        .helps("write `" + text(stop_ - 1, stop_) + ", " + text(stop_ + 1, stop_ + 2) + "`")
        .fix(tokens_[stop_].span, ",", Applicability::likely);
    return change(stop_, 1, {{Kinds::COMMA, tokens_[stop_].span}});
  }

  // Who writes one row in a way of their own writes all of them so.
  Edit rows_dropped() const {
    std::size_t last = tokens_.size();
    while (last > begin_ && !is(last, Kinds::END))
      --last;
    const bool ends = last > begin_;
    Tokens row{missing(Kinds::AT, begin_), missing(Kinds::QUANTITY, begin_),
               missing(Kinds::QUANTITY, begin_), missing(Kinds::NEWLINE, begin_)};
    return change(begin_, (ends ? last : end_) - begin_, std::move(row));
  }

  // `ELSE x > 3 DO`; an ELSE IF behind an ELSE, or in a rule
  std::optional<Edit> else_if() {
    if (statement_ > 0 && is(statement_ - 1, Kinds::ELSE) && is_relation(tokens_[stop_].kind) &&
        has(stop_, end_, Kinds::DO)) {
      report(Code::E0001, "ELSE asks nothing; to ask once more, write `ELSE IF`",
             tokens_[statement_ - 1].span);
      return change(statement_ - 1, 1, {{Kinds::ELSE_IF, tokens_[statement_ - 1].span}});
    }
    if (!is(stop_, Kinds::ELSE_IF)) return std::nullopt;
    std::size_t end = stop_;
    while (end < tokens_.size() && !is(end, Kinds::DO))
      ++end;
    const bool rule = is(0, Kinds::WHEN) && !has(0, stop_, Kinds::IF);
    if (end == tokens_.size() || !rule) return std::nullopt;
    report(Code::E0001, "ELSE IF belongs to an IF; a rule has one ELSE", tokens_[stop_].span)
        .helps("write two rules, or `ELSE` and an IF with its own END");
    return if_in_else();
  }

  // Read as `ELSE`, and an IF that ends in front of the END of the rule: it may have an ELSE of its own.
  Edit if_in_else() const {
    const Span here = tokens_[stop_].span;
    BlockWalk walk(tokens_);
    std::size_t last = 0;
    for (; last < tokens_.size(); ++last) {
      walk.step(last);
      if (last > stop_ && walk.open().empty()) break;
    }
    Tokens inserted{{Kinds::ELSE, here}, {Kinds::IF, here}};
    for (std::size_t at = stop_ + 1; at < last; ++at)
      inserted.push_back(tokens_[at]);
    inserted.push_back(missing(Kinds::END, last));
    inserted.push_back(missing(Kinds::NEWLINE, last));
    return change(stop_, last - stop_, std::move(inserted));
  }

  // `x IS 30s`, `x IS > 3`
  std::optional<Edit> is_number() {
    if (stop_ < 2 || !is(stop_ - 1, Kinds::IS)) return std::nullopt;
    const bool relation = is_relation(tokens_[stop_].kind);
    if (!relation && !is(stop_, Kinds::QUANTITY)) return std::nullopt;
    if (relation) {
      report(Code::E0009, "no IS stands in front of " + quote(stop_), tokens_[stop_ - 1].span);
      return change(stop_ - 1, 1);
    }
    report(Code::E0001, "IS asks for a word, and " + quote(stop_) + " is a number",
           tokens_[stop_ - 1].span)
        .helps("a number is compared with `=`, `<` or `>`, or with `IS BETWEEN 2 AND 5`");
    return change(stop_ - 1, 1, {{Kinds::EQUAL, tokens_[stop_ - 1].span}});
  }

  // `idle OVER 30s`, `touch LEVEL ABOVE 3`
  std::optional<Edit> comparison_in_words() {
    const bool more = is(stop_, Kinds::OVER) || is(stop_, Kinds::ABOVE);
    const bool less = is(stop_, Kinds::BELOW);
    const bool condition = begins_with(Kinds::WHEN) || begins_with(Kinds::WHILE) ||
                           begins_with(Kinds::IF) || begins_with(Kinds::ELSE_IF);
    if (!condition || !(more || less)) return std::nullopt;
    const std::string sign = more ? ">" : "<";
    report(Code::E0001, "in a condition " + quote(stop_) + " is written `" + sign + "`",
           tokens_[stop_].span)
        .fix(tokens_[stop_].span, sign, Applicability::likely);
    return change(stop_, 1, {{more ? Kinds::GREATER : Kinds::LESS, tokens_[stop_].span}});
  }

  // Steps of a TEST.
  std::optional<Edit> expect() {
    if (!is(begin_, Kinds::EXPECT)) return std::nullopt;
    const std::size_t first = begin_ + 1;
    const Span here = tokens_[first].span;
    if (is(first, Kinds::NOT)) {
      report(Code::E0001, "what must not happen is EXPECTed with NO", here)
          .fix(here, "NO", Applicability::likely);
      return change(first, 1, {{Kinds::NO, here}});
    }
    if (is(first, Kinds::STOP)) {
      report(Code::E0001, "a TEST asks whether an actuator was STOPPED", here)
          .helps("write `EXPECT STOPPED " + std::string(text(first + 1)) + "`");
      return change(first, 1, {{Kinds::NAME, here}});
    }
    if (is(first, Kinds::NOTHING) && !has(first, end_, Kinds::FOR)) {
      report(Code::E0008, "this does not say for how long nothing may happen", here)
          .helps("write `EXPECT NOTHING FOR 2s`");
      return change(first + 1, end_ - first - 1,
                    {missing(Kinds::FOR, first), missing(Kinds::QUANTITY, first)});
    }
    return expect_more(first);
  }

  std::optional<Edit> expect_more(std::size_t first) {
    const bool says = is(first, Kinds::LOG) || is(first, Kinds::ALERT);
    if (says && is(first + 1, Kinds::NAME) && stop_ <= first + 1) {
      const std::string word(text(first));
      report(Code::E0001, "the text of " + word + " stands in quotes", tokens_[first + 1].span)
          .helps("write `EXPECT " + word + " \"…\"`");
      return change(first + 1, 1, {{Kinds::STRING, tokens_[first + 1].span}});
    }
    const bool asks =
        (is_relation(tokens_[stop_].kind) && !is(stop_, Kinds::EQUAL)) || is(stop_, Kinds::IS);
    if (is(first, Kinds::NAME) && asks) {
      report(Code::E0008, "`THAT` is missing after `EXPECT`", tokens_[begin_].span)
          .helps("write `EXPECT THAT " + text(first, end_) + "`");
      return change(first, 0, {missing(Kinds::THAT, first)});
    }
    const bool counts = is(first, Kinds::QUANTITY) && is(first + 1, Kinds::TIMES);
    if (!counts || stop_ < end_ || has(first, end_, Kinds::WITHIN)) return std::nullopt;
    report(Code::E0008, "this does not say in how long the commands are counted",
           span(first, first + 2))
        .helps("write `" + text(begin_, end_) + " WITHIN 2s`");
    return change(end_, 0, {missing(Kinds::WITHIN, end_), missing(Kinds::QUANTITY, end_)});
  }

  // `ROUND touch LEVEL`, `MIN(1, 2, 3)`, `MIN()`
  std::optional<Edit> function() {
    const auto known = [this](std::size_t at) {
      return is(at, Kinds::NAME) && find_function(text(at)) != nullptr;
    };
    const std::size_t name = stop_ - 2;
    if (stop_ >= 2 && known(name) && is(stop_ - 1, Kinds::NAME) && is(stop_, Kinds::NAME)) {
      const std::string word(text(name));
      report(Code::E0001, "`" + word + "` has its number in brackets", tokens_[name].span)
          .helps("write `" + word + "(" + text(stop_ - 1, stop_ + 1) + ")`");
      return change(name, 1);
    }
    std::size_t open = stop_;
    for (int depth = 0; open > begin_; --open) {
      if (is(open, Kinds::CLOSE) && open != stop_) ++depth;
      if (is(open, Kinds::OPEN) && depth-- == 0) break;
    }
    if (!is(open, Kinds::OPEN) || open == 0 || !known(open - 1)) return std::nullopt;
    const std::string word(text(open - 1));
    const bool pair = find_function(word)->arguments == 2;
    const std::string help = "write `" + word + (pair ? "(number, number)`" : "(number)`");
    if (!is(stop_, Kinds::COMMA) && stop_ != open + 1) return std::nullopt;
    if (is(stop_, Kinds::COMMA) && !has(open, stop_, Kinds::COMMA)) return std::nullopt;
    if (stop_ == open + 1 && !is(stop_, Kinds::CLOSE)) return std::nullopt;
    report(Code::E0411, "`" + word + "` wants " + (pair ? "two numbers" : "one number"),
           tokens_[open - 1].span)
        .helps(help);
    if (stop_ == open + 1) return change(stop_, 0, {missing(Kinds::QUANTITY, stop_)});
    return change(stop_, closing(open) - stop_);
  }

  // `DEFINE go(what)`, `go(left_arm, "a")`
  std::optional<Edit> parameters() {
    if (begins_with(Kinds::DEFINE) && is(stop_, Kinds::OPEN) && stop_ == statement_ + 2) {
      const std::size_t close = closing(stop_);
      const std::string names = text(stop_ + 1, close);
      const std::string better = names.empty() ? "" : " WITH " + names;
      report(Code::E0001, "what a DEFINE is given stands behind WITH, without brackets",
             tokens_[stop_].span)
          .helps("write `DEFINE " + std::string(text(stop_ - 1)) + better + "`");
      return bare(close);
    }
    const std::size_t open = statement_ + 1;
    if (open >= end_ || !is_call(open) || stop_ <= open) return std::nullopt;
    const std::size_t close = closing(open);
    const std::string values = text(open + 1, close);
    report(Code::E0001, "a DEFINE is given its values behind WITH, without brackets",
           tokens_[open].span)
        .helps("write `" + std::string(text(statement_)) +
               (values.empty() ? "`" : " WITH " + values + "`"));
    return change(open, statement_end() - open);
  }

  // The brackets of DEFINE become WITH.
  Edit bare(std::size_t close) const {
    Tokens inserted;
    if (close > stop_ + 1) inserted.push_back(missing(Kinds::WITH, stop_));
    for (std::size_t at = stop_ + 1; at < close; ++at)
      inserted.push_back(tokens_[at]);
    return change(stop_, std::min(close + 1, end_) - stop_, std::move(inserted));
  }

  // `SAY COUNT OF jokes`, `SAY MIN(3cm, 4s)`, `MOVE left_arm TO touch LEVEL * 10deg`
  std::optional<Edit> worked_out() {
    const std::size_t last = statement_end();
    const bool whole = is(before_, Kinds::CLOSE) && is_name(statement_, "SAY");
    const bool command = begins_with(Kinds::NAME) && stop_ > statement_ &&
                         (stop_ < last || (whole && stop_ == last));
    const bool test = is(begin_, Kinds::AT) || is(begin_, Kinds::EXPECT);
    if (!command || test || has_comma(statement_, stop_) || has(statement_, last, Kinds::STRING))
      return std::nullopt;
    std::size_t first = stop_;
    while (first > statement_ + 1 && !is_preposition(tokens_[first - 1].kind))
      --first;
    const bool behind_preposition = is_preposition(tokens_[first - 1].kind);
    if (!behind_preposition)
      for (std::size_t open = first + 2; open <= stop_; ++open)
        if (is_call(open)) first = open - 1;
    const std::size_t end = number_end(first, statement_end());
    const bool gets_on = end > stop_ || stop_ >= last;
    if (!gets_on || !worked_out_at(first) || !is_balanced(first, end)) return std::nullopt;
    const std::string number = text(first, end);
    const std::string brackets = "(" + number + ")";
    if (behind_preposition) {
      report(Code::E0505, "a value that is worked out stands in brackets here", span(first, end))
          .helps("write `" + brackets + "`");
    } else if (is_name(statement_, "SAY")) {
      report(Code::E0505, "a text begins with words in quotes, and this is a number",
             span(first, end))
          .helps("write the words, a comma and the number: `SAY \"…\", " + number + "`");
    } else {
      report(Code::E0008, "this does not say what the number is", span(first, end))
          .helps("write TO, BY, AT, OVER or FOR and brackets, such as `TO " + brackets + "`");
    }
    return change(first, end - first,
                  behind_preposition ? Tokens{missing(Kinds::QUANTITY, first)} : Tokens{});
  }

  // A preposition behind the number belongs to the command again.
  std::size_t number_end(std::size_t first, std::size_t most) const {
    std::size_t at = first;
    while (at < most && !is_preposition(tokens_[at].kind) && !is_word_behind_number(at, first))
      ++at;
    return at;
  }

  // `touch LEVEL * 10deg SLOWLY`
  bool is_word_behind_number(std::size_t at, std::size_t first) const {
    return at > first && is(at, Kinds::NAME) &&
           (is(at - 1, Kinds::QUANTITY) || is(at - 1, Kinds::CLOSE));
  }

  // Is what begins there a calculation, where the grammar takes a plain value?
  bool worked_out_at(std::size_t first) const {
    if (is(stop_, Kinds::COUNT) || is(stop_, Kinds::RANDOM)) return true;
    if (is(stop_, Kinds::NEWLINE) || is(stop_, Kinds::END)) return true;  // SAY (3 + 4)
    if (is(stop_, Kinds::OPEN)) return is_call(stop_) && stop_ - 1 >= first;
    if (is(first, Kinds::MINUS) && stop_ == first + 1) return is(stop_, Kinds::NAME);
    return (first + 1 < stop_ && is_call(first + 1)) ||
           (is_operator(tokens_[stop_].kind) && first < stop_ && may_begin(first));
  }

  // Elsewhere a misspelt preposition stands in front of the sign: `MOVE head TOx -20deg`.
  bool may_begin(std::size_t first) const {
    return is_preposition(tokens_[first - 1].kind) || is_name(statement_, "SAY");
  }
};

}  // namespace

std::optional<Edit> explain_habit(const Tokens& tokens, const SourceFile& source,
                                  const Attempt& failure, Diagnostics& diagnostics) {
  return Habits(tokens, source, failure, diagnostics).find();
}

}  // namespace robosync::compiler
