// Part of Commands: commands whose parts are each correct but that are wrong as a whole: they contradict themselves, give a
// motor more than its limit, or say nothing.
#include <algorithm>
#include <cstdlib>
#include <optional>

#include "compiler/config/devices.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/sema/commands.hpp"

namespace robosync::compiler {

namespace {

// The index of the argument that gives a parameter, as a number or as a word.
template <class Given>
std::optional<std::size_t> giver(const ActuatorConfig& actuator, const std::vector<Given>& given,
                                 vm::Param param) {
  const auto found = std::ranges::find_if(given, [&](const Given& one) {
    if (one.is_number) return one.param == param;
    const auto* const word = std::get_if<ast::Word>(&one.argument->value);
    const WordConfig* const known =
        word == nullptr || one.text ? nullptr : actuator.find_word(word->name.text);
    return known != nullptr && known->param == param;
  });
  if (found == given.end()) return std::nullopt;
  return static_cast<std::size_t>(found - given.begin());
}

std::string negated(const Typed& literal) {
  const std::string digits =
      literal.digits.starts_with("-") ? literal.digits.substr(1) : "-" + literal.digits;
  return digits + std::string(literal.unit == nullptr ? "" : literal.unit->spelling);
}

bool can_reach(const ActuatorConfig& actuator, const Typed& literal) {
  const vm::Value value = -literal.code.constant;
  return value >= actuator.min && value <= actuator.max;
}

bool is_one(const Typed& number) {
  return number.is_constant() && number.code.constant == vm::kScale;
}

}  // namespace

bool Commands::says_twice(const Recipient& to, const std::vector<Given>& given,
                          const ir::Command& result) {
  const auto report = [&](std::string what, vm::Param second, std::string help) {
    const auto place = giver(to.actuator, given, second);
    to.diagnostics.report(Code::E0505, std::move(what))
        .label(place ? given[*place].argument->span : to.command.verb.span)
        .helps(std::move(help));
    return true;
  };
  if (is_given(result, vm::Param::to) && is_given(result, vm::Param::by))
    return report("the position is given twice", vm::Param::by,
                  "`TO` gives a position, `BY` a distance from here: remove one of them");
  if (is_given(result, vm::Param::to) && is_given(result, vm::Param::at) && gets_power(to.actuator))
    return report("the power is given twice", vm::Param::at,
                  "`TO` sets it, and so do `AT` and words such as SLOWLY: remove one of them");
  if (to.actuator.shows_numbers() && is_given(result, vm::Param::to) &&
      is_given(result, vm::Param::item))
    return report("the picture is given twice", vm::Param::item,
                  "a word gives a picture, and so does a number: remove one of them");
  if (to.verb.action != vm::Action::move) return false;
  if (is_given(result, vm::Param::at) && is_given(result, vm::Param::over))
    return report("the speed is given twice", vm::Param::over,
                  "`OVER` sets how long the movement takes, `AT` and words such as SLOWLY its "
                  "speed: remove one of them");
  return is_given(result, vm::Param::to) && goes_two_ways(to, given);
}

// `TURN head LEFT TO 60deg`: the position gives the direction, and LEFT may give the opposite one. For a motor, TO is not
// a position, and BACKWARD reverses it.
bool Commands::goes_two_ways(const Recipient& to, const std::vector<Given>& given) {
  const auto way = giver(to.actuator, given, vm::Param::direction);
  const auto place = giver(to.actuator, given, vm::Param::to);
  if (!way || !place || !given[*place].is_number) return false;
  const Span word = given[*way].argument->span;
  const Span target = given[*place].argument->span;
  const std::string name(std::get<ast::Word>(given[*way].argument->value).name.text);
  const Typed& number = given[*place].number;
  Diagnostic& d = to.diagnostics
                      .report(Code::E0505, "`TO` gives a position, but `" + name +
                                               "` a direction from here: remove one of them")
                      .label(word)
                      .label(target, "the position", false);
  if (number.digits.empty()) return true;
  const bool back = to.actuator.find_word(name)->value < 0;
  const bool same = number.code.constant == 0 || back == (number.code.constant < 0);
  const bool beside = *way + 1 == *place || *place + 1 == *way;
  const Span both{word.file, std::min(word.begin, target.begin), std::max(word.end, target.end)};
  const std::string literal =
      number.digits + std::string(number.unit == nullptr ? "" : number.unit->spelling);
  const std::string to_place = "TO " + (same ? literal : negated(number));
  if (same || can_reach(to.actuator, number))
    d.helps("to move to that position: `" + to_place + "`");
  if (number.code.constant > 0 && to.verb.has(vm::Param::by))
    d.helps("to move that far from here: `" + name + " BY " + literal + "`");
  if (!beside || (!same && !can_reach(to.actuator, number))) return true;
  const bool distance = number.dimension() == vm::Dimension::length && !same;
  d.fix(both, distance ? name + " BY " + literal : to_place, Applicability::likely);
  return true;
}

// `MOVE arm UP`, which drivers treat as `MOVE arm`.
void Commands::warn_of_a_sweep(const Recipient& to, const std::vector<Given>& given,
                               const ir::Command& result) {
  const auto way = giver(to.actuator, given, vm::Param::direction);
  if (!way || !to.actuator.sweeps || to.verb.action != vm::Action::move ||
      is_given(result, vm::Param::to) || is_given(result, vm::Param::by))
    return;
  const auto& word = std::get<ast::Word>(given[*way].argument->value).name;
  to.diagnostics
      .report(Code::W0221, word.shown() + " does not say how far: " + to.actuator.name.shown() +
                               " sweeps over its whole range and back")
      .label(word.span)
      .helps("say how far: `" + std::string(word.text) + " BY 20deg`, or where to: `TO 20deg`")
      .helps("if you want a sweep, remove " + word.shown());
}

// `DRIVE base FORWARD`
void Commands::note_no_amount(const ast::Command& node, const ir::Command& command) {
  const ActuatorConfig& actuator = robot_.actuators[command.actuators.front()];
  const VerbConfig* const verb = actuator.find_verb(command.verb.name);
  if (verb == nullptr || verb->action == vm::Action::stop || actuator.find_verb("DRIVE") == nullptr)
    return;
  for (const vm::Param amount :
       {vm::Param::to, vm::Param::by, vm::Param::over, vm::Param::for_, vm::Param::times})
    if (is_given(command, amount)) return;
  const bool turns = verb->has(vm::Param::by) &&
                     param_unit(actuator, vm::Param::by, verb).dimension == vm::Dimension::angle;
  diagnostics_
      .report(Code::N0006,
              "without an amount, " + actuator.name.shown() + " does this for a second")
      .label(node.verb.span)
      .helps(std::string("say how much: `") +
             (turns                      ? "90deg"
              : verb->has(vm::Param::by) ? "20cm"
                                         : "FOR 2s") +
             "`");
}

// A move to a position and a level that is held happen once. Drivers repeat only sweeps and blinks, which have no end.
bool Commands::repeats_nothing(const Recipient& to, const std::vector<Given>& given,
                               const ir::Command& result) {
  const auto times = giver(to.actuator, given, vm::Param::times);
  if (!times || is_one(given[*times].number)) return false;
  const bool kept_up = to.verb.has(vm::Param::at) && is_given(result, vm::Param::for_);
  const bool by = is_given(result, vm::Param::by);
  if (!by && !kept_up && !is_given(result, vm::Param::to)) return false;
  const std::string_view beside = by ? "BY" : kept_up ? "FOR" : "TO";
  const std::string& digits = given[*times].number.digits;
  const std::string repeat = "REPEAT " + (digits.empty() ? "…" : digits) + " TIMES";
  to.diagnostics
      .report(Code::E0505,
              "`TIMES` has no effect with `" + std::string(beside) + "`: that happens only once")
      .label(given[*times].argument->span)
      .helps("remove it; to repeat the command, put it between `" + repeat + "` and `END`");
  return true;
}

// ---- for a motor and a lamp, TO also sets the power

// Does not check what a TEST expects: such a command never occurs, and the TEST reports that. Nor does it check a word:
// ON is the allowed maximum.
bool Commands::gives_too_much(const ast::Command& node, const ir::Command& command) {
  const auto to = std::ranges::find(command.arguments, vm::Param::to, &ir::Argument::param);
  const auto said =
      std::ranges::find(node.arguments, ast::Preposition::to, &ast::Argument::preposition);
  if (to == command.arguments.end() || said == node.arguments.end() ||
      to->value.operation != Operation::constant)
    return false;
  for (const std::size_t place : command.actuators) {
    const ActuatorConfig& motor = robot_.actuators[place];
    if (std::abs(to->value.constant) <= motor.speed_limit || !gets_power(motor)) continue;
    diagnostics_.report(Code::E0507, "this is more power than " + motor.name.shown() + " may get")
        .label(said->span)
        .label(motor.limit_span, "the limit", false);
    return true;
  }
  return false;
}

// ---- a number alone

// A number without a preposition.
bool Commands::is_number_alone(const Given& given) {
  return given.is_number && given.param == vm::Param::by &&
         given.argument->preposition == ast::Preposition::none;
}

// `SAY visitors`: a number alone, where a text is possible and BY has no meaning.
bool Commands::is_to_be_said(const VerbConfig& verb, const Given& given) {
  return is_number_alone(given) && verb.texts == Texts::any && !verb.has(vm::Param::by);
}

// `SHOW face score`.
bool Commands::is_to_be_shown(const Recipient& to, const Given& given) {
  return is_number_alone(given) && to.actuator.shows_numbers() && to.verb.has(vm::Param::to);
}

// `SHOW face heart`, where `heart` is also a variable.
void Commands::warn_of_hidden(const Recipient& to, const ast::Word& word) const {
  const VariableName* const variable = names_.find_variable(word.name.text);
  if (!to.actuator.shows_numbers() || !to.verb.has(vm::Param::to) || !names_a_number(word.name) ||
      (variable != nullptr && !variable->labels.empty()))
    return;
  const std::string better = "TO " + std::string(word.name.text);
  to.diagnostics.report(Code::W0224, "this shows a picture, not the number with the same name")
      .label(word.name.span)
      .helps("for the number, write `" + better + "`; to make it clear, rename one of the two")
      .fix(word.name.span, better, Applicability::likely);
}

// ---- nothing to say

namespace {

// Suggestions for missing content: sounds and texts in quotes, or pictures.
std::vector<std::string> contents_of(const ActuatorConfig& actuator, const VerbConfig& verb) {
  std::vector<std::string> contents;
  for (const WordConfig& word : actuator.words) {
    if (word.param != vm::Param::item ||
        (word.text ? verb.texts == Texts::none : !verb.goes_with(word)))
      continue;
    contents.push_back(word.text ? "\"" + word.name + "\"" : word.name);
  }
  if (verb.texts == Texts::any) contents.insert(contents.begin(), "\"Hello!\"");
  return contents;
}

constexpr unsigned bit(vm::Param param) {
  return 1U << static_cast<unsigned>(param);
}

}  // namespace

// For an actuator that plays only the files of robot.json.
void Commands::help_with_files(const Recipient& to, Diagnostic& d) {
  if (!to.diagnostics.may_search(to.actuator.words.size())) return;
  const std::vector<std::string> files = contents_of(to.actuator, to.verb);
  d.helps(files.empty()
              ? "list its files under \"sounds\" in robot.json, and write one of them in quotes"
              : "write one of its files in quotes: " + list_names(files, "or"));
}

// Checks only verbs that take nothing else: BLINK needs no colour, and a tone has AT.
bool Commands::lacks_content(const ir::Command& command, Span span) {
  if (command.word || is_given(command, vm::Param::item) || is_given(command, vm::Param::to) ||
      command.actuators.empty())
    return false;
  const ActuatorConfig& actuator = robot_.actuators[command.actuators.front()];
  const VerbConfig* const verb = actuator.find_verb(command.verb.name);
  if (verb == nullptr || !verb->has(vm::Param::item) ||
      (verb->takes & ~(bit(vm::Param::item) | bit(vm::Param::to) | bit(vm::Param::for_))) != 0)
    return false;
  const std::vector<std::string> contents = contents_of(actuator, *verb);
  if (contents.empty()) return false;
  diagnostics_.report(Code::E0514, "this does not say what to " + verb->name)
      .label(span)
      .helps((contents.size() > 1 ? "add one of these: " : "add ") + list_names(contents, "or"))
      .fix({span.file, span.end, span.end}, " " + contents.front(), Applicability::placeholder);
  return true;
}

}  // namespace robosync::compiler
