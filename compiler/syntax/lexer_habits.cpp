// Part of the lexer: habits from other languages that the text of a line shows. Each is reported and read as what was
// meant. See lexer_state.hpp.
#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/lexer_state.hpp"
#include "compiler/syntax/word_list.hpp"

namespace robosync::compiler {

namespace {

// Words that ask something, and words that calculate.
bool asks(TokenKind kind) {
  return is_one_of(kind, {Kinds::WHEN, Kinds::WHILE, Kinds::IF, Kinds::ELSE_IF, Kinds::WAIT,
                          Kinds::RESUME, Kinds::REPEAT, Kinds::EXPECT, Kinds::SAFETY});
}

bool calculates(TokenKind kind) {
  return asks(kind) || is_one_of(kind, {Kinds::SET, Kinds::RAISE, Kinds::LOWER, Kinds::LOG,
                                        Kinds::ALERT, Kinds::LET, Kinds::REMEMBER});
}

}  // namespace

// ---- the rest of the line

std::string_view LexerState::rest_of_line(std::size_t from) const {
  return text_.substr(from, std::min(text_.find_first_of("\r\n", from), text_.size()) - from);
}

// The first token of the statement that holds the last token. The number of tokens if a new statement begins here, or if
// this one began too far back.
std::size_t LexerState::first_of_statement() const {
  constexpr std::size_t most = 256;  // tokens: the text may come from outside
  std::size_t first = tokens_.size();
  while (first > 0 &&
         !is_one_of(tokens_[first - 1].kind, {Kinds::NEWLINE, Kinds::DO, Kinds::ELSE})) {
    if (tokens_.size() - --first > most) return tokens_.size();
  }
  return first;
}

bool LexerState::behind_value() const {
  if (tokens_.empty()) return false;
  const Token& last = tokens_.back();
  if (last.kind != Kinds::QUANTITY) return last.kind == Kinds::NAME || last.kind == Kinds::CLOSE;
  const char end = text_[last.span.end - 1];
  return end >= '0' && end <= '9';
}

bool LexerState::is_declared(std::string_view name) const {
  constexpr std::size_t most = 4096;  // tokens: the text may come from outside
  for (std::size_t at = 1; at < std::min(tokens_.size(), most); ++at) {
    const Span span = tokens_[at].span;
    if (is_one_of(tokens_[at - 1].kind, {Kinds::LET, Kinds::REMEMBER, Kinds::FEELING}) &&
        ascii::same(text_.substr(span.begin, span.end - span.begin), name))
      return true;
  }
  return false;
}

// True when values and signs alternate up to the end, a DO or an END: the text may continue a calculation and is not a
// sentence.
bool LexerState::is_calculation(std::string_view text) const {
  constexpr std::string_view signs = "+-*/<>=,";
  bool wants_value = true;
  for (std::size_t at = text.find_first_not_of(" \t"); at < text.size();
       at = std::min(text.find_first_not_of(" \t", at), text.size())) {
    const char c = text[at];
    if (signs.find(c) != std::string_view::npos) {
      if (wants_value && c != '-' && c != '=' && c != '>') return false;
      wants_value = true;
      ++at;
      continue;
    }
    const bool bracket = c == '(' || c == ')';
    const std::size_t length = bracket ? 1 : word_length(text.substr(at));
    const std::string_view word = text.substr(at, length);
    at += length;
    if (c == ')' && !wants_value) continue;
    if (!wants_value && (word == "DO" || word == "END")) return true;
    if (!wants_value && ascii::same(word, "DO")) return at == text.size();
    const bool joins = ascii::same(word, "AND") || ascii::same(word, "OR");
    const bool value = c == '(' || (c >= '0' && c <= '9') || is_declared(word);
    if (length == 0 || wants_value == joins || (!joins && !value)) return false;
    wants_value = joins || c == '(';
  }
  return !wants_value;
}

// True when a bracket is open in this statement and the rest of the line may close it.
bool LexerState::brackets_open() const {
  int open = 0;
  for (std::size_t at = first_of_statement(); at < tokens_.size(); ++at) {
    if (tokens_[at].kind == Kinds::OPEN) ++open;
    if (tokens_[at].kind == Kinds::CLOSE) --open;
  }
  return open > 0 && rest_of_line(start_).find(')') != std::string_view::npos;
}

// Since the last AND or OR.
bool LexerState::has_relation() const {
  for (std::size_t at = tokens_.size(); at > first_of_statement(); --at) {
    const TokenKind kind = tokens_[at - 1].kind;
    if (kind == Kinds::AND || kind == Kinds::OR) return false;
    if (is_relation(kind) || is_one_of(kind, {Kinds::IS, Kinds::BECOMES, Kinds::CHANGES}))
      return true;
  }
  return false;
}

// The first word or sign of the next line that is not empty; nothing at the end.
std::string_view LexerState::next_line() const {
  const std::size_t line_end = start_ + rest_of_line(start_).size();
  const std::size_t word = std::min(text_.find_first_not_of(" \t\r\n", line_end), text_.size());
  return text_.substr(word, std::max<std::size_t>(word_length(text_.substr(word)), 1));
}

// Does the next line begin with a sign, so that it may continue this one?
bool LexerState::next_line_has_sign() const {
  const std::string_view next = next_line();
  return !next.empty() && word_length(next) == 0;
}

// Or with a word such as DO or AND?
bool LexerState::next_line_goes_on() const {
  const Keyword* const keyword = find_keyword(next_line());
  const bool after = keyword != nullptr && (keyword->roles & role::after) != 0;
  return next_line_has_sign() || (after && keyword->kind != Kinds::END);
}

// ---- words

// `ENDIF` at the start of a line, as in other languages.
bool LexerState::foreign_end() {
  if (!tokens_.empty() && tokens_.back().kind != Kinds::NEWLINE) return false;
  constexpr std::string_view ends[] = {"ENDIF",     "END_IF",    "ENDWHEN",     "ENDWHILE",
                                       "ENDDEFINE", "ENDREPEAT", "ENDBEHAVIOR", "ENDDEF"};
  if (std::ranges::none_of(ends,
                           [this](std::string_view end) { return ascii::same(end, lexeme()); }))
    return false;
  report(Code::E0007, "every block of RSL ends with `END`").label(here()).fix(here(), "END");
  token(Kinds::END);
  return true;
}

// `isn't > 3`, `isn't 3`: the grammar stops there, and misplaced_words.cpp explains the whole comparison.
bool LexerState::compares(std::size_t from) const {
  constexpr std::string_view begins_it = "<>=!0123456789-";
  const std::size_t next = text_.find_first_not_of(" \t", from);
  return next != std::string_view::npos && begins_it.find(text_[next]) != std::string_view::npos;
}

// `isn't`, `isnt`, `doesn't`, in a line that asks: the ' does not begin a text.
bool LexerState::negation() {
  constexpr std::string_view states[] = {"isn", "aren", "wasn", "weren"};
  constexpr std::string_view others[] = {"doesn", "don", "didn", "hasn", "haven"};
  constexpr std::string_view endings[] = {"'t", "\xe2\x80\x99t"};
  constexpr std::string_view joined[] = {"isnt", "arent", "wasnt", "werent"};
  const auto is_word = [this](std::string_view one) { return ascii::same(one, lexeme()); };
  const bool whole = std::ranges::any_of(joined, is_word);
  const bool state = whole || std::ranges::any_of(states, is_word);
  if (!state && std::ranges::none_of(others, is_word)) return false;
  const auto* const ending = std::ranges::find_if(endings, [this](std::string_view one) {
    return ascii::same(text_.substr(cursor_, one.size()), one) &&
           word_length(text_.substr(cursor_ + one.size())) == 0;
  });
  const std::size_t first = first_of_statement();
  if ((!whole && ending == std::end(endings)) || first == tokens_.size() ||
      !asks(tokens_[first].kind))
    return false;
  if (!whole) cursor_ += ending->size();
  constexpr std::string_view truth = " TRUE";
  const bool is_false = ascii::same(text_.substr(cursor_, truth.size()), truth);
  if (is_false) cursor_ += truth.size();
  const std::string better = is_false ? "IS FALSE" : "IS NOT";
  if (!state || is_false || !compares(cursor_)) {
    Diagnostic& message =
        report(Code::E0007, "`" + std::string(lexeme()) + "` is written `" + better + "` in RSL")
            .label(here());
    if (state) message.fix(here(), better, Applicability::likely);
  }
  token(Kinds::IS);
  token(is_false ? Kinds::FALSE : Kinds::NOT);
  return true;
}

namespace {

// The number in `= 1 TO 3` and `IN range(3)`; otherwise "3", as an example.
std::string_view times_of_loop(std::string_view line) {
  constexpr std::string_view kDigits = "0123456789", kBlanks = " \t";
  for (const std::string_view begin : {"= 1 TO ", "IN 1 TO ", "FROM 1 TO ", "IN range("}) {
    std::string_view rest = line.substr(std::min(line.find_first_not_of(kBlanks), line.size()));
    if (!ascii::same(rest.substr(0, begin.size()), begin)) continue;
    rest.remove_prefix(begin.size());
    const std::string_view number = rest.substr(0, rest.find_first_not_of(kDigits));
    rest.remove_prefix(number.size());
    const bool whole = rest.empty() || rest.front() == ' ' || rest.front() == ')';
    if (whole && !number.empty()) return number;
  }
  return "3";
}

}  // namespace

// `LOOP 3 TIMES`, `FOR 3 TIMES`, `FOR i = 1 TO 3`, `FOR i IN range(3)` where a statement begins: a block, whose END would
// otherwise close another one.
bool LexerState::foreign_loop() {
  const bool loop = ascii::same(lexeme(), "LOOP"), each = ascii::same(lexeme(), "FOR");
  const bool begins =
      tokens_.empty() || is_one_of(tokens_.back().kind, {Kinds::NEWLINE, Kinds::DO, Kinds::ELSE});
  if (!(loop || each) || !begins) return false;
  constexpr std::string_view in = " IN ";
  const std::string_view line = rest_of_line(cursor_);
  const std::size_t line_end = cursor_ + line.size();
  const std::size_t word = std::min(line.find_first_not_of(" \t"), line.size());
  const bool digit = word < line.size() && line[word] >= '0' && line[word] <= '9';
  const bool counts =
      digit && (loop || ascii::same(line.substr(line.find_last_of(" \t") + 1), "TIMES"));
  const std::size_t name = word_length(line.substr(word));
  const bool counts_up = each && name > 0 && !digit &&
                         (line.find('=') != std::string_view::npos ||
                          ascii::same(line.substr(word + name).substr(0, in.size()), in));
  if (!counts && !counts_up) return false;
  Diagnostic& message =
      report(Code::E0007, "`" + std::string(lexeme()) + "` is written `REPEAT` in RSL")
          .label(here());
  token(Kinds::REPEAT);
  if (counts) {
    message.fix(here(), "REPEAT");
    return true;
  }
  message.helps("write `REPEAT " + std::string(times_of_loop(line.substr(word + name))) +
                " TIMES`; to count along, use a REMEMBER");
  cursor_ = line_end;
  tokens_.push_back({Kinds::QUANTITY, span(cursor_, cursor_)});
  tokens_.push_back({Kinds::TIMES, span(cursor_, cursor_)});
  return true;
}

// ---- apostrophes, and signs after a number

// `2'500ms`
bool LexerState::apostrophe_in_number() {
  const auto is_digit = [this](std::size_t at) {
    return at < text_.size() && text_[at] >= '0' && text_[at] <= '9';
  };
  if (text_[start_] != '\'' || start_ == 0 || tokens_.empty() ||
      tokens_.back().kind != Kinds::QUANTITY || tokens_.back().span.end != start_ ||
      !is_digit(start_ - 1) || !is_digit(start_ + 1))
    return false;
  cursor_ = start_ + 1;
  while (cursor_ < text_.size() && (is_word_byte(text_[cursor_]) || text_[cursor_] == '\'' ||
                                    text_[cursor_] == '.' || text_[cursor_] == '%'))
    ++cursor_;
  const Span all = span(tokens_.back().span.begin, cursor_);
  std::string better(text_.substr(all.begin, all.end - all.begin));
  std::erase(better, '\'');
  report(Code::E0004, "a number contains no '")
      .label(all, "write `" + better + "`")
      .fix(all, better, Applicability::likely);
  return true;
}

// `'It's nice'`: a letter touches the ' that seems to end the text.
bool LexerState::apostrophe_in_text() {
  const auto is_letter_at = [this](std::size_t at) {
    return at < text_.size() && is_word_byte(text_[at]);
  };
  if (text_[start_] != '\'' || !is_letter_at(cursor_)) return false;
  constexpr std::size_t longest = 200;
  const std::size_t last = std::min(text_.size(), cursor_ + longest);
  const auto is_line_end = [this](std::size_t at) {
    return text_[at] == '\n' || text_[at] == '\r';
  };
  std::size_t end = cursor_;
  while (end < last && !is_line_end(end) && (text_[end] != '\'' || is_letter_at(end + 1)))
    ++end;
  if (end == last || is_line_end(end)) return false;
  const std::string inside(text_.substr(start_ + 1, end - start_ - 1));
  cursor_ = end + 1;
  Diagnostic& message = report(Code::E0003, "text between two ' cannot contain a '")
                            .label(here())
                            .helps("put text that contains a ' between two \"");
  if (inside.find('"') == std::string::npos)
    message.fix(here(), "\"" + inside + "\"", Applicability::likely);
  token(Kinds::STRING);
  return true;
}

// `f"n is {n}"`: the letter goes.
void LexerState::text_of_python() {
  if (tokens_.empty() || tokens_.back().kind != Kinds::NAME || tokens_.back().span.end != start_)
    return;
  const Span letter = tokens_.back().span;
  if (!has_word("F B R U", text_.substr(letter.begin, letter.end - letter.begin))) return;
  tokens_.pop_back();
  Diagnostic& message = report(Code::E0003, "a text has no letter before its quotes").label(letter);
  const std::string_view text = lexeme();
  const std::size_t open = text.find('{'), close = text.find('}');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) return;
  message.helps("a value stands behind the text: `LOG \"now\", " +
                std::string(text.substr(open + 1, close - open - 1)) + "`");
}

// `SET n TO n % 2`: other languages' MOD. In brackets, or before a comparison, it can mean nothing else.
bool LexerState::modulo() {
  const std::string_view rest = rest_of_line(start_ + 1);
  const std::size_t first = first_of_statement();
  if (first == tokens_.size() || !calculates(tokens_[first].kind) || !behind_value() ||
      !is_calculation(rest))
    return false;
  const Span sign = span(start_, start_ + 1);
  const auto is_blank = [this](std::size_t at) { return text_[at] == ' ' || text_[at] == '\t'; };
  const std::string better =
      std::string(is_blank(start_ - 1) ? "" : " ") + "MOD" + (is_blank(start_ + 1) ? "" : " ");
  const bool compares = asks(tokens_[first].kind) && !has_relation() &&
                        rest.find_first_of("<>=") != std::string_view::npos;
  const std::string_view last = rest.substr(rest.find_last_of(' ') + 1);
  const bool sure =
      (brackets_open() || compares || last == "END" || last == "DO") && !next_line_has_sign();
  Diagnostic& message =
      sure ? report(Code::E0001, "`%` begins a comment in RSL; it does not calculate")
           : report(Code::W0103, "the rest of this line is a comment: nothing is calculated");
  message.label(sign).helps("for the remainder of a division, use `MOD`, such as `n MOD 2`");
  if (!sure) message.helps("for a comment, write # instead of %");
  message.fix(sign, better, Applicability::likely);
  if (!sure) return true;
  cursor_ = sign.end;
  token(Kinds::MOD);
  return true;
}

// `WHEN joy > 40 % DO`: as a comment, it would take the DO from the question.
bool LexerState::percent_of_question() {
  const std::size_t first = first_of_statement();
  if (!asks(tokens_[first].kind)) return false;
  const std::string_view rest = rest_of_line(start_ + 1);
  const bool has_do = ascii::same(rest.substr(rest.find_last_of(' ') + 1), "DO") ||
                      rest.find(" DO ") != std::string_view::npos;
  if (!has_do || next_line_goes_on()) return false;
  const Span number = tokens_.back().span;
  const std::string better =
      std::string(text_.substr(number.begin, number.end - number.begin)) + "%";
  report(Code::E0004, "a unit follows its number without a space")
      .label(span(number.begin, start_ + 1))
      .helps("write `" + better + "`; after a space, `%` begins a comment")
      .fix(span(number.begin, start_ + 1), better, Applicability::likely);
  cursor_ = start_ + 1;
  return true;
}

// `n // 2`
void LexerState::whole_division() {
  const Span left = tokens_.back().span;
  const std::string value(text_.substr(left.begin, left.end - left.begin));
  std::string_view rest = rest_of_line(start_ + 2);
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  const std::string by(rest.substr(0, rest.find_first_not_of("0123456789.")));
  const bool plain = !by.empty() && by.size() == rest.size() && tokens_.size() > 1 &&
                     is_one_of(tokens_[tokens_.size() - 2].kind, {Kinds::TO, Kinds::EQUAL});
  const std::string better =
      plain ? "(" + value + " - " + value + " MOD " + by + ") / " + by : "(n - n MOD 2) / 2";
  Diagnostic& message =
      report(Code::E0002, "`//` does not divide in RSL")
          .label(span(start_, start_ + 2))
          .helps("`/` divides and keeps three decimals; to round down, write `" + better + "`");
  if (plain) message.fix(span(left.begin, cursor_), better, Applicability::likely);
  cursor_ = start_ + 2;
  token(Kinds::SLASH);
}

// `x := 4`, `SET x := 4`: the grammar stops there, and foreign_habits.cpp explains the whole line.
void LexerState::assignment() {
  const std::size_t first = first_of_statement();
  const std::size_t words = tokens_.size() - first;
  std::size_t before = first;
  while (before > 0 && tokens_[before - 1].kind == Kinds::NEWLINE)
    --before;
  const unsigned roles = before > 0 ? roles_of(tokens_[before - 1].kind) : 0U;
  const bool goes_on = (roles & role::before) != 0 && (roles & role::begins) == 0;
  const bool set = words == 2 && tokens_[first].kind == Kinds::SET;
  if ((words == 1 || set) && !goes_on && tokens_.back().kind == Kinds::NAME)
    token(Kinds::EQUAL);
  else
    instead(Kinds::EQUAL, "=");
}

// Whoever writes one writes many. Beside braces, the braces are the mistake. At the end of a line it only has to go.
void LexerState::report_semicolons() {
  constexpr std::size_t most = 4;  // places shown
  if (semicolons_.empty() || has_brace_) return;
  Diagnostic& message = report(Code::E0002, "RSL does not use `;`");
  message.label(semicolons_.front(), "a statement ends with its line");
  const std::size_t shown = std::min(semicolons_.size(), most);
  for (std::size_t at = 1; at < shown; ++at)
    message.label(semicolons_[at], "and here", false);
  message.appears_in_more(semicolons_.size() - shown);
  constexpr std::size_t most_fixes = 10'000;  // the text may come from outside
  if (semicolons_.size() > most_fixes) semicolons_.resize(most_fixes);
  for (const Span sign : semicolons_) {
    const std::size_t next = std::min(text_.find_first_not_of(" \t", sign.end), text_.size());
    const char behind = next < text_.size() ? text_[next] : '\n';
    const bool line_ends = behind == '\n' || behind == '\r';
    if (!line_ends && behind != '%' && behind != '#') continue;
    Span all = sign;
    while (line_ends && all.begin > 0 &&
           std::string_view(" \t;").find(text_[all.begin - 1]) != std::string_view::npos)
      --all.begin;
    message.fix(all, "");
  }
}

// ---- braces and comments

// A brace instead of DO, or after it, as in other languages. The line that opens the block is before the brace, possibly
// on the line above.
LexerState::Brace LexerState::brace_opens_a_block() {
  std::size_t end = tokens_.size();
  while (end > 0 && tokens_[end - 1].kind == Kinds::NEWLINE)
    --end;
  std::size_t first = end;
  while (first > 0 && tokens_[first - 1].kind != Kinds::NEWLINE)
    --first;
  if (first == end) return Brace::nothing;
  if (tokens_[end - 1].kind == Kinds::DO) return Brace::behind_do;
  const TokenKind kind = tokens_[first].kind;
  const bool goes_on = kind == Kinds::ELSE || kind == Kinds::ELSE_IF;
  if (!goes_on && (roles_of(kind) & role::opens) == 0) return Brace::nothing;
  const bool asks = kind == Kinds::WHEN || kind == Kinds::WHILE || kind == Kinds::EVERY ||
                    kind == Kinds::IF || kind == Kinds::ELSE_IF;
  if (asks) token(Kinds::DO);
  return Brace::for_do;
}

// The line that opens the block; it may be above the brace.
std::string_view LexerState::line_before_brace() const {
  const std::string_view before = text_.substr(0, text_.find_last_not_of(" \t\r\n{", start_) + 1);
  std::string_view line = before.substr(before.find_last_of("\r\n") + 1);
  line.remove_prefix(std::min(line.find_first_not_of(" \t}"), line.size()));
  return line;
}

namespace {

// The line as RSL writes it.
std::string line_in_rsl(std::string_view line, const Keyword* keyword) {
  if (keyword != nullptr && keyword->kind == Kinds::FOR) return "REPEAT 3 TIMES";
  if (keyword == nullptr || (keyword->kind != Kinds::ELSE && (keyword->roles & role::opens) == 0))
    return "WHEN touch LEVEL > 3 DO";
  const bool goes_on = keyword->kind == Kinds::ELSE && line.size() > keyword->spelling.size();
  const bool asks_more = goes_on || is_one_of(keyword->kind, {Kinds::EVERY, Kinds::AT}) ||
                         (asks(keyword->kind) && keyword->kind != Kinds::REPEAT);
  return std::string(line) + (asks_more && !line.ends_with("DO") ? " DO" : "");
}

}  // namespace

// In `function wave() {` the word is the mistake.
void LexerState::opening_brace() {
  const std::string_view line = line_before_brace();
  const std::string_view first = line.substr(0, word_length(line));
  const bool reported = has_brace_ || std::ranges::any_of(kForeignDefines, [first](auto one) {
                          return ascii::same(first, one);
                        });
  if (!reported)
    report(Code::E0002, "RSL has no braces: a block ends with `END`")
        .label(here())
        .helps("write `" + line_in_rsl(line, find_keyword(first)) +
               "`, then the commands, then `END`");
  has_brace_ = has_brace_ || !reported;
  braces_.push_back(brace_opens_a_block());
}

// A brace before ELSE ends nothing. A person who wrote DO before the brace may also have written END.
void LexerState::closing_brace() {
  if (braces_.empty()) {
    if (brace_is_end()) return;
    left_out("a block ends with `END`");
    return;
  }
  const Brace brace = braces_.back();
  const bool ends = brace != Brace::nothing && !word_follows({"ELSE", "ELIF"}) &&
                    !(brace == Brace::behind_do && end_follows());
  braces_.pop_back();
  if (ends) token(Kinds::END);
}

// A brace alone in its line, instead of an END.
bool LexerState::brace_is_end() {
  constexpr std::size_t most = 20;  // scans of all tokens: the text may come from outside
  const bool first = tokens_.empty() || tokens_.back().kind == Kinds::NEWLINE;
  if (!first || reports_ > most || word_follows({"ELSE", "ELIF"}) ||
      rest_of_line(cursor_).find_first_not_of(" \t") != std::string_view::npos)
    return false;
  BlockWalk walk(tokens_);
  for (std::size_t at = 0; at < tokens_.size(); ++at)
    walk.step(at);
  if (walk.open().empty()) return false;
  report(Code::E0002, "RSL has no braces: a block ends with `END`")
      .label(here())
      .fix(here(), "END", Applicability::likely);
  token(Kinds::END);
  return true;
}

// An END that is indented less closes the surrounding block instead.
bool LexerState::end_follows() const {
  const auto margin = [this](std::size_t at) {
    const std::size_t line = text_.find_last_of("\r\n", at - 1) + 1;
    return text_.find_first_not_of(" \t", line) - line;
  };
  const std::size_t word = text_.find_first_not_of(" \t\r\n", cursor_);
  return word_follows({"END"}) && margin(word) >= margin(cursor_);
}

bool LexerState::word_follows(std::initializer_list<std::string_view> words) const {
  const std::size_t word = std::min(text_.find_first_not_of(" \t\r\n", cursor_), text_.size());
  return std::ranges::any_of(words, [&](std::string_view one) {
    return ascii::same(text_.substr(word, one.size()), one);
  });
}

void LexerState::foreign_comment() {
  constexpr std::size_t shown = 2;  // of `//` or `--`
  const std::string_view words = rest_of_line(start_ + shown);
  if (text_[start_] == '/' && behind_value() && is_calculation(words)) {
    whole_division();
    return;
  }
  const bool only_words =
      !behind_value() || words.find_first_of("0123456789+*/()=<>") == std::string_view::npos;
  report(Code::E0002, "a comment in RSL begins with # or %, not with `" +
                          std::string(lexeme().substr(0, shown)) + "`")
      .label(span(start_, start_ + shown))
      .fix(span(start_, start_ + shown), "#",
           only_words ? Applicability::certain : Applicability::likely);
}

// `/* … */`, over any number of lines.
void LexerState::long_comment() {
  const std::size_t end = text_.find("*/", cursor_);
  cursor_ = end == std::string_view::npos ? text_.size() : end + 2;
  report(Code::E0002, "a comment in RSL begins with # or % and ends with its line")
      .label(span(start_, start_ + 2), "rsc ignores this one up to its end")
      .helps("write # at the start of each line");
}

}  // namespace robosync::compiler
