// See sexpr.hpp. One overload of `show` for each node.
#include "tests/compiler/syntax/sexpr.hpp"

#include <initializer_list>

namespace robosync::compiler::testing {

namespace {

using namespace ast;

std::string list(std::initializer_list<std::string> parts) {
  std::string text = "(";
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (text.size() > 1) text += ' ';
    text += part;
  }
  return text + ")";
}

std::string in_quotes(std::string_view text) {
  return "\"" + std::string(text) + "\"";
}

std::string show(const Box<Expr>& expr);

// "(key value)", or nothing without a value.
std::string optional(const char* key, const Box<Expr>& value) {
  return value ? list({key, show(value)}) : "";
}

std::string show(const Name& name) {
  const std::string text(name.text);
  const bool words = text.find(' ') != std::string::npos;
  return words ? "[" + text + "]" : text;
}

std::string show(const std::vector<Name>& names) {
  std::string text;
  for (const Name& name : names)
    text += (text.empty() ? "" : " ") + show(name);
  return "(" + text + ")";
}

// ---- expressions

std::string show(const Quantity& n) {
  return std::string(n.digits) + std::string(n.unit);
}
std::string show(const Operand& n) {
  const std::string name(n.name.text);
  return n.channel ? name + "." + std::string(n.channel->text) : name;
}
std::string show(const Negate& n) {
  return list({"neg", show(n.value)});
}
std::string show(const Arithmetic& n) {
  const char* const signs[] = {"+", "-", "*", "/", "mod"};
  return list({signs[static_cast<int>(n.op)], show(n.left), show(n.right)});
}
std::string show(const Random& n) {
  return list({"random", show(n.low), show(n.high)});
}
std::string show(const Function& n) {
  return list({"function", show(n.name), show(n.first), n.second ? show(n.second) : ""});
}
std::string show(const ItemOf& n) {
  return list({"item", show(n.index), show(n.list)});
}
std::string show(const CountOf& n) {
  return list({"count", show(n.list)});
}
std::string show(const Comparison& n) {
  const char* const signs[] = {"<", ">", "<=", ">=", "=", "<>"};
  return list({signs[static_cast<int>(n.relation)], show(n.left), show(n.right)});
}
std::string show(const Is& n) {
  const std::string label = n.is_string ? in_quotes(n.label.text) : show(n.label);
  return list({n.negated ? "is-not" : "is", show(n.value), label});
}
std::string show(const IsBetween& n) {
  return list({"between", show(n.value), show(n.low), show(n.high)});
}
std::string show(const IsTruth& n) {
  return list({n.truth ? "true" : "false", n.value ? show(n.value) : ""});
}
std::string show(const Becomes& n) {
  return list({"becomes", show(n.value), show(n.label)});
}
std::string show(const Changes& n) {
  return list({"changes", show(n.value), n.by ? show(n.by) : ""});
}
std::string show(const Not& n) {
  return list({"not", show(n.value)});
}
std::string show(const Logic& n) {
  return list({n.op == LogicOp::and_ ? "and" : "or", show(n.left), show(n.right)});
}
std::string show(const For& n) {
  return list({"for", show(n.condition), show(n.duration)});
}
std::string show(const ThenWithin& n) {
  return list({"then", show(n.first), show(n.second), show(n.within)});
}
std::string show(const TimesWithin& n) {
  return list({"times", show(n.condition), std::to_string(n.times), show(n.within)});
}
std::string show(const Box<Expr>& expr) {
  if (!expr) return "-";
  return std::visit([](const auto& node) { return show(node); }, expr->node);
}

// ---- statements

std::string show(const Stmt& stmt);

std::string show(const char* key, const Block& block) {
  std::string text = std::string("(") + key;
  for (const Stmt& stmt : block)
    text += " " + show(stmt);
  return text + ")";
}

std::string show(const Argument& argument) {
  const char* const prepositions[] = {"", "to:", "by:", "over:", "at:", "for:", "margin:"};
  std::string value;
  if (const auto* word = std::get_if<Word>(&argument.value)) value = show(word->name);
  if (const auto* text = std::get_if<Text>(&argument.value)) value = in_quotes(text->text);
  if (const auto* amount = std::get_if<Amount>(&argument.value)) {
    value = amount->times ? list({"times", show(amount->value)}) : show(amount->value);
  }
  return prepositions[static_cast<int>(argument.preposition)] + value;
}

std::string show(const std::vector<Argument>& arguments) {
  std::string text;
  for (const Argument& argument : arguments)
    text += (text.empty() ? "" : " ") + show(argument);
  return text;
}

std::string show(const Command& n) {
  return list(
      {show(n.verb), show(n.arguments), n.parts > 0 ? "text-of " + std::to_string(n.parts) : ""});
}
std::string show(const Call& n) {
  return list({"call", show(n.name), show(n.arguments)});
}
std::string show(const Set& n) {
  return list({"set", show(n.name), show(n.value)});
}
std::string show(const Raise& n) {
  return list({n.lower ? "lower" : "raise", show(n.name), show(n.by)});
}
std::string show(const Wait& n) {
  return list({"wait", show(n.duration)});
}
std::string show(const WaitUntil& n) {
  return list({"wait-until", show(n.condition), optional("within", n.within)});
}
std::string show(const Then&) {
  return "(then)";
}
std::string show(const If& n) {
  return list({"if", show(n.condition), show("do", n.then_block),
               n.else_block.empty() ? "" : show("else", n.else_block)});
}
std::string show(const Repeat& n) {
  std::string how = "forever";
  if (n.times) how = list({"times", show(n.times)});
  if (n.condition) how = list({"while", show(n.condition)});
  return list({"repeat", how, show("do", n.body)});
}
std::string show(const PickOne& n) {
  std::string options;
  for (const Option& option : n.options) {
    const std::string weight = option.weight ? show(option.weight) : "";
    options += (options.empty() ? "" : " ") + list({"option", weight, show("do", option.body)});
  }
  return list({"pick-one", options});
}
std::string show(const Stop& n) {
  return list({"stop", n.name ? show(*n.name) : "all"});
}
std::string show(const Signal& n) {
  return list({"signal", show(n.name)});
}
std::string show(const Log& n) {
  return list({n.alert ? "alert" : "log", show(n.arguments)});
}
std::string show(const Stmt& stmt) {
  return std::visit([](const auto& node) { return show(node); }, stmt.node);
}

// ---- items

std::string show(const Modifiers& n) {
  std::string text;
  const auto add = [&text](const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "" : " ") + part;
  };
  if (n.priority) add(list({"priority", show(*n.priority)}));
  add(optional("cooldown", n.cooldown));
  add(optional("margin", n.margin));
  add(optional("waiting", n.waiting));
  if (n.restarting) add("(restarting)");
  return text;
}

std::string show(const Rule& n) {
  const std::string modifiers = show(n.modifiers);
  if (const auto* rule = std::get_if<WhenRule>(&n.node)) {
    return list({"when", show(rule->condition), modifiers, show("do", rule->then_block),
                 rule->else_block ? show("else", *rule->else_block) : ""});
  }
  if (const auto* rule = std::get_if<WhileRule>(&n.node)) {
    return list({"while", show(rule->condition), modifiers, show("do", rule->body)});
  }
  if (const auto* rule = std::get_if<EveryRule>(&n.node)) {
    return list(
        {"every", show(rule->period), optional("to", rule->to), modifiers, show("do", rule->body)});
  }
  return list({"at-start", show("do", std::get<AtStartRule>(n.node).body)});
}

std::string show(const Use& n) {
  return list({"use", n.is_string ? in_quotes(n.module.text) : show(n.module)});
}
std::string show(const Let& n) {
  return list({"let", show(n.name), show(n.value)});
}
std::string show(const Remember& n) {
  if (n.kept) return list({"remember", show(n.name), show(n.value), "kept"});
  return list({"remember", show(n.name), show(n.value)});
}
std::string show(const State& n) {
  return list({"state", show(n.name), show(n.labels)});
}
std::string show(const List& n) {
  return list({"list", show(n.name), show(n.items)});
}
std::string show(const Feeling& n) {
  const std::string fades = n.fades_to ? list({"fades", show(n.fades_to), show(n.fades_over)}) : "";
  return list({"feeling", show(n.name), show(n.from), show(n.to), show(n.start), fades});
}
std::string show(const Limit& n) {
  return list({"limit", show(n.actuator), show(n.channel), show(n.value)});
}
std::string show(const Band& n) {
  const char* const kinds[] = {"below", "above", "between", "otherwise"};
  return list({kinds[static_cast<int>(n.kind)], show(n.label), n.low ? show(n.low) : "",
               n.high ? show(n.high) : ""});
}
std::string show(const Check& n) {
  std::string bands;
  for (const Band& band : n.bands)
    bands += (bands.empty() ? "" : " ") + show(band);
  return list({"check", show(n.name), show(n.operand), bands, optional("margin", n.margin),
               optional("smooth", n.smooth)});
}
std::string show(const Define& n) {
  return list({"define", show(n.name), show(n.parameters), show("do", n.body)});
}
std::string show(const Timer& n) {
  return list({"timer", std::string(n.name.text)});
}
std::string show(const Motion& n) {
  std::string rows;
  for (const MotionRow& row : n.rows) {
    rows += " (" + show(row.time);
    for (const MotionKey& key : row.keys)
      rows += " " + show(key.value);
    rows += ")";
  }
  return "(motion " + show(n.name) + " " + show(n.columns) + rows + ")";
}
std::string show(const Behavior& n) {
  std::string parts;
  for (const Remember& variable : n.variables)
    parts += " " + show(variable);
  for (const Rule& rule : n.rules)
    parts += " " + show(rule);
  return "(behavior " + show(n.name) + " " + (n.priority ? show(*n.priority) : "-") + parts + ")";
}
std::string show(const Safety& n) {
  return list({"safety", show(n.name), show(n.condition), show(n.modifiers), show("do", n.body),
               optional("resume", n.resume)});
}

std::string show(const TestFeed& n) {
  return list(
      {"feed", show(n.at), show(n.target), n.text ? in_quotes(n.text->text) : show(n.value)});
}
std::string show(const ExpectCommand& n) {
  return list({n.no ? "expect-no" : "expect", n.times ? show(*n.times) : "", show(n.command),
               n.within ? show(n.within) : ""});
}
std::string show(const ExpectText& n) {
  return list({n.no ? "expect-no" : "expect", n.alert ? "alert" : "log", in_quotes(n.text),
               optional("within", n.within)});
}
std::string show(const Seed& n) {
  return list({"seed", show(n.number)});
}
std::string show(const ExpectNothing& n) {
  return list({"expect-nothing", show(n.duration)});
}
std::string show(const ExpectThat& n) {
  return list({"expect-that", show(n.condition), optional("within", n.within)});
}
std::string show(const Test& n) {
  std::string steps;
  for (const TestStep& step : n.steps) {
    steps += " " + std::visit([](const auto& node) { return show(node); }, step.node);
  }
  return "(test " + in_quotes(n.title) + steps + ")";
}

}  // namespace

std::string to_sexpr(const Tree& program) {
  std::string text;
  for (const Item& item : program.items) {
    text += std::visit([](const auto& node) { return show(node); }, item.node) + "\n";
  }
  return text;
}

}  // namespace robosync::compiler::testing
