#include "compiler/sema/commands.hpp"

#include <algorithm>
#include <array>

#include "compiler/config/devices.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {

// ---- which actuator, which arguments

namespace {

constexpr std::size_t kNotNamed = static_cast<std::size_t>(-1);
// The parameter for MARGIN, which no actuator's verb takes.
constexpr vm::Param kMargin = vm::Param::count_;

vm::Param param_of(const ast::Argument& argument) {
  constexpr std::array kParams = {vm::Param::by, vm::Param::to,   vm::Param::by, vm::Param::over,
                                  vm::Param::at, vm::Param::for_, kMargin};
  const auto* amount = std::get_if<ast::Amount>(&argument.value);
  if (amount != nullptr && amount->times) return vm::Param::times;
  return kParams[static_cast<std::size_t>(argument.preposition)];
}

// Do two actuators understand the command in the same way?
bool same(const ir::Command& a, const ir::Command& b) {
  return a.verb == b.verb && a.word == b.word && a.arguments == b.arguments;
}

}  // namespace

const ast::Word* plain_word(const ast::Argument& argument) {
  return argument.preposition == ast::Preposition::none ? std::get_if<ast::Word>(&argument.value)
                                                        : nullptr;
}

bool is_given(const ir::Command& command, vm::Param param) {
  return (command.word && command.word->param == param) ||
         std::any_of(command.arguments.begin(), command.arguments.end(),
                     [&](const ir::Argument& argument) { return argument.param == param; });
}

std::vector<std::string> verb_names(const ActuatorConfig& actuator) {
  std::vector<std::string> names;
  names.reserve(actuator.verbs.size());
  for (const VerbConfig& verb : actuator.verbs)
    names.push_back(verb.name);
  return names;
}

void report_twice(Span span, const std::string& what, Diagnostics& diagnostics) {
  diagnostics.report(Code::E0505, what + " is given twice").label(span);
}

std::vector<ir::Command> Commands::translate(const ast::Command& command,
                                             const ChosenText* chosen) {
  chosen_ = chosen;
  if (command.verb.text.empty()) return {};
  if (command.with) {
    diagnostics_
        .report(Code::E0505,
                "`WITH` gives values to a DEFINE, and " + command.verb.shown() + " is not one")
        .label(*command.with)
        .helps("use `TO`, `BY`, `AT`, `OVER`, `FOR` or `TIMES` instead");
    return {};
  }
  if (!names_.is_verb(command.verb.text)) {
    if (same_name(command.verb.text, kPerform)) return perform(command);
    if (is_follow(command)) return expected_follow(command);
    report_unknown_verb(command);
    return {};
  }
  std::size_t named_by = kNotNamed;
  const auto target = find_target(command, named_by);
  const auto given = evaluate(command, named_by);
  if (!target || !given || target->actuators.empty()) return {};
  std::vector<ir::Command> each;
  for (const std::size_t actuator : target->actuators) {
    // Reports for one member are not repeated for the others.
    Diagnostics repeated;
    Diagnostics& here = each.empty() ? diagnostics_ : repeated;
    auto result = for_actuator(actuator, command, *given, here);
    for (const Diagnostic& d : repeated.all())
      if (d.code != Code::N0002 && d.code != Code::W0221 && d.code != Code::W0224)
        diagnostics_.report(d.code, d.message) = d;
    if (!result) return {};
    each.push_back(std::move(*result));
  }
  const bool alike = std::all_of(each.begin(), each.end(),
                                 [&](const ir::Command& other) { return same(each[0], other); });
  if (!target->group || !alike) return each;
  each.front().group = target->group;
  each.front().actuators = target->actuators;
  each.resize(1);
  return each;
}

std::optional<Target> Commands::find_target(const ast::Command& command, std::size_t& named_by) {
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const ast::Word* word = is_chosen(i) ? nullptr : plain_word(command.arguments[i]);
    if (word == nullptr) continue;
    if (const Binding* binding = expressions_.find_binding(word->name.text)) {
      if (binding->actuator.empty()) continue;
      named_by = i;
      return names_.find_target(binding->actuator);
    }
    if (auto target = names_.find_target(word->name.text)) {
      named_by = i;
      return target;
    }
  }
  return only_target(command);
}

const ast::Word* Commands::first_word(const ast::Command& command) const {
  if (command.arguments.empty() || is_chosen(0)) return nullptr;
  return plain_word(command.arguments.front());
}

// `SAY "hello"`: without a name, the one actuator that knows the verb.
std::optional<Target> Commands::only_target(const ast::Command& command) {
  const std::vector<std::size_t>& able = names_.able_to(command.verb.text);
  if (able.size() != 1 && is_given_another(command)) return std::nullopt;
  if (able.size() == 1) return Target{std::nullopt, able, robot_.actuators[able.front()].name.text};
  report_no_target(command, able);
  return std::nullopt;
}

// True if a parameter is in the actuator's place but was passed something else. This is reported,
// unless nothing runs the DEFINE.
bool Commands::is_given_another(const ast::Command& command) {
  const ast::Word* first = first_word(command);
  const Binding* binding = first == nullptr ? nullptr : expressions_.find_binding(first->name.text);
  if (binding == nullptr) return false;
  if (!is_open(*binding)) expressions_.report_given(*binding, first->name, "an actuator");
  return true;
}

void Commands::report_no_target(const ast::Command& command, const std::vector<std::size_t>& able) {
  if (is_torn_name(command)) return;
  const ast::Word* first = first_word(command);
  if (first == nullptr || is_known_word(first->name.text)) {
    Diagnostic& d = diagnostics_
                        .report(Code::E0504, "this does not say which actuator to " +
                                                 std::string(command.verb.text))
                        .label(command.verb.span);
    if (!diagnostics_.may_search(able.size())) return;
    std::vector<std::string> names;
    names.reserve(able.size());
    for (const std::size_t actuator : able)
      names.push_back(robot_.actuators[actuator].name.text);
    d.helps("actuators that know " + command.verb.shown() + ": " + list_names(names));
    return;
  }
  const bool sensor = names_.find_sensor(first->name.text).has_value();
  Diagnostic& d =
      diagnostics_
          .report(Code::E0501, sensor ? first->name.shown() + " is a sensor, not an actuator"
                                      : "there is no actuator " + first->name.shown())
          .label(first->name.span);
  if (!diagnostics_.may_search(robot_.actuators.size() + robot_.groups.size()) ||
      names_.help_with_actuator(d, first->name))
    return;
  const auto candidates = names_.target_names();
  did_you_mean(d, first->name.span, first->name.text, candidates);
  names_.doubt_group(d, first->name.text);
  if (d.help.empty()) d.helps("actuators: " + list_names(candidates));
}

std::optional<std::vector<Commands::Given>> Commands::evaluate(const ast::Command& command,
                                                               std::size_t named_by) {
  std::vector<Given> result;
  bool good = true;
  const std::size_t first_part = command.arguments.size() - command.parts;
  if (named_by == first_part) {
    Diagnostic& d = diagnostics_.report(Code::E0505, "a comma does not belong after the actuator")
                        .label(command.arguments[named_by].span);
    if (!std::holds_alternative<ast::Text>(command.arguments[named_by + 1].value))
      d.helps("write a command for each actuator, or give them a group in robot.json");
    return std::nullopt;
  }
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    if (i == named_by || (is_chosen(i) && i != chosen_->at)) continue;
    if (is_misread(command, i)) return std::nullopt;
    if (i >= first_part || (is_chosen(i) && chosen_->at + chosen_->count > first_part)) {
      result.push_back(put_together(command, i));
      if (!result.back().text) return std::nullopt;
      break;
    }
    Given given = is_chosen(i)
                      ? Given{&command.arguments[i], {}, {}, false, chosen_->text, chosen_->span}
                      : evaluate(command.arguments[i], command.verb.text);
    good = good && (!given.is_number || given.number.is_number());
    result.push_back(std::move(given));
  }
  if (!good) return std::nullopt;
  return result;
}

Commands::Given Commands::put_together(const ast::Command& command, std::size_t first) {
  TextBuilder text(expressions_, diagnostics_);
  const ast::Argument& begin = command.arguments[first];
  Given given{&begin, {}, {}, false, std::nullopt, begin.span};
  given.text_span.end = command.arguments.back().span.end;
  bool good = true;
  for (std::size_t i = first; i < command.arguments.size(); ++i) {
    const ast::Argument& part = command.arguments[i];
    if (is_chosen(i)) {
      if (i == chosen_->at) good = text.add(chosen_->text, chosen_->span) && good;
    } else if (i + 1 < command.arguments.size() &&
               has_decimal_comma(part, command.arguments[i + 1])) {
      return given;
    } else if (part.preposition != ast::Preposition::none) {
      diagnostics_.report(Code::E0505, "the parts of a text are separated by commas")
          .label(part.span, "this is not part of the text")
          .helps("put a text and its parts last: `FOR 2s \"You have\", points`");
      return given;
    } else {
      good = text.add(part) && good;
    }
  }
  if (!good) return given;
  given.text = text.text();
  given.values = std::move(text.values());
  return given;
}

// A single word belongs to the actuator, unless only the program knows it.
Commands::Given Commands::evaluate(const ast::Argument& argument, std::string_view verb) {
  Given given{&argument, param_of(argument), {}, false, std::nullopt, argument.span};
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
  if (!given.is_number) return given;
  Typed value = evaluate_value(argument);
  if (value.type != Type::word || argument.preposition != ast::Preposition::none ||
      !says_any_text(verb)) {
    given.number = expressions_.number_of(std::move(value));
    return given;
  }
  TextBuilder word(expressions_, diagnostics_);
  if (!word.add(std::move(value))) return given;
  given.is_number = false;
  given.text = word.text();
  given.values = std::move(word.values());
  return given;
}

bool Commands::says_any_text(std::string_view verb) const {
  return std::ranges::any_of(names_.able_to(verb), [&](std::size_t actuator) {
    return robot_.actuators[actuator].find_verb(verb)->texts == Texts::any;
  });
}

bool Commands::is_known_word(std::string_view word) const {
  return names_.is_word(word);
}

bool Commands::names_a_number(const ast::Name& name) const {
  const Binding* binding = expressions_.find_binding(name.text);
  if (binding != nullptr) return binding->is_number;
  return names_.find_constant(name.text) != nullptr || names_.find_variable(name.text) != nullptr;
}

std::optional<Target> Commands::find_stopped(const ast::Name& name) {
  auto target = names_.find_target(name.text);
  if (target || name.text.empty()) return target;
  Diagnostic& d =
      diagnostics_.report(Code::E0501, "there is no actuator " + name.shown()).label(name.span);
  const VariableName* const timer = names_.find_variable(name.text);
  if (timer != nullptr && timer->kind == vm::VariableKind::timer) {
    d.helps(name.shown() + " is a TIMER, which never stops; `RESTART " + std::string(name.text) +
            "` sets it back to 0");
    return std::nullopt;
  }
  if (names_.help_with_actuator(d, name)) return std::nullopt;
  const auto candidates = names_.target_names();
  did_you_mean(d, name.span, name.text, candidates);
  names_.doubt_group(d, name.text);
  if (d.help.empty() && !candidates.empty()) d.helps("actuators: " + list_names(candidates));
  return std::nullopt;
}

Typed Commands::evaluate_value(const ast::Argument& argument) {
  if (const auto* amount = std::get_if<ast::Amount>(&argument.value))
    return amount->value ? expressions_.any(*amount->value) : Typed{};
  if (const auto* word = std::get_if<ast::Word>(&argument.value))
    return expressions_.operand({word->name, nullptr}, word->name.span);
  diagnostics_.report(Code::E0505, "this must be a number, not a text").label(argument.span);
  return {};
}

// ---- the arguments for one actuator: its own words, units, ranges and limits

namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Param::count_)> kSpellings = {
#define PARAM(name, spelling, doc) spelling,
#include "vm/params.def"
#undef PARAM
};

std::string spelling(vm::Param param) {
  return std::string(param == kMargin ? "MARGIN" : kSpellings[static_cast<std::size_t>(param)]);
}

std::string taken_by(const VerbConfig& verb) {
  std::vector<std::string> names;
  for (unsigned p = 0; p < kSpellings.size(); ++p)
    if ((verb.takes >> p & 1u) != 0 && !kSpellings[p].empty()) names.emplace_back(kSpellings[p]);
  return names.empty() ? "`" + verb.name + "` takes no numbers"
                       : "`" + verb.name + "` takes " + list_names(names);
}

// The first word is stored in the command itself, others as parameters.
void put(const std::string& name, vm::Param param, vm::Value value, ir::Command& result) {
  if (!result.word)
    result.word = ir::Word{name, param, value};
  else
    result.arguments.push_back({param, make_constant_code(value)});
}

// Speech takes as long as its words, unless FOR gives another time.
bool takes_its_words(const ir::Command& command) {
  return command.word && command.word->param == vm::Param::for_;
}

// Checks a constant against the actuator's range.
bool check_value(const ActuatorConfig& actuator, vm::Param param, const Typed& number,
                 Diagnostics& diagnostics) {
  const vm::Value value = number.code.constant;
  const Unit& unit = *number.unit;
  if (param == vm::Param::to && (value < actuator.min || value > actuator.max)) {
    diagnostics
        .report(Code::E0506, actuator.name.shown() +
                                 (actuator.shows_numbers() ? " cannot show " : " cannot reach ") +
                                 format_value(value, unit))
        .label(number.span)
        .label(actuator.range_span,
               "it goes from " + format_value(actuator.min, unit) + " to " +
                   format_value(actuator.max, unit),
               false);
    return false;
  }
  if (param == vm::Param::at && value > actuator.speed_limit) {
    diagnostics.report(Code::E0507, "this is faster than " + actuator.name.shown() + " may go")
        .label(number.span)
        .label(actuator.limit_span, "the limit", false);
    return false;
  }
  const bool counts = param == vm::Param::times;
  const bool positive = param == vm::Param::at || counts;
  const bool has_sign = param == vm::Param::to || param == vm::Param::by;
  if (has_sign || (value > 0 || (!positive && value == 0))) {
    if (!counts || value % vm::kScale == 0) return true;
    diagnostics.report(Code::E0506, "TIMES must be a whole number").label(number.span);
    return false;
  }
  diagnostics
      .report(Code::E0506,
              spelling(param) + (positive ? " must be above 0" : " cannot be negative"))
      .label(number.span);
  return false;
}

// The verb whose BY has this dimension; empty when there is none.
std::string verb_by(const ActuatorConfig& actuator, vm::Dimension dimension) {
  const auto verb = std::ranges::find_if(actuator.verbs, [&](const VerbConfig& one) {
    return one.has(vm::Param::by) &&
           param_unit(actuator, vm::Param::by, &one).dimension == dimension;
  });
  return verb == actuator.verbs.end() ? std::string() : "`" + verb->name + "`";
}

// `SHOW face happy 2s`
bool is_time_alone(const VerbConfig* verb, vm::Param param, const Typed& number) {
  return param == vm::Param::to && !number.digits.empty() &&
         number.dimension() == vm::Dimension::duration && verb != nullptr &&
         verb->has(vm::Param::for_);
}

void report_dimension(const ActuatorConfig& actuator, vm::Param param, const VerbConfig* verb,
                      const Unit& unit, const Typed& number, Diagnostics& diagnostics) {
  Diagnostic& d = diagnostics
                      .report(Code::E0301,
                              "`" + spelling(param) + "` of " + actuator.name.shown() + " is " +
                                  std::string(dimension_phrase(unit.dimension)) + ", but this is " +
                                  std::string(dimension_phrase(number.dimension())))
                      .label(number.digits.empty() ? number.span : number.unit_span)
                      .label(actuator.name.span, "the actuator", false);
  if (is_time_alone(verb, param, number)) {
    d.helps("how long it lasts is said with `FOR`")
        .fix({number.span.file, number.span.begin, number.span.begin}, "FOR ",
             Applicability::likely);
    return;
  }
  const std::string verbs = param == vm::Param::by ? verb_by(actuator, number.dimension()) : "";
  if (!verbs.empty())
    d.helps(verbs + " takes " + std::string(dimension_phrase(number.dimension())));
  if (verbs.empty()) help_with_unit(d, number, unit);
  if (number.digits.empty() || !verbs.empty()) return;
  const std::string mended = number.digits + std::string(unit.spelling);
  d.helps("did you mean `" + mended + "`?").fix(number.span, mended, Applicability::likely);
}

}  // namespace

bool fit_parameter(const ActuatorConfig& actuator, vm::Param param, Typed& number,
                   Diagnostics& notes, Diagnostics& diagnostics, const VerbConfig* verb) {
  const Unit& unit = param_unit(actuator, param, verb);
  const std::string source = spelling(param) + " for " + actuator.name.text;
  if (number.is_bare())
    take_unit(number, {&unit, source, actuator.name.span, param == vm::Param::by}, notes);
  if (!number.is_number()) return false;
  if (number.dimension() != unit.dimension) {
    report_dimension(actuator, param, verb, unit, number, diagnostics);
    return false;
  }
  return !number.is_constant() || check_value(actuator, param, number, diagnostics);
}

std::optional<ir::Command> Commands::for_actuator(std::size_t actuator, const ast::Command& command,
                                                  const std::vector<Given>& given,
                                                  Diagnostics& diagnostics) const {
  const ActuatorConfig& config = robot_.actuators[actuator];
  const VerbConfig* verb = config.find_verb(command.verb.text);
  if (verb == nullptr) {
    diagnostics
        .report(Code::E0503,
                config.name.shown() + " does not know the verb " + command.verb.shown())
        .label(command.verb.span)
        .helps("it knows " + list_names(verb_names(config)));
    return std::nullopt;
  }
  ir::Command result;
  result.actuators = {actuator};
  result.verb = {verb->name, verb->action, verb->carries()};
  const Recipient to{config, *verb, command, diagnostics};
  bool good = true;
  for (const Given& one : given) {
    if (add(to, one, result)) continue;
    good = false;
    if (!one.is_number && !one.text) break;  // an unknown word: the rest belongs to it
  }
  if (!good || says_twice(to, given, result) || repeats_nothing(to, given, result))
    return std::nullopt;
  warn_of_a_sweep(to, given, result);
  return result;
}

bool Commands::add(const Recipient& to, const Given& given, ir::Command& result) const {
  const ast::Argument& argument = *given.argument;
  if (is_to_be_said(to.verb, given)) {
    TextBuilder number(expressions_, to.diagnostics);
    number.add(given.number);
    return add_text(
        to, {&argument, {}, {}, false, number.text(), argument.span, std::move(number.values())},
        result);
  }
  if (given.is_number)
    return add_number(to, given, is_to_be_shown(to, given) ? vm::Param::to : given.param, result);
  if (given.text) return add_text(to, given, result);
  return add_word(to, std::get<ast::Word>(argument.value), argument.span, result);
}

bool Commands::add_word(const Recipient& to, const ast::Word& word, Span span,
                        ir::Command& result) const {
  const WordConfig* known = to.actuator.find_word(word.name.text);
  if (known == nullptr) {
    report_unknown_word(to, word);
    return false;
  }
  if (!to.verb.goes_with(*known)) {
    report_foreign_word(to, *known, span);
    return false;
  }
  warn_of_hidden(to, word);
  if (is_given(result, known->param)) {
    const bool word_first = result.word && result.word->param == known->param;
    const std::string first = word_first ? result.word->name : spelling(known->param);
    to.diagnostics
        .report(Code::E0505,
                "`" + to.verb.name + "` takes `" + first + "` or `" + known->name + "`, not both")
        .label(span);
    return false;
  }
  if (known->param == vm::Param::at && known->value > to.actuator.speed_limit) {
    const Unit& unit = param_unit(to.actuator, vm::Param::at);
    to.diagnostics
        .report(Code::N0003, "`" + known->name + "` is " + format_value(known->value, unit) +
                                 ", but " + to.actuator.name.shown() + " goes no faster than " +
                                 format_value(to.actuator.speed_limit, unit))
        .label(span)
        .label(to.actuator.limit_span, "the limit", false);
  }
  put(known->name, known->param, known->value, result);
  return true;
}

// `DRIVE base LEFT`: a word of the actuator, but for other verbs.
void Commands::report_foreign_word(const Recipient& to, const WordConfig& word, Span span) {
  const auto own = to.actuator.words_of(to.verb);
  Diagnostic& d =
      to.diagnostics
          .report(Code::E0505, "`" + to.verb.name + "` does not go with `" + word.name + "`")
          .label(span)
          .helps("`" + to.verb.name + "` " +
                 (own.empty() ? "has no words" : "goes with " + list_names(own)));
  std::vector<std::string> verbs;
  for (const VerbConfig& verb : to.actuator.verbs)
    if (verb.goes_with(word)) verbs.push_back(verb.name);
  if (!verbs.empty()) d.helps("`" + word.name + "` goes with " + list_names(verbs));
}

namespace {

void report_unknown_text(const ActuatorConfig& actuator, const std::string& text, Span span,
                         bool may_search, Diagnostics& diagnostics) {
  Diagnostic& d =
      diagnostics.report(Code::E0502, actuator.name.shown() + " has no \"" + text + "\"")
          .label(span);
  if (!may_search) return;
  std::vector<std::string> sounds;
  for (const WordConfig& word : actuator.words)
    if (word.text) sounds.push_back(word.name);
  if (!did_you_mean(d, span, text, sounds, "\""))
    d.helps(sounds.empty() ? "list its files under \"sounds\" in robot.json"
                           : "it has " + list_names(sounds));
}

}  // namespace

bool Commands::add_text(const Recipient& to, const Given& given, ir::Command& result) const {
  const std::string& text = *given.text;
  const Span span = given.argument->span;
  if (to.verb.texts == Texts::none) {
    report_no_text(to, given);
    return false;
  }
  if (is_given(result, vm::Param::item) || takes_its_words(result)) {
    report_twice(span, "what to " + to.verb.name, to.diagnostics);
    return false;
  }
  const WordConfig* known = to.actuator.find_text(text);
  if (known != nullptr) {
    put(known->name, known->param, known->value, result);
    const bool has_length =
        std::any_of(to.command.arguments.begin(), to.command.arguments.end(),
                    [](const ast::Argument& a) { return a.preposition == ast::Preposition::for_; });
    if (known->duration && !has_length && to.verb.has(vm::Param::for_))
      result.arguments.push_back({vm::Param::for_, make_constant_code(*known->duration)});
    return true;
  }
  if (!say_values(to, given, result)) return false;
  if (to.verb.texts == Texts::any) {
    const bool speaks = to.actuator.word_length > 0 && to.verb.has(vm::Param::for_);
    if (speaks && !is_given(result, vm::Param::for_))
      put(text, vm::Param::for_, to.actuator.word_length * spoken_words(text, given.values.size()),
          result);
    else
      put(text, vm::Param::item, 0, result);
    return true;
  }
  report_unknown_text(to.actuator, text, given.text_span,
                      diagnostics_.may_search(to.actuator.words.size()), to.diagnostics);
  return false;
}

bool Commands::say_values(const Recipient& to, const Given& given, ir::Command& result) const {
  if (given.values.empty()) return true;
  const std::string& verb = to.verb.name;
  if (to.verb.texts != Texts::any) {
    const auto says = std::ranges::find(to.actuator.verbs, Texts::any, &VerbConfig::texts);
    to.diagnostics.report(Code::E0505, "`" + verb + "` plays a file, and cannot say values")
        .label(given.text_span)
        .helps(says != to.actuator.verbs.end() ? "to speak, use `" + says->name + "`"
                                               : "the device \"speaker\" can: it says any text");
    return false;
  }
  if (given.values.size() > vm::kTextParams.size()) {
    to.diagnostics
        .report(Code::E0407, "this text has " + std::to_string(given.values.size()) + " values; `" +
                                 verb + "` takes at most " + std::to_string(vm::kTextParams.size()))
        .label(given.text_span)
        .helps("put the rest in another `" + verb + "`");
    return false;
  }
  for (std::size_t i = 0; i < given.values.size(); ++i) {
    const vm::Param param = vm::kTextParams.at(i);
    if (to.verb.has(param) || is_given(result, param)) {
      report_twice(given.text_span, "`" + spelling(param) + "`", to.diagnostics);
      return false;
    }
    result.arguments.push_back({param, given.values[i]});
  }
  return true;
}

// A number alone counts as BY. The user did not write BY, so the message says that the word before it is missing.
void Commands::report_not_taken(const Recipient& to, const Given& given) {
  const Span span = given.argument->span;
  const std::string verb = "`" + to.verb.name + "`";
  const bool alone =
      given.argument->preposition == ast::Preposition::none && given.param == vm::Param::by;
  if (alone && to.verb.texts == Texts::listed) {
    Diagnostic& d =
        to.diagnostics.report(Code::E0505, verb + " takes a file name, not a number").label(span);
    return help_with_files(to, d);
  }
  Diagnostic& d =
      to.diagnostics
          .report(Code::E0505, alone ? "the word before this number is missing"
                                     : verb + " does not take `" + spelling(given.param) + "`")
          .label(span);
  const bool place =
      alone && to.verb.has(vm::Param::to) && !given.number.is_bare() &&
      given.number.dimension() == param_unit(to.actuator, vm::Param::to, &to.verb).dimension;
  if (place)
    d.helps(verb + " takes a position or a power with `TO`")
        .fix({span.file, span.begin, span.begin}, "TO ", Applicability::likely);
  else if (given.param == vm::Param::times)
    d.helps("to do it several times, write `REPEAT " +
            (given.number.digits.empty() ? "3" : given.number.digits) +
            " TIMES`, the command and `END`, each on its own line");
  else
    d.helps(given.param == vm::Param::for_ && to.verb.has(vm::Param::over)
                ? "how long it takes is said with `OVER`"
                : taken_by(to.verb));
}

bool Commands::add_number(const Recipient& to, const Given& given, vm::Param param,
                          ir::Command& result) const {
  const ActuatorConfig& actuator = to.actuator;
  Diagnostics& diagnostics = to.diagnostics;
  const Span span = given.argument->span;
  if (!to.verb.has(param)) {
    report_not_taken(to, given);
    return false;
  }
  if (param == vm::Param::for_ && takes_its_words(result))
    result.word = ir::Word{result.word->name, vm::Param::item, 0};
  if (is_given(result, param)) {
    report_twice(span, "`" + spelling(param) + "`", diagnostics);
    return false;
  }
  Typed number = given.number;
  if (!fit_parameter(actuator, param, number, diagnostics, diagnostics, &to.verb)) return false;
  result.arguments.push_back({param, std::move(number.code)});
  return true;
}

}  // namespace robosync::compiler
