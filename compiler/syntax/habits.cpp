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

class Habits : private MistakenLine {
public:
  using MistakenLine::MistakenLine;

  std::optional<Edit> find() {
    if (stop_ >= tokens_.size()) return std::nullopt;
    using Habit = std::optional<Edit> (Habits::*)();
    for (const Habit habit :
         {&Habits::kept, &Habits::value_of_text, &Habits::value_of_truth, &Habits::list,
          &Habits::of, &Habits::timer, &Habits::table, &Habits::band, &Habits::else_if,
          &Habits::is_number, &Habits::one_of_words, &Habits::words_in_brackets, &Habits::expect,
          &Habits::random, &Habits::function, &Habits::parameters, &Habits::worked_out,
          &Habits::outside}) {
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
        .helps("`KEPT` keeps a number: `REMEMBER visits = 0 KEPT`");
    return change(stop_, 1);
  }

  std::optional<Edit> remember_kept() {
    for (const std::size_t at : {stop_, before_}) {
      if (!is(at, Kinds::KEPT) || at + 1 >= end_ || at < begin_) continue;
      return kept_too_early(at);
    }
    if (!is(stop_, Kinds::KEPT) || has(statement_, stop_, Kinds::EQUAL)) return std::nullopt;
    const std::string name(text(stop_ - 1));
    report(Code::E0008, "`" + name + "` has no starting value", tokens_[stop_ - 1].span)
        .helps("write the number before `KEPT`: `REMEMBER " + name + " = 0 KEPT`");
    return change(stop_, 0, {missing(Kinds::EQUAL, stop_), missing(Kinds::QUANTITY, stop_)});
  }

  Edit kept_too_early(std::size_t at) {
    report(Code::E0001, "`KEPT` goes at the end of the line", tokens_[at].span)
        .helps("write `REMEMBER visits = 0 KEPT`");
    return change(at, 1);
  }

  // `REMEMBER x = "a"`, `SET x TO "a"`
  std::optional<Edit> value_of_text() {
    const bool holds = begins_with(Kinds::REMEMBER) || begins_with(Kinds::LET);
    if (!is(stop_, Kinds::STRING) || !(holds || begins_with(Kinds::SET))) return std::nullopt;
    if (!is(stop_ - 1, holds ? Kinds::EQUAL : Kinds::TO)) return std::nullopt;
    if (!holds && is_word_of_state(stop_ - 2, stop_)) return word_in_quotes();
    if (!holds && behind_declaration("LIST", text(stop_ - 2))) {
      report(Code::E0508, quote(stop_ - 2) + " is a LIST, and a LIST never changes",
             tokens_[stop_ - 2].span);
      return change(stop_, 1, {missing(Kinds::QUANTITY, stop_)});
    }
    const std::string what = holds ? "a " + std::string(text(statement_)) + " holds" : "SET takes";
    report(Code::E0306, what + " a number, but this is text", tokens_[stop_].span)
        .helps("for texts to choose from, use a LIST: `LIST words: " + std::string(text(stop_)) +
               "`")
        .helps(
            "for one of several words, use a STATE: `STATE mood: calm, happy`, `SET mood TO "
            "happy`");
    return change(stop_, 1, {missing(Kinds::QUANTITY, stop_)});
  }

  // Is the name at `name` a STATE that can be the word in quotes at `word`?
  bool is_word_of_state(std::size_t name, std::size_t word) const {
    const std::string_view quoted = text(word);
    auto labels = behind_declaration("STATE", text(name));
    if (!labels || quoted.size() < 3) return false;
    while (!labels->empty()) {
      labels->remove_prefix(std::min(labels->find_first_not_of(" \t\r,:"), labels->size()));
      const std::string_view label = labels->substr(0, labels->find_first_of(" \t\r,%#"));
      if (label.empty()) return false;
      if (ascii::same(label, quoted.substr(1, quoted.size() - 2))) return true;
      labels->remove_prefix(label.size());
    }
    return false;
  }

  // `SET mood TO "happy"`
  Edit word_in_quotes() {
    Span word = tokens_[stop_].span;
    report(Code::E0306, "`SET` takes a word of a STATE without quotes", word)
        .helps("write `" + std::string(text(stop_).substr(1, text(stop_).size() - 2)) + "`")
        .fix(word, std::string(text(stop_).substr(1, text(stop_).size() - 2)));
    ++word.begin;
    --word.end;
    return change(stop_, 1, {{Kinds::NAME, word}});
  }

  // `REMEMBER awake = TRUE`, `SET awake TO FALSE`
  std::optional<Edit> value_of_truth() {
    const bool holds = begins_with(Kinds::REMEMBER) || begins_with(Kinds::LET);
    if (!(is(stop_, Kinds::TRUE) || is(stop_, Kinds::FALSE)) || stop_ != statement_ + 3 ||
        !(holds || begins_with(Kinds::SET)) || !is(stop_ - 1, holds ? Kinds::EQUAL : Kinds::TO))
      return std::nullopt;
    const std::string number = is(stop_, Kinds::TRUE) ? "1" : "0";
    const std::string name(text(statement_ + 1));
    const std::string what = holds ? "a " + std::string(text(statement_)) + " holds a number"
                                   : std::string("SET takes a number or a word of a STATE");
    report(Code::E0306, what + ", not " + quote(stop_), tokens_[stop_].span)
        .helps("write 1 for true and 0 for false, and check with `" + name + " = 1`")
        .helps(
            "for one of several words, use a STATE: `STATE mood: asleep, awake`, `mood IS awake`")
        .fix(tokens_[stop_].span, number, Applicability::likely);
    return change(stop_, 1, {missing(Kinds::QUANTITY, stop_)});
  }

  // `LIST words = "a"`, `LIST words "a"`, `LIST words: ("a", "b")`, one text a line
  std::optional<Edit> list() {
    if (stop_ == begin_ && is_name(stop_, "LIST") && is(stop_ + 1, Kinds::NAME)) {
      const std::string name(text(stop_ + 1));
      report(Code::E0001, "a LIST has a colon after its name", span(stop_, stop_ + 2))
          .helps("write `LIST " + name + ": \"one\", \"two\"`");
      return change(begin_, tokens_.size() - begin_);
    }
    if (!is(0, Kinds::LIST)) return std::nullopt;
    const bool text_in_brackets = is(stop_, Kinds::STRING) && is(stop_ - 1, Kinds::OPEN);
    const bool next_line = stop_ == begin_ && begin_ > 0;
    const bool sign = is(stop_ - 1, Kinds::MINUS) || is(stop_, Kinds::MINUS);
    if (!text_in_brackets && !next_line && !sign) return std::nullopt;
    report(
        Code::E0001,
        text_in_brackets ? "a LIST has no brackets" : "the items of a LIST are separated by commas",
        tokens_[text_in_brackets ? stop_ - 1 : stop_].span)
        .helps("write `LIST " + std::string(text(1)) + ": \"one\", \"two\"`, without END");
    const std::size_t rest = rest_of_list();
    if (!text_in_brackets && !sign) return change(stop_, rest - stop_);
    return change(stop_ - 1, rest - stop_ + 1, {missing(Kinds::QUANTITY, stop_)});
  }

  // The index of the line whose first word cannot belong to the LIST.
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
      report(Code::E0001, "`RANDOM` picks a number: `RANDOM(1, 6)`", tokens_[stop_].span)
          .helps("for a random text from a LIST, write `" + better + "`");
      return change(stop_, 1, {{Kinds::NAME, tokens_[stop_].span}});
    }
    if (!is(stop_, Kinds::OF) || stop_ == 0 || !is(stop_ + 1, Kinds::NAME)) return std::nullopt;
    const std::string list(text(stop_ + 1));
    if (is_any_name(stop_ - 1, {"ANY", "NEXT"})) {
      const std::string word(text(stop_ - 1));
      report(Code::E0009, quote(stop_ - 1) + " takes no `OF`", tokens_[stop_].span)
          .helps("write `" + word + " " + list + "`");
      return change(stop_, 1);
    }
    if (!is_any_name(stop_ - 1, {"LENGTH", "LEN", "SIZE", "NUMBER"})) return std::nullopt;
    report(Code::E0001, "the length of a LIST is its `COUNT`", span(stop_ - 1, stop_ + 2))
        .helps("write `COUNT OF " + list + "`");
    return change(stop_ - 1, 3, {missing(Kinds::QUANTITY, stop_)});
  }

  // `TIMER idle = 0s`, `START idle`
  std::optional<Edit> timer() {
    if (begins_with(Kinds::TIMER) && is(statement_ + 1, Kinds::NAME) && stop_ == statement_ + 2) {
      report(Code::E0009, "a TIMER starts at 0 on its own: nothing follows its name",
             span(stop_, end_))
          .helps("write `TIMER " + std::string(text(statement_ + 1)) + "`");
      return change(stop_, end_ - stop_);
    }
    if (stop_ != statement_ || !is(stop_, Kinds::START) || !is(stop_ + 1, Kinds::NAME))
      return std::nullopt;
    report(Code::E0001, "`START` starts nothing here", tokens_[stop_].span)
        .helps("to start a TIMER again, write `RESTART " + std::string(text(stop_ + 1)) + "`")
        .helps("to start a MOTION, write `PERFORM " + std::string(text(stop_ + 1)) + "`");
    return change(stop_, 1);
  }

  // Rows of a MOTION with commas, a colon, a verb or a text, or without AT.
  std::optional<Edit> table() {
    if (!is(0, Kinds::MOTION) || begin_ == 0) return columns();
    if (is(stop_, Kinds::END) || is(stop_, Kinds::NEWLINE) || before_ == stop_) return std::nullopt;
    if (is_operator(tokens_[stop_].kind) && is(begin_, Kinds::AT)) {
      const std::string better = "`(" + text(stop_ - 1, std::min(stop_ + 2, end_)) + ")`";
      report(Code::E0001, "a calculated value needs brackets here",
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
        .helps("separated by spaces: `AT 0s 10deg 20deg`; `-` for an actuator still on its way");
    return rows_dropped();
  }

  // A line of a CHECK with its label last: `OTHERWISE far`, `BELOW 30cm near`
  std::optional<Edit> band() {
    if (!is(0, Kinds::CHECK) || begin_ == 0 ||
        !is_one_of(tokens_[begin_].kind, {Kinds::OTHERWISE, Kinds::BELOW, Kinds::ABOVE}))
      return std::nullopt;
    const std::size_t word = begin_ + (is(begin_, Kinds::OTHERWISE) ? 1 : 2);
    if (end_ != word + 1 || !is(word, Kinds::NAME) ||
        (word == begin_ + 2 && !is(begin_ + 1, Kinds::QUANTITY)))
      return std::nullopt;
    const std::string better = std::string(text(word)) + " " + text(begin_, word);
    report(Code::E0001, "in a line of a CHECK, the word comes first", span(begin_, end_))
        .helps("write `" + better + "`")
        .fix(span(begin_, end_), better, Applicability::likely);
    Tokens turned{tokens_[word], tokens_[begin_]};
    if (word == begin_ + 2) turned.push_back(tokens_[begin_ + 1]);
    return change(begin_, end_ - begin_, std::move(turned));
  }

  // `MOTION wave OF left_arm AND right_arm`
  std::optional<Edit> columns() {
    if (!is(0, Kinds::MOTION) || !is(stop_, Kinds::AND)) return std::nullopt;
    report(Code::E0001, "the actuators of a MOTION are separated by commas", tokens_[stop_].span)
        .helps("write `" + text(stop_ - 1, stop_) + ", " + text(stop_ + 1, stop_ + 2) + "`")
        .fix(tokens_[stop_].span, ",", Applicability::likely);
    return change(stop_, 1, {{Kinds::COMMA, tokens_[stop_].span}});
  }

  // Drops all rows: a person who writes one row wrongly writes all of them that way.
  Edit rows_dropped() const {
    std::size_t last = tokens_.size();
    while (last > begin_ && !is(last, Kinds::END))
      --last;
    const bool ends = last > begin_;
    Tokens row{missing(Kinds::AT, begin_), missing(Kinds::QUANTITY, begin_),
               missing(Kinds::QUANTITY, begin_), missing(Kinds::NEWLINE, begin_)};
    return change(begin_, (ends ? last : end_) - begin_, std::move(row));
  }

  // `ELSE x > 3 DO`; an ELSE IF after an ELSE, or in a rule
  std::optional<Edit> else_if() {
    if (statement_ > 0 && is(statement_ - 1, Kinds::ELSE) && is_relation(tokens_[stop_].kind) &&
        has(stop_, end_, Kinds::DO)) {
      report(Code::E0001, "`ELSE` takes no condition; for another condition, write `ELSE IF`",
             tokens_[statement_ - 1].span);
      return change(statement_ - 1, 1, {{Kinds::ELSE_IF, tokens_[statement_ - 1].span}});
    }
    if (!is(stop_, Kinds::ELSE_IF)) return std::nullopt;
    std::size_t end = stop_;
    while (end < tokens_.size() && !is(end, Kinds::DO))
      ++end;
    const auto block = open_block();
    if (end == tokens_.size() || !block || !is(*block, Kinds::WHEN)) return std::nullopt;
    report(Code::E0001, "ELSE IF belongs to an IF; a rule has one ELSE", tokens_[stop_].span)
        .helps("write two rules, or `ELSE` and an IF with its own END");
    return if_in_else();
  }

  // Reads it as `ELSE` and an IF that ends before the END of the rule: that IF may have its own ELSE.
  Edit if_in_else() const {
    const Span here = tokens_[stop_].span;
    BlockWalk walk(tokens_);
    std::size_t last = 0, depth = 0;
    for (; last < tokens_.size(); ++last) {
      walk.step(last);
      if (last == stop_) depth = walk.open().size();
      if (last > stop_ && walk.open().size() < depth) break;
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
      report(Code::E0009, quote(stop_) + " takes no `IS` before it", tokens_[stop_ - 1].span);
      return change(stop_ - 1, 1);
    }
    report(Code::E0001, "`IS` compares words, but " + quote(stop_) + " is a number",
           tokens_[stop_ - 1].span)
        .helps("to compare numbers, use `=`, `<`, `>` or `IS BETWEEN 2 AND 5`");
    return change(stop_ - 1, 1, {{Kinds::EQUAL, tokens_[stop_ - 1].span}});
  }

  // The start of the question at `at`: after the word that asks, an AND, an OR, a NOT or a bracket.
  std::size_t asked_from(std::size_t at) const {
    while (at > 0 && (is(at - 1, Kinds::NAME) || is(at - 1, Kinds::QUANTITY)))
      --at;
    return at;
  }

  // `voice WORD IS "stop" OR "go"`
  std::optional<Edit> one_of_words() {
    const bool joined = is(stop_ - 1, Kinds::OR) || is(stop_ - 1, Kinds::AND);
    if (stop_ < 4 || !is(stop_, Kinds::STRING) || !joined || !asks_before(stop_))
      return std::nullopt;
    const std::size_t word = stop_ - 2;
    const bool negated = is(word - 1, Kinds::NOT);
    const std::size_t sign = word - (negated ? 2 : 1);
    const std::size_t first = asked_from(sign);
    if (!is(sign, Kinds::IS) || first == sign) return std::nullopt;
    const std::string question = text(first, word);
    Diagnostic& message =
        report(Code::E0001, "what follows " + quote(stop_ - 1) + " is not a condition on its own",
               tokens_[stop_].span);
    message.helps("write both conditions in full: `" + question + " " + std::string(text(word)) +
                  " " + std::string(negated ? "AND" : text(stop_ - 1)) + " " + question + " " +
                  std::string(text(stop_)) + "`");
    Span front = tokens_[stop_].span;
    front.end = front.begin;
    if (!negated && is(stop_ - 1, Kinds::OR) && !is(first - 1, Kinds::NOT))
      message.fix(front, question + " ", Applicability::likely);
    return change(stop_, 0,
                  Tokens(tokens_.begin() + static_cast<std::ptrdiff_t>(first),
                         tokens_.begin() + static_cast<std::ptrdiff_t>(word)));
  }

  // `voice WORD IS ("stop" OR "go")`
  std::optional<Edit> words_in_brackets() {
    const bool negated = is(stop_ - 1, Kinds::NOT);
    const std::size_t sign = stop_ - (negated ? 2 : 1);
    if (stop_ < 3 || !is(stop_, Kinds::OPEN) || !is(sign, Kinds::IS)) return std::nullopt;
    const std::size_t first = asked_from(sign), close = closing(stop_);
    if (first == sign || close >= end_ || close < stop_ + 2) return std::nullopt;
    const std::string question = text(first, stop_);
    std::string better = question;
    for (std::size_t at = stop_ + 1; at < close; ++at) {
      if (!is_one_of(tokens_[at].kind, {Kinds::NAME, Kinds::STRING, Kinds::OR, Kinds::COMMA}))
        return std::nullopt;
      const bool next = is(at, Kinds::OR) || is(at, Kinds::COMMA);
      better += " " + (next ? (negated ? "AND " : "OR ") + question : std::string(text(at)));
    }
    report(Code::E0001, "`IS` takes one word, without brackets", span(stop_, close + 1))
        .helps("write `" + better + "`")
        .fix(span(first, close + 1), negated ? better : "(" + better + ")", Applicability::likely);
    return change(stop_, close + 1 - stop_, {tokens_[stop_ + 1]});
  }

  // Steps of a TEST.
  std::optional<Edit> expect() {
    if (!is(begin_, Kinds::EXPECT)) return std::nullopt;
    const std::size_t first = begin_ + 1;
    const Span here = tokens_[first].span;
    if (is(first, Kinds::NOT)) {
      report(Code::E0001, "`EXPECT` takes `NO`, not `NOT`", here)
          .fix(here, "NO", Applicability::likely);
      return change(first, 1, {{Kinds::NO, here}});
    }
    if (is(first, Kinds::STOP)) {
      report(Code::E0001, "a TEST checks that an actuator was `STOPPED`", here)
          .helps("write `EXPECT STOPPED " + std::string(text(first + 1)) + "`");
      return change(first, 1, {{Kinds::NAME, here}});
    }
    if (is(first, Kinds::NOTHING) && !has(first, end_, Kinds::FOR)) {
      report(Code::E0008, "this does not say how long nothing may happen", here)
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
      report(Code::E0001, "the text of " + word + " goes in quotes", tokens_[first + 1].span)
          .helps("write `EXPECT " + word + " \"…\"`");
      return change(first + 1, 1, {{Kinds::STRING, tokens_[first + 1].span}});
    }
    const bool asks = is(stop_, Kinds::EQUAL)
                          ? stop_ <= first + 2 && is(stop_ + 1, Kinds::QUANTITY) &&
                                text(first).find_first_of("abcdefghijklmnopqrstuvwxyz") == 0
                          : is_relation(tokens_[stop_].kind) || is(stop_, Kinds::IS);
    if (is(first, Kinds::NAME) && asks) {
      report(Code::E0008, "`THAT` is missing after `EXPECT`", tokens_[begin_].span)
          .helps("write `EXPECT THAT " + text(first, end_) + "`");
      return change(first, 0, {missing(Kinds::THAT, first)});
    }
    const bool counts = is(first, Kinds::QUANTITY) && is(first + 1, Kinds::TIMES);
    if (!counts || stop_ < end_ || has(first, end_, Kinds::WITHIN)) return std::nullopt;
    report(Code::E0008, "this does not say within what time to count the commands",
           span(first, first + 2))
        .helps("write `" + text(begin_, end_) + " WITHIN 2s`");
    return change(end_, 0, {missing(Kinds::WITHIN, end_), missing(Kinds::QUANTITY, end_)});
  }

  // `RANDOM(6)`, `RANDOM()`, `RANDOM(1, 2, 3)`
  std::optional<Edit> random() {
    std::size_t open = stop_;
    while (open > begin_ && !(is(open, Kinds::OPEN) && is(open - 1, Kinds::RANDOM)))
      --open;
    if (open == begin_) return std::nullopt;
    const std::size_t close = closing(open);
    const bool comma = has_comma(open + 1, stop_);
    const bool few = is(stop_, Kinds::CLOSE) && stop_ == close && !comma;
    const bool many = is(stop_, Kinds::COMMA) && comma && close < end_;
    if (!few && !many) return std::nullopt;
    report(Code::E0411, "`RANDOM` takes two numbers", tokens_[open - 1].span)
        .helps("it picks a number from the first to the second: `RANDOM(1, 6)`");
    if (many) return change(stop_, close - stop_);
    Tokens lacking;
    if (stop_ == open + 1) lacking.push_back(missing(Kinds::QUANTITY, stop_));
    lacking.push_back(missing(Kinds::COMMA, stop_));
    lacking.push_back(missing(Kinds::QUANTITY, stop_));
    return change(stop_, 0, std::move(lacking));
  }

  // `ROUND touch LEVEL`, `MIN(1, 2, 3)`, `MIN()`
  std::optional<Edit> function() {
    const auto known = [this](std::size_t at) {
      return is(at, Kinds::NAME) && find_function(text(at)) != nullptr;
    };
    const std::size_t name = stop_ - 2;
    if (stop_ >= 2 && known(name) && is(stop_ - 1, Kinds::NAME) && is(stop_, Kinds::NAME)) {
      const std::string word(text(name));
      report(Code::E0001, "`" + word + "` takes its number in brackets", tokens_[name].span)
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
    report(Code::E0411, "`" + word + "` takes " + (pair ? "two numbers" : "one number"),
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
      report(Code::E0001, "a DEFINE lists its values after `WITH`, without brackets",
             tokens_[stop_].span)
          .helps("write `DEFINE " + std::string(text(stop_ - 1)) + better + "`");
      return bare(close);
    }
    const std::size_t open = statement_ + 1;
    if (open >= end_ || !is_call(open) || stop_ <= open) return std::nullopt;
    const std::size_t close = closing(open);
    const std::string values = text(open + 1, close);
    report(Code::E0001, "a DEFINE gets its values after `WITH`, without brackets",
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
    const bool whole = is(before_, Kinds::CLOSE) && (is_name(statement_, "SAY") || last_call(last));
    const bool command = begins_with(Kinds::NAME) && stop_ > statement_ &&
                         (stop_ < last || (whole && stop_ == last));
    const bool test = is(begin_, Kinds::AT) || is(begin_, Kinds::EXPECT);
    if (!command || test || has_comma(statement_, stop_) || has(statement_, last, Kinds::STRING))
      return std::nullopt;
    std::size_t first = stop_;
    while (first > statement_ + 1 && !is_preposition(tokens_[first - 1].kind))
      --first;
    const bool behind_preposition = is_preposition(tokens_[first - 1].kind);
    if (!behind_preposition) first = std::max(first, last_call(stop_ + 2));
    const std::size_t end = number_end(first, statement_end());
    const bool gets_on = end > stop_ || stop_ >= last;
    if (!gets_on || !worked_out_at(first) || !is_balanced(first, end)) return std::nullopt;
    const std::string number = text(first, end);
    const std::string brackets = "(" + number + ")";
    if (behind_preposition) {
      report(Code::E0505, "a calculated value needs brackets here", span(first, end))
          .helps("write `" + brackets + "`");
    } else if (is_name(statement_, "SAY")) {
      report(Code::E0505, "text begins with words in quotes, but this is a number",
             span(first, end))
          .helps("write the words, a comma and the number: `SAY \"…\", " + number + "`");
    } else {
      Diagnostic& d =
          report(Code::E0008, "this does not say what the number is for", span(first, end));
      d.helps("put it in brackets after TO, BY, AT, OVER or FOR, such as `TO " + brackets + "`");
      if (is_name(statement_, "SHOW"))
        d.fix(span(first, end), "TO " + brackets, Applicability::likely);
    }
    return change(first, end - first,
                  behind_preposition ? Tokens{missing(Kinds::QUANTITY, first)} : Tokens{});
  }

  // The function that is called last before `end`, such as `ROUND(` behind the actuator; 0: none.
  std::size_t last_call(std::size_t end) const {
    std::size_t call = 0;
    for (std::size_t open = statement_ + 3; open < end; ++open)
      if (is_call(open) || (is(open, Kinds::OPEN) && is(open - 1, Kinds::RANDOM))) call = open - 1;
    return call;
  }

  // A preposition after the number belongs to the command again.
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

  // Does a calculation begin there, where the grammar takes a plain value?
  bool worked_out_at(std::size_t first) const {
    if (is(stop_, Kinds::COUNT) || is(stop_, Kinds::RANDOM)) return true;
    if (is(stop_, Kinds::NEWLINE) || is(stop_, Kinds::END)) return true;  // SAY (3 + 4)
    if (is(stop_, Kinds::OPEN)) return is_call(stop_) && stop_ - 1 >= first;
    if (is(first, Kinds::MINUS) && stop_ == first + 1) return is(stop_, Kinds::NAME);
    return (first + 1 < stop_ && is_call(first + 1)) ||
           (is_operator(tokens_[stop_].kind) && first < stop_ && may_begin(first));
  }

  bool may_begin(std::size_t first) const {
    return is_preposition(tokens_[first - 1].kind) || is_name(statement_, "SAY");
  }

  // `SHOW face happy` outside of all blocks
  std::optional<Edit> outside() {
    if (stop_ != begin_ || open_block() || !contains(expected_, Kinds::WHEN) ||
        !contains(expected_, Kinds::DEFINE) || !is_stray(begin_))
      return std::nullopt;
    std::size_t last = end_;
    while (last + 1 < tokens_.size() && is_stray(last + 1))
      last = end_of_line(last + 1);
    if (is(last + 1, Kinds::END)) return std::nullopt;  // of a block whose head is missing
    report(Code::E0001, "a line cannot begin with " + quote(begin_) + " here", tokens_[begin_].span)
        .helps("commands belong in a rule or a DEFINE: `WHEN ... DO ... END`");
    return change(begin_, last - begin_);
  }

  std::size_t end_of_line(std::size_t at) const {
    while (at < tokens_.size() && !is(at, Kinds::NEWLINE))
      ++at;
    return at;
  }

  // A line of words that is neither a question nor an item whose first word is missing.
  bool is_stray(std::size_t first) const {
    const std::size_t end = end_of_line(first);
    const TokenKind kind = tokens_[first].kind;
    const bool statement =
        (roles_of(kind) & role::statement) != 0 && (roles_of(kind) & role::opens) == 0;
    if (!(is(first, Kinds::NAME) || statement) || end < first + 2 ||
        nearest_keyword(text(first), role::item | role::part | role::after) != nullptr)
      return false;
    for (std::size_t at = first; at < end; ++at)
      if (is_relation(tokens_[at].kind) ||
          is_one_of(tokens_[at].kind,
                    {Kinds::IS, Kinds::BECOMES, Kinds::CHANGES, Kinds::DO, Kinds::PRIORITY,
                     Kinds::COLON, Kinds::OF, Kinds::WITH, Kinds::FROM, Kinds::END}))
        return false;
    const bool limit =
        is(first, Kinds::NAME) && is(first + 1, Kinds::NAME) && is(first + 2, Kinds::TO) &&
        std::ranges::any_of(text(first), [](char c) { return c >= 'a' && c <= 'z'; });
    const std::size_t next = end + 1;
    return !limit && (next >= tokens_.size() || is(next, Kinds::NEWLINE) || is(next, Kinds::END) ||
                      (roles_of(tokens_[next].kind) & role::after) == 0);
  }
};

}  // namespace

std::optional<Edit> explain_habit(const Tokens& tokens, const SourceFile& source,
                                  const Attempt& failure, Diagnostics& diagnostics) {
  return Habits(tokens, source, failure, diagnostics).find();
}

}  // namespace robosync::compiler
