// LOG and ALERT.
#include "compiler/sema/statements.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kPlace = "{}";  // of a value in a LOG's text
constexpr std::size_t kMaxValues = static_cast<std::size_t>(vm::Param::count_);

// Parts stand apart, unless the text has a space there already.
void separate(std::string& text, std::string_view next) {
  if (!text.empty() && text.back() != ' ' && !next.empty() && next.front() != ' ') text += ' ';
}

}  // namespace

bool Statements::writable(const std::string& text, Span span) {
  if (text.find(kPlace) == std::string::npos && text.find('\0') == std::string::npos) return true;
  diagnostics_.report(Code::E0509, "`{}` cannot stand in a text that is written out").label(span);
  return false;
}

void Statements::add(const ast::Log& node, Span span, ProgramBlock& result) {
  ProgramLog log;
  bool good = true;
  for (const ast::Argument& argument : node.arguments)
    good = add_part(argument, log) && good;
  if (log.values.size() > kMaxValues) {
    diagnostics_.report(Code::E0407, "a LOG has at most " + std::to_string(kMaxValues) + " numbers")
        .label(span);
    return;
  }
  if (good) put(std::move(log), span, result);
}

bool Statements::add_part(const ast::Argument& argument, ProgramLog& log) {
  const auto* text = std::get_if<ast::Text>(&argument.value);
  std::string written;
  if (text != nullptr) {
    written = text->text;
  } else if (const auto* amount = std::get_if<ast::Amount>(&argument.value)) {
    if (amount->value == nullptr) return false;
    const auto* operand = std::get_if<ast::Operand>(&amount->value->node);
    const Binding* binding = operand != nullptr && !operand->channel
                                 ? expressions_.find_binding(operand->name.text)
                                 : nullptr;
    if (binding != nullptr && binding->text) {
      written = *binding->text;
    } else {
      Typed value = expressions_.number(*amount->value);
      if (!value.is_number()) return false;
      separate(log.text, kPlace);
      log.text += std::string(kPlace) + std::string(canonical_unit(value.dimension()).spelling);
      log.values.push_back(std::move(value.code));
      return true;
    }
  }
  if (!writable(written, argument.span)) return false;
  separate(log.text, written);
  log.text += written;
  return true;
}

void Statements::add(const ast::Alert& node, Span span, ProgramBlock& result) {
  if (writable(node.text, span)) put(ProgramAlert{node.text}, span, result);
}

}  // namespace robosync::compiler
