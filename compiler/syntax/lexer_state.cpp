// See lexer_state.hpp.
#include "compiler/syntax/lexer_state.hpp"

#include <algorithm>

#include "compiler/source/ascii.hpp"
#include "compiler/source/utf8.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/lexer.hpp"

namespace robosync::compiler {

namespace {

constexpr char32_t degree_sign = 0xB0;

struct CodePoints {
  char32_t first, last;
};

// Code points above ASCII that are not letters: punctuation, arrows, signs, dingbats and emoji. All others are letters.
constexpr CodePoints not_letters[] = {
    {0x80, 0xA9},     {0xAB, 0xB4},     {0xB6, 0xB9},     {0xBB, 0xBF},       {0xD7, 0xD7},
    {0xF7, 0xF7},     {0x2000, 0x2BFF}, {0x2E00, 0x2E7F}, {0x3000, 0x303F},   {0xE000, 0xF8FF},
    {0xFE00, 0xFE6F}, {0xFEFF, 0xFF20}, {0xFFF0, 0xFFFF}, {0x1F000, 0x1FAFF}, {0xE0000, 0x10FFFF}};

bool is_letter(char32_t point) {
  return std::none_of(std::begin(not_letters), std::end(not_letters), [point](CodePoints range) {
    return range.first <= point && point <= range.last;
  });
}

bool is_high(char c) {
  return (static_cast<unsigned char>(c) & 0x80U) != 0;
}

// The bytes of a number and its unit, up to the first code point above ASCII that is not a letter.
std::size_t number_length(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size()) {
    if (!is_high(text[length])) {
      ++length;
      continue;
    }
    const utf8::CodePoint point = utf8::decode(text, length);
    if (!is_letter(point.value) && point.value != degree_sign) break;
    length += point.size;
  }
  return length;
}

// True when the text after the / of a unit is a name of the second, in any case.
bool is_per_second(std::string_view unit_end) {
  constexpr std::string_view names[] = {"s", "sec", "second"};
  return std::ranges::any_of(
      names, [unit_end](std::string_view name) { return ascii::same(name, unit_end); });
}

}  // namespace

bool is_word_byte(char c) {
  const bool letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  return letter || (c >= '0' && c <= '9') || c == '_';
}

std::size_t word_length(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size()) {
    const utf8::CodePoint point = utf8::decode(text, length);
    if (is_high(text[length]) ? !is_letter(point.value) : !is_word_byte(text[length])) break;
    length += point.size;
  }
  return length;
}

void LexerState::token(TokenKind kind) {
  tokens_.push_back({kind, here()});
}

void LexerState::word() {
  // The pattern takes all ASCII letters. The word can be longer only if it begins with, or is followed by, other letters.
  const bool ascii =
      !is_high(text_[start_]) && (cursor_ == text_.size() || !is_high(text_[cursor_]));
  const std::size_t length = ascii ? cursor_ - start_ : word_length(text_.substr(start_));
  if (length == 0) {
    other();
    return;
  }
  cursor_ = start_ + length;
  const Keyword* keyword = find_keyword(lexeme());
  if (keyword == nullptr && (foreign_end() || negation())) return;
  if (foreign_loop()) return;
  token(keyword != nullptr ? keyword->kind : Kinds::NAME);
  if (keyword != nullptr && keyword->kind == Kinds::IF) join_else_if();
  if (keyword != nullptr && keyword->kind == Kinds::OF) of();
}

// ---- words that later tokens identify; until then they are names

// Is the token `back` places before the last one this name?
bool LexerState::is_name(std::size_t back, std::string_view word) const {
  if (back >= tokens_.size()) return false;
  const Token& token = tokens_[tokens_.size() - 1 - back];
  const std::string_view text = text_.substr(token.span.begin, token.span.end - token.span.begin);
  return token.kind == Kinds::NAME && ascii::same(text, word);
}

// `LIST name :` at the start of a line.
void LexerState::colon() {
  token(Kinds::COLON);
  constexpr std::size_t list = 2;
  if (!is_name(list, "LIST")) return;
  const std::size_t at = tokens_.size() - 1 - list;
  if (at == 0 || tokens_[at - 1].kind == Kinds::NEWLINE) tokens_[at].kind = Kinds::LIST;
}

// Identifies `COUNT OF`, or the nearest ITEM in the line that this OF belongs to. In `ITEM count OF names` the index
// is a variable named count, unless a second OF shows that it was `ITEM COUNT OF …`.
void LexerState::of() {
  const auto at = [this](std::size_t back) -> Token& { return tokens_[tokens_.size() - 1 - back]; };
  constexpr std::size_t farthest = 64;
  const std::size_t end = std::min(farthest, tokens_.size());
  if (end > 2 && at(2).kind == Kinds::CHECK) return;
  if (is_name(1, "COUNT") && !is_name(2, "ITEM")) {
    at(1).kind = Kinds::COUNT;
    return;
  }
  for (std::size_t back = 2; back < end; ++back) {
    if (at(back).kind == Kinds::NEWLINE || at(back).kind == Kinds::CHECK) return;
    if (at(back).kind == Kinds::ITEM && is_name(back - 1, "COUNT")) {
      at(back - 1).kind = Kinds::COUNT;
      return;
    }
    if (!is_name(back, "ITEM")) continue;
    at(back).kind = Kinds::ITEM;
    return;
  }
}

// `ELSE IF` in one line continues the IF before it. After an ELSE that ends its line, an IF is separate
// and has its own END.
void LexerState::join_else_if() {
  if (tokens_.size() < 2 || tokens_[tokens_.size() - 2].kind != Kinds::ELSE) return;
  const std::size_t begin = tokens_[tokens_.size() - 2].span.begin;
  tokens_.resize(tokens_.size() - 2);
  tokens_.push_back({Kinds::ELSE_IF, span(begin, cursor_)});
}

// ---- numbers

// `10cm/x` divides: only `/s` belongs to a unit.
bool LexerState::unit_ends_early() {
  const std::size_t slash = lexeme().find('/');
  if (slash == std::string_view::npos || is_per_second(lexeme().substr(slash + 1))) return false;
  cursor_ = start_ + slash;
  return true;
}

void LexerState::quantity() {
  if (!unit_ends_early() && keyword_is_stuck()) return;
  cursor_ = start_ + number_length(lexeme());
  token(Kinds::QUANTITY);
}

// ---- strings and comments

void LexerState::string() {
  if (apostrophe_in_number() || apostrophe_in_text()) return;
  text_of_python();
  token(Kinds::STRING);
}

std::vector<Token> lex(const SourceFile& source, FileId file, Diagnostics& diagnostics) {
  LexerState state(source.text(), file, diagnostics);
  while (state.step()) {
  }
  return state.take();
}

}  // namespace robosync::compiler
