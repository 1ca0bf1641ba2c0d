// What one actuator makes of a command's arguments: its own words, units, ranges and limits.
#include <algorithm>
#include <array>

#include "compiler/config/wiring.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/commands.hpp"
#include "compiler/syntax/keywords.hpp"

namespace robosync::compiler {
namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Param::count_)> kSpellings = {
#define PARAM(name, spelling, doc) spelling,
#include "vm/params.def"
#undef PARAM
};

std::string spelling(vm::Param param) {
  return std::string(kSpellings[static_cast<std::size_t>(param)]);
}

bool takes(const VerbConfig& verb, vm::Param param) {
  return (verb.takes >> static_cast<unsigned>(param) & 1u) != 0;
}

std::string taken_by(const VerbConfig& verb) {
  std::vector<std::string> names;
  for (unsigned p = 0; p < kSpellings.size(); ++p)
    if ((verb.takes >> p & 1u) != 0 && !kSpellings[p].empty()) names.emplace_back(kSpellings[p]);
  return names.empty() ? "`" + verb.name + "` takes no numbers"
                       : "`" + verb.name + "` takes " + list_names(names);
}

bool is_given(const ProgramCommand& command, vm::Param param) {
  return (command.word && command.word->param == param) ||
         std::any_of(command.arguments.begin(), command.arguments.end(),
                     [&](const ProgramArgument& argument) { return argument.param == param; });
}

// The first word travels in the command itself, others as parameters.
void put(const std::string& name, vm::Param param, vm::Value value, ProgramCommand& result) {
  if (!result.word)
    result.word = ProgramWord{name, param, value};
  else
    result.arguments.push_back({param, make_constant_code(value)});
}

std::vector<std::string> verb_names(const ActuatorConfig& actuator) {
  std::vector<std::string> names;
  for (const VerbConfig& verb : actuator.verbs)
    names.push_back(verb.name);
  return names;
}

void report_twice(Span span, const std::string& what, Diagnostics& diagnostics) {
  diagnostics.report(Code::E0505, what + " is given twice").label(span);
}

// Is a number that is known now one that the actuator can do?
bool check_value(const ActuatorConfig& actuator, vm::Param param, const Typed& number,
                 Diagnostics& diagnostics) {
  const vm::Value value = number.code.constant;
  const Unit& unit = *number.unit;
  if (param == vm::Param::to && (value < actuator.min || value > actuator.max)) {
    diagnostics
        .report(Code::E0506,
                "`" + actuator.name.text + "` cannot reach " + format_value(value, unit))
        .label(number.span)
        .label(actuator.range_span,
               "it goes from " + format_value(actuator.min, unit) + " to " +
                   format_value(actuator.max, unit),
               false);
    return false;
  }
  if (param == vm::Param::at && value > actuator.speed_limit) {
    diagnostics.report(Code::E0507, "this is faster than `" + actuator.name.text + "` may go")
        .label(number.span)
        .label(actuator.limit_span, "the limit", false);
    return false;
  }
  const bool counts = param == vm::Param::times;
  const bool positive = param == vm::Param::at || counts;
  const bool has_sign = param == vm::Param::to || param == vm::Param::by;
  if (has_sign || (value > 0 || (!positive && value == 0))) {
    if (!counts || value % vm::kScale == 0) return true;
    diagnostics.report(Code::E0506, "TIMES counts in whole numbers").label(number.span);
    return false;
  }
  diagnostics
      .report(Code::E0506,
              spelling(param) + (positive ? " must be above 0" : " cannot be negative"))
      .label(number.span);
  return false;
}

void report_dimension(const ActuatorConfig& actuator, vm::Param param, const Unit& unit,
                      const Typed& number, Diagnostics& diagnostics) {
  Diagnostic& d = diagnostics
                      .report(Code::E0301,
                              "`" + spelling(param) + "` of `" + actuator.name.text + "` is " +
                                  std::string(dimension_phrase(unit.dimension)) + ", and this is " +
                                  std::string(dimension_phrase(number.dimension())))
                      .label(number.digits.empty() ? number.span : number.unit_span)
                      .label(actuator.name.span, "the actuator", false);
  if (number.digits.empty()) return;
  const std::string mended = number.digits + std::string(unit.spelling);
  d.helps("did you mean `" + mended + "`?").fix(number.span, mended);
}

}  // namespace

std::optional<ProgramCommand> Commands::for_actuator(std::size_t actuator,
                                                     const ast::Command& command,
                                                     const std::vector<Given>& given,
                                                     Diagnostics& diagnostics) const {
  const ActuatorConfig& config = robot_.actuators[actuator];
  const VerbConfig* verb = config.find_verb(command.verb.text);
  if (verb == nullptr) {
    diagnostics
        .report(Code::E0503,
                "`" + config.name.text + "` does not know the verb `" + command.verb.text + "`")
        .label(command.verb.span)
        .helps("it knows " + list_names(verb_names(config)));
    return std::nullopt;
  }
  ProgramCommand result;
  result.actuators = {actuator};
  result.verb = {verb->name, verb->action, verb->takes};
  const Place place{config, *verb, command, diagnostics};
  bool good = true;
  for (const Given& one : given)
    good = add(place, one, result) && good;
  if (!good) return std::nullopt;
  return result;
}

bool Commands::add(const Place& place, const Given& given, ProgramCommand& result) const {
  const ast::Argument& argument = *given.argument;
  if (given.is_number) return add_number(place, given, result);
  if (given.text) return add_text(place, *given.text, argument.span, result);
  return add_word(place, std::get<ast::Word>(argument.value), argument.span, result);
}

bool Commands::add_word(const Place& place, const ast::Word& word, Span span,
                        ProgramCommand& result) const {
  const WordConfig* known = place.actuator.find_word(word.name.text);
  if (known == nullptr) {
    report_unknown_word(place, word);
    return false;
  }
  if (!takes(place.verb, known->param)) {
    place.diagnostics
        .report(Code::E0505, "`" + place.verb.name + "` does not go with `" + known->name + "`")
        .label(span);
    return false;
  }
  if (is_given(result, known->param)) {
    report_twice(span, "what `" + known->name + "` says", place.diagnostics);
    return false;
  }
  if (known->param == vm::Param::at && known->value > place.actuator.speed_limit) {
    const Unit& unit = param_unit(place.actuator, vm::Param::at);
    place.diagnostics
        .report(Code::N0003, "`" + known->name + "` is " + format_value(known->value, unit) +
                                 ", but `" + place.actuator.name.text + "` goes no faster than " +
                                 format_value(place.actuator.speed_limit, unit))
        .label(span)
        .label(place.actuator.limit_span, "the limit", false);
  }
  put(known->name, known->param, known->value, result);
  return true;
}

void Commands::report_unknown_word(const Place& place, const ast::Word& word) const {
  Diagnostic& d = place.diagnostics
                      .report(Code::E0501, "`" + place.actuator.name.text +
                                               "` does not know the word `" + word.name.text + "`")
                      .label(word.name.span);
  const std::size_t targets_known = robot_.actuators.size() + robot_.groups.size();
  if (!diagnostics_.may_search(place.actuator.words.size() + targets_known)) return;
  std::vector<std::string> words;
  for (const WordConfig& known : place.actuator.words)
    if (!known.text) words.push_back(known.name);
  auto candidates = words;
  const auto targets = names_.target_names();
  candidates.insert(candidates.end(), targets.begin(), targets.end());
  candidates.insert(candidates.end(), keyword_spellings().begin(), keyword_spellings().end());
  suggest(d, word.name.span, word.name.text, candidates);
  if (d.help.empty() && !words.empty()) d.helps("it knows " + list_names(words));
}

bool Commands::add_text(const Place& place, const std::string& text, Span span,
                        ProgramCommand& result) const {
  if (place.verb.texts == Texts::none) {
    place.diagnostics.report(Code::E0505, "`" + place.verb.name + "` takes no text").label(span);
    return false;
  }
  if (is_given(result, vm::Param::item)) {
    report_twice(span, "what to " + place.verb.name, place.diagnostics);
    return false;
  }
  const WordConfig* known = place.actuator.find_text(text);
  if (known != nullptr) {
    put(known->name, known->param, known->value, result);
    const bool has_length =
        std::any_of(place.command.arguments.begin(), place.command.arguments.end(),
                    [](const ast::Argument& a) { return a.preposition == ast::Preposition::for_; });
    if (known->duration && !has_length && takes(place.verb, vm::Param::for_))
      result.arguments.push_back({vm::Param::for_, make_constant_code(*known->duration)});
    return true;
  }
  if (place.verb.texts == Texts::any) {
    put(text, vm::Param::item, 0, result);
    return true;
  }
  Diagnostic& d =
      place.diagnostics
          .report(Code::E0502, "`" + place.actuator.name.text + "` has no \"" + text + "\"")
          .label(span);
  if (!diagnostics_.may_search(place.actuator.words.size())) return false;
  std::vector<std::string> sounds;
  for (const WordConfig& word : place.actuator.words)
    if (word.text) sounds.push_back(word.name);
  if (const auto near = nearest(text, sounds))
    d.helps("did you mean \"" + *near + "\"?").fix(span, "\"" + *near + "\"");
  else
    d.helps(sounds.empty() ? "list its files under \"sounds\" in robot.json"
                           : "it has " + list_names(sounds));
  return false;
}

bool Commands::add_number(const Place& place, const Given& given, ProgramCommand& result) const {
  const ActuatorConfig& actuator = place.actuator;
  Diagnostics& diagnostics = place.diagnostics;
  const Span span = given.argument->span;
  if (!takes(place.verb, given.param)) {
    diagnostics
        .report(Code::E0505,
                "`" + place.verb.name + "` does not take `" + spelling(given.param) + "`")
        .label(span)
        .helps(taken_by(place.verb));
    return false;
  }
  if (is_given(result, given.param)) {
    report_twice(span, "`" + spelling(given.param) + "`", diagnostics);
    return false;
  }
  const Unit& unit = param_unit(actuator, given.param);
  Typed number = given.number;
  const std::string source = spelling(given.param) + " for " + actuator.name.text;
  if (number.is_bare())
    take_unit(number, {&unit, source, actuator.name.span, given.param == vm::Param::by},
              diagnostics);
  if (!number.is_number()) return false;
  if (number.dimension() != unit.dimension) {
    report_dimension(actuator, given.param, unit, number, diagnostics);
    return false;
  }
  if (number.is_constant() && !check_value(actuator, given.param, number, diagnostics))
    return false;
  result.arguments.push_back({given.param, std::move(number.code)});
  return true;
}

}  // namespace robosync::compiler
