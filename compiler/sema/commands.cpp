// Which actuators a command is for, and its arguments' values.
#include "compiler/sema/commands.hpp"

#include <algorithm>
#include <array>

#include "compiler/syntax/keywords.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kNotNamed = static_cast<std::size_t>(-1);

const ast::Word* plain_word(const ast::Argument& argument) {
  return argument.preposition == ast::Preposition::none ? std::get_if<ast::Word>(&argument.value)
                                                        : nullptr;
}

vm::Param param_of(const ast::Argument& argument) {
  constexpr std::array kParams = {vm::Param::by,   vm::Param::to, vm::Param::by,
                                  vm::Param::over, vm::Param::at, vm::Param::for_};
  const auto* amount = std::get_if<ast::Amount>(&argument.value);
  if (amount != nullptr && amount->times) return vm::Param::times;
  return kParams[static_cast<std::size_t>(argument.preposition)];
}

// Do two actuators understand the command alike?
bool same(const ProgramCommand& a, const ProgramCommand& b) {
  return a.verb == b.verb && a.word == b.word && a.arguments == b.arguments;
}

}  // namespace

std::vector<ProgramCommand> Commands::translate(const ast::Command& command) {
  if (command.verb.text.empty()) return {};
  if (!names_.is_verb(command.verb.text)) {
    report_unknown_verb(command);
    return {};
  }
  std::size_t named_by = kNotNamed;
  const auto target = find_target(command, named_by);
  const auto given = evaluate(command, named_by);
  if (!target || !given || target->actuators.empty()) return {};
  std::vector<ProgramCommand> each;
  for (const std::size_t actuator : target->actuators) {
    // What is wrong or worth a note for one member need not be said for the others.
    Diagnostics repeated;
    Diagnostics& here = each.empty() ? diagnostics_ : repeated;
    auto result = for_actuator(actuator, command, *given, here);
    for (const Diagnostic& d : repeated.all())
      if (d.code != Code::N0002) diagnostics_.report(d.code, d.message) = d;
    if (!result) return {};
    each.push_back(std::move(*result));
  }
  const bool alike = std::all_of(each.begin(), each.end(),
                                 [&](const ProgramCommand& other) { return same(each[0], other); });
  if (!target->group || !alike) return each;
  each.front().group = target->group;
  each.front().actuators = target->actuators;
  each.resize(1);
  return each;
}

std::optional<Target> Commands::find_target(const ast::Command& command, std::size_t& named_by) {
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const ast::Word* word = plain_word(command.arguments[i]);
    if (word == nullptr || expressions_.find_binding(word->name.text) != nullptr) continue;
    if (auto target = names_.find_target(word->name.text)) {
      named_by = i;
      return target;
    }
  }
  return only_target(command);
}

// `SAY "hello"`: without a name, the one actuator that knows the verb.
std::optional<Target> Commands::only_target(const ast::Command& command) {
  const std::vector<std::size_t>& able = names_.able_to(command.verb.text);
  if (able.size() == 1) return Target{std::nullopt, able, robot_.actuators[able.front()].name.text};
  report_no_target(command, able);
  return std::nullopt;
}

void Commands::report_no_target(const ast::Command& command, const std::vector<std::size_t>& able) {
  const ast::Word* first =
      command.arguments.empty() ? nullptr : plain_word(command.arguments.front());
  if (first == nullptr || is_known_word(first->name.text)) {
    Diagnostic& d =
        diagnostics_.report(Code::E0504, "this does not say which actuator to " + command.verb.text)
            .label(command.verb.span);
    if (!diagnostics_.may_search(able.size())) return;
    std::vector<std::string> names;
    for (const std::size_t actuator : able)
      names.push_back(robot_.actuators[actuator].name.text);
    d.helps(list_names(names) + " know `" + command.verb.text + "`");
    return;
  }
  Diagnostic& d =
      diagnostics_.report(Code::E0501, "there is no actuator `" + first->name.text + "`")
          .label(first->name.span);
  if (!diagnostics_.may_search(robot_.actuators.size() + robot_.groups.size())) return;
  const auto candidates = names_.target_names();
  suggest(d, first->name.span, first->name.text, candidates);
  if (d.help.empty()) d.helps("actuators: " + list_names(candidates));
}

void Commands::report_unknown_verb(const ast::Command& command) {
  const ast::Name& verb = command.verb;
  const std::string what = command.arguments.empty() ? "DEFINE or verb `" : "verb `";
  Diagnostic& d =
      diagnostics_.report(Code::E0501, "there is no " + what + verb.text + "`").label(verb.span);
  if (!diagnostics_.may_search(robot_.actuators.size() + names_.defines().size())) return;
  auto candidates = names_.verb_names();
  const auto defines = names_.define_names();
  candidates.insert(candidates.end(), defines.begin(), defines.end());
  const auto verbs = candidates;
  candidates.insert(candidates.end(), keyword_spellings().begin(), keyword_spellings().end());
  suggest(d, verb.span, verb.text, candidates);
  if (d.help.empty() && !verbs.empty()) d.helps("it could be " + list_names(verbs));
}

std::optional<std::vector<Commands::Given>> Commands::evaluate(const ast::Command& command,
                                                               std::size_t named_by) {
  std::vector<Given> result;
  bool good = true;
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    if (i == named_by) continue;
    Given given = evaluate(command.arguments[i]);
    good = good && (!given.is_number || given.number.is_number());
    result.push_back(std::move(given));
  }
  if (!good) return std::nullopt;
  return result;
}

// A word alone belongs to the actuator, unless no actuator knows it and the program does.
Commands::Given Commands::evaluate(const ast::Argument& argument) {
  Given given{&argument, param_of(argument), {}, false, std::nullopt};
  if (const auto* text = std::get_if<ast::Text>(&argument.value)) given.text = text->text;
  if (const auto* word = std::get_if<ast::Word>(&argument.value)) {
    const Binding* binding = expressions_.find_binding(word->name.text);
    if (binding != nullptr && binding->text) given.text = binding->text;
  }
  const ast::Word* alone = plain_word(argument);
  given.is_number = argument.preposition != ast::Preposition::none ||
                    std::holds_alternative<ast::Amount>(argument.value) ||
                    (alone != nullptr && !given.text && !is_known_word(alone->name.text) &&
                     names_a_number(alone->name));
  if (given.is_number) given.number = evaluate_number(argument);
  return given;
}

bool Commands::is_known_word(std::string_view word) const {
  return names_.is_word(word);
}

bool Commands::names_a_number(const ast::Name& name) const {
  return expressions_.find_binding(name.text) != nullptr ||
         names_.find_constant(name.text) != nullptr || names_.find_variable(name.text) != nullptr;
}

std::optional<Target> Commands::find_stopped(const ast::Name& name) {
  auto target = names_.find_target(name.text);
  if (target || name.text.empty()) return target;
  Diagnostic& d =
      diagnostics_.report(Code::E0501, "there is no actuator `" + name.text + "`").label(name.span);
  const auto candidates = names_.target_names();
  suggest(d, name.span, name.text, candidates);
  if (d.help.empty() && !candidates.empty()) d.helps("actuators: " + list_names(candidates));
  return std::nullopt;
}

Typed Commands::evaluate_number(const ast::Argument& argument) {
  if (const auto* amount = std::get_if<ast::Amount>(&argument.value))
    return amount->value ? expressions_.number(*amount->value) : Typed{};
  if (const auto* word = std::get_if<ast::Word>(&argument.value))
    return expressions_.number_of(
        expressions_.operand({word->name, std::nullopt}, word->name.span));
  diagnostics_.report(Code::E0505, "a text cannot stand here, a number can").label(argument.span);
  return {};
}

}  // namespace robosync::compiler
