// Conditions on words and truths: IS, IS TRUE, BECOMES.
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/expressions.hpp"

namespace robosync::compiler {

vm::Value label_value(std::size_t place) {
  return static_cast<vm::Value>(place) * vm::kScale;
}

std::optional<std::size_t> find_label(Names& names, const std::vector<std::string>& labels,
                                      const ast::Name& label, std::string_view owner,
                                      Diagnostics& diagnostics, bool quoted) {
  if (const auto place = names.find_label(labels, label.text)) return place;
  if (label.text.empty()) return std::nullopt;  // it was missing, which has been reported
  Diagnostic& d =
      diagnostics.report(Code::E0501, "`" + std::string(owner) + "` is never `" + label.text + "`")
          .label(label.span);
  if (!diagnostics.may_search(labels.size())) return std::nullopt;
  if (const auto near = nearest(label.text, labels))
    d.helps("did you mean `" + *near + "`?").fix(label.span, quoted ? "\"" + *near + "\"" : *near);
  else
    d.helps("it is " + list_names(labels, "or"));
  return std::nullopt;
}

Diagnostic& report_word(const Typed& word, std::string_view wanted, Diagnostics& diagnostics) {
  return diagnostics
      .report(Code::E0306, "`" + word.source + "` is a word, not " + std::string(wanted))
      .label(word.span)
      .helps("ask for it with IS: `" + word.source + " IS " + word.labels->front() + "`");
}

// `mood = calm`
void Expressions::report_word_comparison(const ast::Comparison& node, const Typed& word) {
  Diagnostic& d = report_word(word, "a number", diagnostics_);
  if (node.relation == ast::Relation::equal) d.fix(node.relation_span, "IS");
  if (node.relation == ast::Relation::not_equal) d.fix(node.relation_span, "IS NOT");
}

Typed Expressions::label_test(Operation operation, const ast::Expr& value, const ast::Name& label,
                              Span span, bool quoted) {
  Typed word = any(value);
  if (word.type == Type::nothing) return word;
  if (word.type != Type::word) {
    Diagnostic& d =
        diagnostics_
            .report(Code::E0306, word.is_number()
                                     ? "this is a number, and `" + label.text + "` is a word"
                                     : "this is a condition, and `" + label.text + "` is a word")
            .label(value.span)
            .label(label.span, "the word", false);
    if (word.code.operation == Operation::input)
      d.helps("if the sensor gives words, list them under \"labels\" in robot.json");
    else if (word.is_number())
      d.helps("compare a number with `=`, `<` or `>`");
    return make_nothing(span);
  }
  const auto place = find_label(names_, *word.labels, label, word.source, diagnostics_, quoted);
  if (!place) return make_nothing(span);
  return make_condition(
      make_binary(operation, std::move(word.code), make_constant_code(label_value(*place))), span);
}

Typed Expressions::of(const ast::Is& node, Span span) {
  return label_test(node.negated ? Operation::not_equal : Operation::equal, *node.value, node.label,
                    span, node.is_string);
}

Typed Expressions::of(const ast::Becomes& node, Span span) {
  Typed test = label_test(Operation::equal, *node.value, node.label, span);
  if (test.type != Type::condition) return test;
  return make_condition(make_unary(Operation::rose, std::move(test.code)), span);
}

Typed Expressions::of(const ast::IsTruth& node, Span span) {
  Typed truth = condition(*node.value);
  if (truth.type != Type::condition) return make_nothing(span);
  if (node.truth) return make_condition(std::move(truth.code), span);
  return make_condition(make_unary(Operation::logical_not, std::move(truth.code)), span);
}

}  // namespace robosync::compiler
