// The state of the lexer between two tokens, and how it handles each kind of text. The patterns
// are in grammar/rsl.re.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// True for an ASCII byte of a word.
[[nodiscard]] bool is_word_byte(char c);
// The bytes of the word at the start of the text.
[[nodiscard]] std::size_t word_length(std::string_view text);

class LexerState {
public:
  LexerState(std::string_view text, FileId file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {
    constexpr std::size_t least = 3;  // bytes per token in usual text, with the blanks after it
    tokens_.reserve(text.size() / least);
  }

  // Reads one token, blank or comment; false at the end. In grammar/rsl.re.
  bool step();
  // At the end.
  std::vector<Token> take() {
    report_semicolons();
    return std::move(tokens_);
  }

private:
  // Each handles the bytes from start_ to cursor_, and may move cursor_ back.
  void token(TokenKind kind);
  void word();
  void join_else_if();
  void colon();
  void of();
  bool is_name(std::size_t back, std::string_view word) const;
  void quantity();
  void bad_number();
  void bad_fraction();
  void string();
  void open_string();
  void comment();
  void instead(TokenKind meant, std::string_view spelling);
  void left_out(std::string_view why);
  std::string_view line_before_brace() const;
  void assignment();
  void semicolon() { semicolons_.push_back(here()); }
  void report_semicolons();
  void opening_brace();
  void closing_brace();
  void foreign_comment();
  void long_comment();
  void other();

  Diagnostic& report(Code code, std::string message);
  bool unit_ends_early();
  bool keyword_is_stuck();
  bool curly_string(char32_t quote);
  bool look_alike(char32_t point);
  bool compares(std::size_t from) const;
  bool negation();
  bool apostrophe_in_number();
  bool apostrophe_in_text();
  void text_of_python();
  bool modulo();
  bool percent_of_question();
  void whole_division();
  std::string_view rest_of_line(std::size_t from) const;
  std::size_t first_of_statement() const;
  bool behind_value() const;
  bool is_declared(std::string_view name) const;
  bool is_calculation(std::string_view text) const;
  bool brackets_open() const;
  bool has_relation() const;
  std::string_view next_line() const;
  bool next_line_has_sign() const;
  bool next_line_goes_on() const;
  bool foreign_end();
  bool foreign_loop();
  // For an open brace: what its closing brace stands for.
  enum class Brace : std::uint8_t { nothing, for_do, behind_do };
  Brace brace_opens_a_block();
  bool end_follows() const;
  bool word_follows(std::initializer_list<std::string_view> words) const;
  bool brace_is_end();
  bool dotted();
  void leave_end_to_its_block();
  void strange(std::size_t size);

  std::string_view lexeme() const { return text_.substr(start_, cursor_ - start_); }
  Span span(std::size_t begin, std::size_t end) const {
    return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }
  Span here() const { return span(start_, cursor_); }

  std::string_view text_;  // followed by a NUL that is not part of it
  FileId file_;
  Diagnostics& diagnostics_;
  Diagnostic unseen_;  // takes the reports beyond the limit
  std::size_t reports_ = 0;
  std::vector<Token> tokens_;
  std::size_t start_ = 0;
  std::size_t cursor_ = 0;
  bool has_brace_ = false;                                  // reported once
  std::vector<Span> semicolons_;                            // reported together, at the end
  std::vector<Brace> braces_;                               // the open ones
  std::size_t strange_end_ = static_cast<std::size_t>(-1);  // where the last strange bytes ended
};

}  // namespace robosync::compiler
