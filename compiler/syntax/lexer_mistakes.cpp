// Part of the lexer: what it says about text that RSL cannot have, such as curly quotes, or a number that cannot be read. See
// lexer_state.hpp.
#include <algorithm>

#include "compiler/source/ascii.hpp"
#include "compiler/source/character_names.hpp"
#include "compiler/source/utf8.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/lexer.hpp"
#include "compiler/syntax/lexer_state.hpp"

namespace robosync::compiler {

namespace {

constexpr char32_t byte_order_mark = 0xFEFF;
constexpr char32_t no_break_space = 0xA0;

// Signs that word processors write instead of ASCII ones.
struct LookAlike {
  char32_t point;
  TokenKind kind;
  std::string_view ascii;
};
constexpr LookAlike look_alikes[] = {
    {0x2264, Kinds::LESS_EQUAL, "<="}, {0x2265, Kinds::GREATER_EQUAL, ">="},
    {0x2260, Kinds::NOT_EQUAL, "<>"},  {0x2212, Kinds::MINUS, "-"},
    {0x2010, Kinds::MINUS, "-"},       {0x2011, Kinds::MINUS, "-"},
    {0x2013, Kinds::MINUS, "-"},       {0x2014, Kinds::MINUS, "-"},
    {0xD7, Kinds::STAR, "*"},          {0xF7, Kinds::SLASH, "/"},
};

constexpr char32_t curly_quotes[] = {0x2018, 0x2019, 0x201A, 0x201C, 0x201D, 0x201E, 0xAB, 0xBB};

bool is_curly(char32_t point) {
  return std::find(std::begin(curly_quotes), std::end(curly_quotes), point) !=
         std::end(curly_quotes);
}

}  // namespace

// Limits the reports for a file that is not RSL at all.
Diagnostic& LexerState::report(Code code, std::string message) {
  constexpr std::size_t most = 50;
  if (++reports_ <= most) return diagnostics_.report(code, std::move(message));
  unseen_ = {};
  return unseen_;
}

// ---- numbers

// `3TIMES`: the keyword was meant, not a unit.
bool LexerState::keyword_is_stuck() {
  const std::string_view text = lexeme();
  const auto letter = std::find_if(text.begin(), text.end(),
                                   [](char c) { return c != '.' && (c < '0' || c > '9'); });
  const auto digits = static_cast<std::size_t>(letter - text.begin());
  const Keyword* keyword = find_keyword(text.substr(digits));
  if (keyword == nullptr) return false;
  const std::string spelling(text.substr(digits));
  report(Code::E0004, "a space is missing between the number and `" + spelling + "`")
      .label(here())
      .fix(span(start_ + digits, start_ + digits), " ");
  tokens_.push_back({Kinds::QUANTITY, span(start_, start_ + digits)});
  tokens_.push_back({keyword->kind, span(start_ + digits, cursor_)});
  return true;
}

void LexerState::bad_number() {
  if (unit_ends_early()) {
    token(Kinds::QUANTITY);
    return;
  }
  const std::string text(lexeme());
  Diagnostic& message =
      report(Code::E0004, "`" + text + "` cannot be read as a number").label(here());
  if (text.back() == '.') {
    message.helps("a number does not end with a point")
        .fix(here(), text.substr(0, text.size() - 1), Applicability::likely);
  } else {
    message.helps(
        "a number is digits, a decimal point if needed, and a unit: `0.5`, `80cm`, `40%`");
  }
  token(Kinds::QUANTITY);
}

void LexerState::bad_fraction() {
  const std::string better = "0" + std::string(lexeme());
  report(Code::E0004, "a number begins with a digit")
      .label(here(), "write `" + better + "`")
      .fix(here(), better, Applicability::likely);
  token(Kinds::QUANTITY);
}

// ---- strings and comments

// `WHEN touch LEVEL > 3 DO SAY "x END`: the END belongs to the rule that begins in the same line.
void LexerState::leave_end_to_its_block() {
  constexpr std::string_view end = " END";
  const std::string_view text = lexeme();
  std::size_t first = tokens_.size();
  while (first > 0 && tokens_[first - 1].kind != Kinds::NEWLINE)
    --first;
  const bool opens = first < tokens_.size() && (roles_of(tokens_[first].kind) & role::opens) != 0;
  if (opens && text.size() > end.size() && text.ends_with(end)) cursor_ -= end.size();
}

void LexerState::open_string() {
  if (apostrophe_in_number()) return;
  leave_end_to_its_block();
  const std::string quote(lexeme().substr(0, 1));
  report(Code::E0003, "this text is not closed")
      .label(here(), "the line ends without a " + quote)
      .helps("write " + quote + " at the end of the text")
      .fix(span(cursor_, cursor_), quote);
  token(Kinds::STRING);
}

// `40 % loud`: was a unit meant? Two or more blanks before the % show that it is a comment.
void LexerState::comment() {
  if (lexeme().front() != '%' || tokens_.empty()) return;
  const Token& last = tokens_.back();
  if (last.span.end + 1 < start_ || modulo() || last.kind != Kinds::QUANTITY) return;
  const std::string_view number = text_.substr(last.span.begin, last.span.end - last.span.begin);
  const char end = number.empty() ? '\0' : number.back();
  if (end < '0' || end > '9' || percent_of_question()) return;
  report(Code::W0103, "the rest of this line is a comment, not a percentage")
      .label(span(start_, start_ + 1))
      .helps("for the percentage, write `" + std::string(number) + "%` without a space")
      .helps("for a comment, write # instead of %")
      .fix(span(last.span.end, start_ + 1), "%", Applicability::likely);
}

// ---- characters that RSL does not use

void LexerState::instead(TokenKind meant, std::string_view spelling) {
  const std::string better(spelling.substr(0, spelling.find(' ')));
  report(Code::E0002, "RSL does not use `" + std::string(lexeme()) + "`")
      .label(here(), "write `" + better + "`")
      .fix(here(), std::string(spelling));
  token(meant);
}

void LexerState::left_out(std::string_view why) {
  const std::size_t shown = lexeme().front() == '/' ? 2 : lexeme().size();
  report(Code::E0002, "RSL does not use `" + std::string(lexeme().substr(0, shown)) + "`")
      .label(span(start_, start_ + shown), std::string(why));
}

bool LexerState::look_alike(char32_t point) {
  const auto found = std::find_if(std::begin(look_alikes), std::end(look_alikes),
                                  [point](const LookAlike& entry) { return entry.point == point; });
  if (found == std::end(look_alikes)) return false;
  instead(found->kind, found->ascii);
  return true;
}

// Curly quotes from a word processor: a string ends at the next one in the line.
bool LexerState::curly_string(char32_t quote) {
  if (!is_curly(quote)) return false;
  std::size_t end = cursor_;
  while (end < text_.size() && text_[end] != '\n' && text_[end] != '\r') {
    const utf8::CodePoint point = utf8::decode(text_, end);
    end += point.size;
    if (!is_curly(point.value)) continue;
    const std::string inside(text_.substr(cursor_, end - point.size - cursor_));
    cursor_ = end;
    report(Code::E0002, "RSL uses straight quotes, not curly ones")
        .label(here())
        .fix(here(), "\"" + inside + "\"");
    token(Kinds::STRING);
    return true;
  }
  return false;
}

// `touch.LEVEL`, `hello.wav`
bool LexerState::dotted() {
  const bool between = text_[start_] == '.' && !tokens_.empty() &&
                       tokens_.back().kind == Kinds::NAME && tokens_.back().span.end == start_ &&
                       word_length(text_.substr(cursor_)) > 0;
  if (!between) return false;
  constexpr std::string_view sounds[] = {"wav", "mp3", "ogg", "flac"};
  const std::string_view behind = text_.substr(cursor_, word_length(text_.substr(cursor_)));
  if (std::ranges::none_of(sounds,
                           [behind](std::string_view one) { return ascii::same(one, behind); })) {
    report(Code::E0002, "words of RSL are separated by a space, not a point")
        .label(here())
        .helps("write a space, as in `touch LEVEL` or `SAY voice`")
        .fix(here(), " ", Applicability::likely);
    return true;
  }
  start_ = tokens_.back().span.begin;
  cursor_ += behind.size();
  tokens_.pop_back();
  const std::string quoted = "\"" + std::string(lexeme()) + "\"";
  report(Code::E0002, "the name of a file goes in quotes")
      .label(here())
      .fix(here(), quoted, Applicability::likely);
  token(Kinds::STRING);
  return true;
}

// Strange bytes give one message per line: a line with one often has more.
void LexerState::strange(std::size_t size) {
  cursor_ = start_ + size;
  const bool said = strange_end_ <= start_ &&
                    text_.substr(strange_end_, start_ - strange_end_).find_first_of("\r\n") ==
                        std::string_view::npos;
  strange_end_ = cursor_;
  if (said) return;
  Diagnostic& message = report(Code::E0002, std::string(kStrangeCharacter) +
                                                utf8::describe(utf8::decode(text_, start_).value))
                            .label(here());
  if (text_[start_] == '^') message.helps("RSL has no powers: multiply, such as `n * n`");
  if (text_[start_] == '.' &&
      rest_of_line(cursor_).find_first_not_of(" \t") == std::string_view::npos)
    message.helps("a line ends without a full stop");
  if (text_[start_] == '$') message.helps("a name has only letters, digits and `_`");
  if (text_[start_] == '\\')
    message.helps("for quotation marks inside a text, put it in '…': `'say \"hi\" now'`");
  if (text_[start_] == '[' || text_[start_] == ']')
    message.helps(
        "a LIST has no brackets: `LIST words: \"one\", \"two\"`; one item is `ITEM 1 OF words`");
}

void LexerState::other() {
  const utf8::CodePoint point = utf8::decode(text_, start_);
  cursor_ = start_ + point.size;
  const bool blank = point.value == no_break_space || point.value == byte_order_mark;
  if (blank || look_alike(point.value) || curly_string(point.value) || dotted()) return;
  strange(point.size);
}

}  // namespace robosync::compiler
