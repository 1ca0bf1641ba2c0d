// Accepts any tree of the parser. Recursion is bounded by the parser's limit on nested blocks.
#include "compiler/explain/statements.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "compiler/explain/conditions.hpp"
#include "compiler/source/ascii.hpp"

namespace robosync::compiler::explain {
namespace {

constexpr std::size_t kStatementIndent = 4;

bool is_capital(std::string_view word) {
  return std::ranges::none_of(word, [](unsigned char c) { return std::islower(c) != 0; });
}

// SLOWLY is shown as slowly; a name that the author wrote in small letters stays as it is.
std::string softly(std::string_view word) {
  return is_capital(word) ? folded(word) : std::string(word);
}

std::string_view preposition(ast::Preposition preposition) {
  switch (preposition) {
    case ast::Preposition::none:
      return "";
    case ast::Preposition::to:
      return "to ";
    case ast::Preposition::by:
      return "by ";
    case ast::Preposition::over:
      return "over ";
    case ast::Preposition::at:
      return "at ";
    case ast::Preposition::for_:
      return "for ";
    case ast::Preposition::margin:
      return "whenever that changes by ";
  }
  return "";
}

std::string value_of(const ast::Argument& argument) {
  if (const auto* word = std::get_if<ast::Word>(&argument.value)) return softly(word->name.text);
  if (const auto* text = std::get_if<ast::Text>(&argument.value)) {
    return fmt::format("\"{}\"", text->text);
  }
  const auto& amount = std::get<ast::Amount>(argument.value);
  std::string count = amount.value ? number(*amount.value) : std::string();
  if (!amount.times) return count;
  return count == "1" ? "once" : count + " times";
}

// The IF that is the only statement in another IF's ELSE; null if there is none.
const ast::If* other_if(const ast::If& node) {
  return node.else_block.size() == 1 ? std::get_if<ast::If>(&node.else_block.front().node)
                                     : nullptr;
}

class StatementWriter {
public:
  StatementWriter(const Defines& defines, std::size_t indent)
      : defines_(defines), indent_(indent) {}

  void block(const ast::Block& block) {
    for (const ast::Stmt& stmt : block)
      std::visit([this](const auto& node) { write(node); }, stmt.node);
  }
  std::string text;

private:
  void line(std::string_view words) { text += fmt::format("{:{}}- {}\n", "", indent_, words); }

  void nested(const ast::Block& inner) {
    indent_ += kStatementIndent;
    block(inner);
    indent_ -= kStatementIndent;
  }

  void write(const ast::Command& node) {
    if (node.arguments.empty() && defines_.contains(folded(node.verb.text))) {
      line(fmt::format("do {} (see DEFINE {})", node.verb.text, node.verb.text));
    } else if (folded(node.verb.text) == "restart" && node.arguments.size() == 1) {
      line(fmt::format("set {} back to 0", value_of(node.arguments.front())));
    } else {
      line(command(node));
    }
  }

  void write(const ast::Call& node) {
    const auto found = defines_.find(folded(node.name.text));
    std::vector<std::string> given;
    for (std::size_t i = 0; i < node.arguments.size(); ++i) {
      const bool named = found != defines_.end() && i < found->second->parameters.size();
      given.push_back(named ? fmt::format("{} = {}", found->second->parameters[i].text,
                                          value_of(node.arguments[i]))
                            : value_of(node.arguments[i]));
    }
    const std::string see =
        found == defines_.end() ? "" : fmt::format(" (see DEFINE {})", node.name.text);
    line(fmt::format("do {} with {}{}", node.name.text, fmt::join(given, ", "), see));
  }

  void write(const ast::Set& node) {
    line(fmt::format("set {} to {}", node.name.text, number(*node.value)));
  }
  void write(const ast::Raise& node) {
    line(fmt::format("{} {} by {}", node.lower ? "lower" : "raise", node.name.text,
                     number(*node.by)));
  }
  void write(const ast::Wait& node) { line("wait " + number(*node.duration)); }
  void write(const ast::WaitUntil& node) {
    line(fmt::format("wait until {}{}", is_true(*node.condition),
                     node.within ? ", for at most " + number(*node.within) : ""));
  }
  void write(const ast::Then&) { line("wait until everything started so far is done"); }

  void write(const ast::If& node) {
    line(fmt::format("if {}:", is_true(*node.condition)));
    nested(node.then_block);
    const ast::If* last = &node;
    for (; other_if(*last) != nullptr; last = other_if(*last)) {
      line(fmt::format("otherwise, if {}:", is_true(*other_if(*last)->condition)));
      nested(other_if(*last)->then_block);
    }
    if (last->else_block.empty()) return;
    line("otherwise:");
    nested(last->else_block);
  }

  void write(const ast::Repeat& node) {
    if (node.times) {
      line(fmt::format("{} times:", number(*node.times)));
    } else if (node.condition) {
      line(fmt::format("again and again while {}:", is_true(*node.condition)));
    } else {
      line("again and again, until something interrupts it:");
    }
    nested(node.body);
  }

  void write(const ast::PickOne& node) {
    const bool weighted = std::ranges::any_of(
        node.options, [](const ast::Option& option) { return option.weight != nullptr; });
    line(weighted ? "one of these, picked at random, more often the larger its number:"
                  : "one of these, picked at random, all equally likely:");
    indent_ += kStatementIndent;
    for (const ast::Option& option : node.options) {
      line(option.weight ? fmt::format("option {}:", number(*option.weight)) : "option:");
      nested(option.body);
    }
    indent_ -= kStatementIndent;
  }

  void write(const ast::Stop& node) {
    line(node.name ? fmt::format("stop {}", node.name->text) : "stop all actuators");
  }
  void write(const ast::Signal& node) {
    line(fmt::format("send the signal {} to the other rules", node.name.text));
  }
  void write(const ast::Log& node) {
    std::vector<std::string> parts;
    for (const ast::Argument& argument : node.arguments)
      parts.push_back(value_of(argument));
    line(fmt::format("{}: {}", node.alert ? "alert a person" : "write to the log",
                     fmt::join(parts, ", ")));
  }

  const Defines& defines_;
  std::size_t indent_;
};

}  // namespace

std::string folded(std::string_view name) {
  std::string text(name);
  std::ranges::transform(text, text.begin(), ascii::lower);
  return text;
}

Defines defines_of(Trees trees) {
  Defines defines;
  for (const ast::Tree* const tree : trees)
    for (const ast::Item& item : tree->items)
      if (const auto* define = std::get_if<ast::Define>(&item.node))
        defines.emplace(folded(define->name.text), define);
  return defines;
}

std::string command(const ast::Command& command) {
  std::string text = softly(command.verb.text);
  const std::size_t first_part = command.arguments.size() - command.parts;
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const ast::Argument& argument = command.arguments[i];
    text += fmt::format("{} {}{}", i > first_part ? "," : "", preposition(argument.preposition),
                        value_of(argument));
  }
  return text;
}

std::string statements(const ast::Block& block, const Defines& defines, std::size_t indent) {
  StatementWriter writer(defines, indent);
  writer.block(block);
  return std::move(writer.text);
}

}  // namespace robosync::compiler::explain
