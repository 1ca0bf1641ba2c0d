#include "compiler/sema/texts.hpp"

#include <algorithm>

#include "compiler/units/units.hpp"

namespace robosync::compiler {

// Puts a space between words unless there is one already; none before punctuation.
void TextBuilder::append(std::string_view part) {
  constexpr std::string_view kClose = " .,;:!?)";
  const bool first = text_.empty() || text_.back() == ' ' || text_.back() == '(';
  if (!first && !part.empty() && kClose.find(part.front()) == std::string_view::npos) text_ += ' ';
  text_ += part;
}

bool TextBuilder::add(std::string_view text, Span span) {
  const auto place = find_place(text);
  if (place || text.find('\0') != std::string::npos) {
    const std::string what(place ? text.substr(place->begin, place->size) : "{}");
    diagnostics_.report(Code::E0509, "`" + what + "` cannot be part of this text").label(span);
    return false;
  }
  append(text);
  return true;
}

bool TextBuilder::add(const ast::Argument& part) {
  if (const auto* text = std::get_if<ast::Text>(&part.value)) return add(text->text, part.span);
  Typed value;
  if (const auto* amount = std::get_if<ast::Amount>(&part.value)) {
    if (amount->value == nullptr) return false;
    const auto* operand = std::get_if<ast::Operand>(&amount->value->node);
    const Binding* binding = operand != nullptr && !operand->channel
                                 ? expressions_.find_binding(operand->name.text)
                                 : nullptr;
    const bool second = operand != nullptr && operand->channel &&
                        expressions_.chooses_text(operand->name.text, operand->channel->text);
    if (second || (binding != nullptr && binding->chosen)) return report_second(part.span);
    if (binding != nullptr && binding->text) return add(*binding->text, part.span);
    value = expressions_.any(*amount->value);
  } else if (const auto* word = std::get_if<ast::Word>(&part.value)) {
    const Binding* binding = expressions_.find_binding(word->name.text);
    if (binding != nullptr && binding->chosen) return report_second(part.span);
    if (binding != nullptr && binding->text) return add(*binding->text, part.span);
    value = expressions_.operand({word->name, nullptr}, word->name.span);
  }
  return add(std::move(value));
}

bool TextBuilder::add(Typed value) {
  if (value.type == Type::word) return add_word(std::move(value));
  value = expressions_.number_of(std::move(value));
  if (!value.is_number()) return false;
  append(place_for(value.unit != nullptr ? *value.unit : canonical_unit(vm::Dimension::number)));
  values_.push_back(std::move(value.code));
  return true;
}

// The labels of a channel that learns its words are not complete yet.
bool TextBuilder::add_word(Typed word) {
  const std::string place = place_for(*word.labels);
  if (place.empty() || expressions_.learns_words(word)) {
    report_word_shown(word);
    return false;
  }
  append(place);
  values_.push_back(std::move(word.code));
  return true;
}

void TextBuilder::report_word_shown(const Typed& word) {
  Diagnostic& d =
      diagnostics_.report(Code::E0306, "a text cannot show which word `" + word.source + "` is")
          .label(word.span);
  const auto shown = std::ranges::find_if(*word.labels, [](const std::string& label) {
    return label.find_first_not_of(' ') != label.npos;
  });
  if (shown != word.labels->end())
    d.helps("write an IF with a text for each word: `IF " + word.source + " IS " + *shown + "`");
}

// Statements has already replaced the first one.
bool TextBuilder::report_second(Span span) {
  diagnostics_.report(Code::E0505, "a statement can use only one text from a LIST")
      .label(span, "this is a second one")
      .helps("write a statement for each");
  return false;
}

vm::Value spoken_words(std::string text, std::size_t values) {
  for (; values > 0; --values)
    if (const auto place = find_place(text)) text.replace(place->begin, place->size, "0");
  constexpr std::size_t kMost = 1000;
  constexpr std::string_view kBlanks = " \t\n\v\f\r";
  std::size_t words = 0;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string::npos && words < kMost;
       ++words)
    at = text.find_first_not_of(kBlanks, text.find_first_of(kBlanks, at));
  return static_cast<vm::Value>(words);
}

}  // namespace robosync::compiler
