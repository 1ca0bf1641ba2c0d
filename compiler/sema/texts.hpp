// Texts composed of parts: `"You have", points, "points"`, in logs and speech.
// Each value gets a {} place in the text, with its unit or its words; the code that shows the text fills it in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/sema/expressions.hpp"

namespace robosync::compiler {

class TextBuilder {
public:
  TextBuilder(Expressions& expressions, Diagnostics& diagnostics)
      : expressions_(expressions), diagnostics_(diagnostics) {}

  // False after a mistake, which has been reported, and in a DEFINE that nothing runs.
  bool add(const ast::Argument& part);
  bool add(std::string_view text, Span span);
  bool add(Typed value);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::vector<Expression>& values() { return values_; }

private:
  void append(std::string_view part);
  bool report_second(Span span);
  bool add_word(Typed word);
  void report_word_shown(const Typed& word);

  Expressions& expressions_;
  Diagnostics& diagnostics_;
  std::string text_;
  std::vector<Expression> values_;
};

// How many words it takes to say such a text; each of its values counts as one.
[[nodiscard]] vm::Value spoken_words(std::string text, std::size_t values);

}  // namespace robosync::compiler
