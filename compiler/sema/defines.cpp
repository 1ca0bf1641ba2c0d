// Part of Statements: expands DEFINEs where they are used. A text, an actuator, another DEFINE or a
// constant replaces its parameter; any other number is evaluated once, into a local.
#include <algorithm>
#include <utility>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/statements.hpp"
#include "compiler/syntax/walk.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMaxNestedDefines = 64;  // the translation recurses

constexpr unsigned kMaxHandedOn = 4;

std::size_t parts_of(const Expression& expression) {
  std::size_t count = 1;
  for (const Expression& operand : expression.operands)
    count += parts_of(operand);
  return count;
}

// The first argument that is a single word: the actuator's place.
const ast::Word* first_word(const ast::Command& command) {
  for (const ast::Argument& argument : command.arguments)
    if (argument.preposition == ast::Preposition::none)
      if (const auto* word = std::get_if<ast::Word>(&argument.value)) return word;
  return nullptr;
}

// The index of the first argument that is a name for which `is_it` holds; the number of arguments when there is none.
template <typename IsIt>
std::size_t place_of(const ast::Call& call, const IsIt& is_it) {
  const auto found = std::ranges::find_if(call.arguments, [&](const ast::Argument& argument) {
    const auto* amount = std::get_if<ast::Amount>(&argument.value);
    if (amount == nullptr || amount->value == nullptr) return false;
    const auto* operand = std::get_if<ast::Operand>(&amount->value->node);
    return operand != nullptr && !operand->channel && is_it(operand->name);
  });
  return static_cast<std::size_t>(found - call.arguments.begin());
}

std::string counted(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " value" : " values");
}

std::vector<std::string> texts_of(const std::vector<ast::Name>& names) {
  std::vector<std::string> result;
  result.reserve(names.size());
  for (const ast::Name& name : names)
    result.emplace_back(name.text);
  return result;
}

}  // namespace

void Statements::check_unused_defines() {
  all_ = 0;
  for (const auto& [folded, define] : names_.defines()) {
    DefineName& name = *names_.find_define(folded);
    if (name.expanded || name.in_module) continue;
    const bool used = name.used;
    Bindings unknown;
    for (const ast::Name& parameter : name.define->parameters)
      unknown.push_back({fold_name(parameter.text), {}, std::nullopt, parameter.span});
    begin_response();
    ir::Block unused;
    if (may_run(name, name.span)) expand(name, unknown, unused);
    name.used = used;
  }
}

void Statements::add(const ast::Call& node, Span span, ir::Block& result) {
  if (node.name.text.empty()) return;
  if (const Binding* binding = expressions_.find_binding(node.name.text))
    return run(*binding, node.name, node.arguments, span, result);
  if (DefineName* define = names_.find_define(node.name.text))
    return run(*define, node.arguments, span, result);
  Diagnostic& d = diagnostics_.report(Code::E0501, "there is no DEFINE " + node.name.shown())
                      .label(node.name.span);
  d.unknown = node.name.text;
  if (names_.find_motion(node.name.text) != nullptr) {
    const std::string better = std::string(kPerform) + " " + std::string(node.name.text);
    d.helps(node.name.shown() + " is a MOTION: write `" + better + "`, or `" + better +
            " 2 TIMES`");
    return;
  }
  if (diagnostics_.may_search(names_.defines().size()))
    did_you_mean(d, node.name.span, node.name.text, names_.define_names());
  if (d.help.empty() && names_.is_verb(node.name.text))
    d.helps(node.name.shown() + " is a verb: write its values after it, without WITH");
}

// Runs the DEFINE that was passed for a parameter.
void Statements::run(const Binding& binding, const ast::Name& name,
                     const std::vector<ast::Argument>& arguments, Span span, ir::Block& result) {
  if (binding.define != nullptr) return run(*binding.define, arguments, span, result);
  if (!is_open(binding)) expressions_.report_given(binding, name, "a DEFINE");
}

void Statements::run(DefineName& name, const std::vector<ast::Argument>& arguments, Span span,
                     ir::Block& result) {
  name.used = true;
  if (!may_run(name, span)) return;
  const auto bindings = bind(name, arguments, span, result);
  if (!bindings) return;
  const std::size_t reported = diagnostics_.all().size();
  expand(name, *bindings, result);
  if (name.in_module)
    diagnostics_.found_from(span, name.define->name.shown() + " needs it", reported);
}

bool Statements::may_run(const DefineName& name, Span use) {
  if (std::find(open_.begin(), open_.end(), name.define) != open_.end()) {
    report_cycle(name, use);
    return false;
  }
  if (open_.size() < kMaxNestedDefines) return true;
  diagnostics_
      .report(Code::E0407, "DEFINEs use each other more than " + std::to_string(kMaxNestedDefines) +
                               " levels deep, the most that rsc allows")
      .label(use);
  return false;
}

std::optional<Bindings> Statements::bind(const DefineName& name,
                                         const std::vector<ast::Argument>& arguments, Span span,
                                         ir::Block& result) {
  const auto& parameters = name.define->parameters;
  if (parameters.size() != arguments.size()) {
    Diagnostic& d = diagnostics_.report(
        Code::E0411, name.define->name.shown() + " takes " + counted(parameters.size()) +
                         ", but is given " + std::to_string(arguments.size()));
    d.label(span).label(name.span, "defined here", false);
    if (!parameters.empty())
      d.helps("write `" + std::string(name.define->name.text) + " WITH` and a value for " +
              list_names(texts_of(parameters)));
    return std::nullopt;
  }
  Bindings bindings;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    bindings.push_back(bind(*name.define, i, arguments[i], span, result));
  return bindings;
}

Binding Statements::bind(const ast::Define& define, std::size_t parameter,
                         const ast::Argument& argument, Span span, ir::Block& result) {
  Binding binding{fold_name(define.parameters[parameter].text), {}, std::nullopt, argument.span};
  if (const auto* text = std::get_if<ast::Text>(&argument.value)) {
    binding.text = text->text;
    binding.is_number = false;
    return binding;
  }
  const auto* amount = std::get_if<ast::Amount>(&argument.value);
  if (amount == nullptr || amount->value == nullptr) return binding;
  if (const auto* operand = std::get_if<ast::Operand>(&amount->value->node)) {
    const Binding* outer =
        operand->channel ? nullptr : expressions_.find_binding(operand->name.text);
    if (outer != nullptr) {  // passed on unchanged
      const std::string name = std::exchange(binding.name, {});
      binding = *outer;
      binding.name = name;
      return binding;
    }
    if (!operand->channel && bind_name(operand->name.text, define, binding)) return binding;
  }
  if (const auto choice = choice_in(*amount->value)) {
    binding.chosen = chosen_item(*choice, span, result);
    binding.is_number = !binding.chosen;  // after a mistake it could be anything
    if (binding.chosen && binding.chosen->index.operation == Operation::variable)
      binding.chosen->index = in_local(std::move(binding.chosen->index), span, result);
    return binding;
  }
  binding.followed = followed(*amount->value);
  binding.value = expressions_.number(*amount->value);
  if (!binding.value.is_number() || binding.value.is_constant()) return binding;
  binding.value.code = in_local(std::move(binding.value.code), span, result);
  return binding;
}

// Evaluates the value here, once, into a local.
Expression Statements::in_local(Expression value, Span span, ir::Block& result) {
  const std::size_t number = locals_++;
  put_first(ir::Local{number, std::move(value)}, span, result);
  return make_local(number);
}

// The value for a FOLLOW. DEFINEs that pass it on could double it each time, so its size is limited.
Typed Statements::followed(const ast::Expr& value) {
  const bool before = expressions_.set_following(true);
  Typed number = expressions_.number(value);
  const bool lost = expressions_.has_lost();
  expressions_.set_following(before);
  if (lost || parts_of(number.code) > kMostFollowed) return {};
  return number;
}

// Binds an actuator, a group or a DEFINE. If a sensor has the same name, the use of the parameter in
// the DEFINE decides which is meant.
bool Statements::bind_name(std::string_view name, const ast::Define& define, Binding& binding) {
  const auto target = names_.find_target(name);
  if (DefineName* given = names_.find_define(name)) {
    given->used = true;
    binding.define = given;
  } else if (target && (names_.kind_of(name) == "an actuator" ||
                        commands_parameter(define, binding.name, kMaxHandedOn))) {
    binding.actuator = target->name;
  } else {
    return false;
  }
  binding.is_number = false;
  return true;
}

// Is the parameter used as an actuator in a command of the DEFINE, or of one that it is passed on to?
bool Statements::commands_parameter(const ast::Define& define, std::string_view folded,
                                    unsigned handed_on) {
  bool found = false;
  const auto is_it = [folded](const ast::Name& name) { return fold_name(name.text) == folded; };
  ast::for_each_statement(define.body, [&](const ast::Stmt& stmt) {
    if (const auto* command = std::get_if<ast::Command>(&stmt.node)) {
      const ast::Word* word = first_word(*command);
      found = found || (word != nullptr && is_it(word->name));
    } else if (const auto* stop = std::get_if<ast::Stop>(&stmt.node)) {
      found = found || (stop->name && is_it(*stop->name));
    } else if (const auto* call = std::get_if<ast::Call>(&stmt.node); call != nullptr) {
      const DefineName* other = handed_on == 0 ? nullptr : names_.find_define(call->name.text);
      const std::size_t place = other == nullptr ? call->arguments.size() : place_of(*call, is_it);
      if (place < call->arguments.size() && place < other->define->parameters.size())
        found = found ||
                commands_parameter(*other->define, fold_name(other->define->parameters[place].text),
                                   handed_on - 1);
    }
  });
  return found;
}

// Expands in a separate scope: the body sees its parameters and the global names.
void Statements::expand(DefineName& name, const Bindings& bindings, ir::Block& result) {
  name.expanded = true;
  const Bindings* outer = expressions_.set_bindings(&bindings);
  const ast::Behavior* scope = names_.set_scope(nullptr);
  open_.push_back(name.define);
  for (const ast::Stmt& stmt : name.define->body)
    add(stmt, result);
  open_.pop_back();
  names_.set_scope(scope);
  expressions_.set_bindings(outer);
}

void Statements::report_cycle(const DefineName& name, Span use) {
  std::string chain;
  for (auto at = std::find(open_.begin(), open_.end(), name.define); at != open_.end(); ++at)
    chain.append((*at)->name.text).append(" → ");
  chain += name.define->name.text;
  diagnostics_.report(Code::E0402, name.define->name.shown() + " runs itself: " + chain)
      .label(use)
      .label(name.span, "defined here", false);
}

}  // namespace robosync::compiler
