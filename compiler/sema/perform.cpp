// Part of Commands: PERFORM. Which MOTION, how fast, how often.
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/commands.hpp"

namespace robosync::compiler {

namespace {

constexpr std::uint8_t bit_of(vm::Param param) {
  return static_cast<std::uint8_t>(1u << static_cast<unsigned>(param));
}

constexpr std::uint8_t kPerformTakes =
    bit_of(vm::Param::item) | bit_of(vm::Param::at) | bit_of(vm::Param::times);

}  // namespace

std::vector<ir::Command> Commands::perform(const ast::Command& command) {
  const ast::Word* const word =
      command.arguments.empty() ? nullptr : plain_word(command.arguments.front());
  if (word == nullptr || names_.find_motion(word->name.text) == nullptr) {
    report_no_motion(command);
    return {};
  }
  const auto place = motions_.find(word->name);
  const auto given = evaluate(command, 0);
  if (!place || !given) return {};
  const ir::Motion& motion = motions_.at(*place);
  ir::Command result;
  result.motion = place;
  for (const ir::Track& track : motion.tracks)
    result.actuators.push_back(track.actuator);
  result.verb = {std::string(kPerform), vm::Action::perform, kPerformTakes};
  result.word = ir::Word{motion.name, vm::Param::item, static_cast<vm::Value>(*place) * vm::kScale};
  for (const Given& one : *given)
    if (!add_to_performance(one, result)) return {};
  for (const Given& one : *given)
    if (one.param == vm::Param::at && one.number.is_constant())
      motions_.check_pace(*place, one.number.code.constant, one.argument->span);
  return {std::move(result)};
}

void Commands::report_no_motion(const ast::Command& command) {
  const auto candidates = names_.motion_names();
  if (command.arguments.empty()) {
    diagnostics_.report(Code::E0505, "this does not say which MOTION to perform")
        .label(command.verb.span)
        .helps(candidates.empty() ? "write a MOTION first: a table of times and positions"
                                  : "MOTIONs: " + list_names(candidates));
    return;
  }
  const ast::Argument& first = command.arguments.front();
  const ast::Word* const word = plain_word(first);
  if (word == nullptr) {
    diagnostics_.report(Code::E0505, "this must be the name of a MOTION").label(first.span);
    return;
  }
  Diagnostic& d = diagnostics_.report(Code::E0501, "there is no MOTION " + word->name.shown())
                      .label(word->name.span);
  d.unknown = word->name.text;
  if (names_.find_define(word->name.text) != nullptr) {
    d.helps(word->name.shown() + " is a DEFINE: write it without PERFORM");
    return;
  }
  did_you_mean(d, word->name.span, word->name.text, candidates);
  if (d.help.empty() && !candidates.empty()) d.helps("MOTIONs: " + list_names(candidates));
}

// AT is the speed, in percent of the MOTION's own; TIMES is how often.
bool Commands::add_to_performance(const Given& given, ir::Command& result) {
  const Span span = given.argument->span;
  const bool is_speed = given.is_number && given.param == vm::Param::at;
  if (!is_speed && (!given.is_number || given.param != vm::Param::times)) {
    diagnostics_.report(Code::E0505, "`PERFORM` does not take this")
        .label(span)
        .helps("it takes AT (how fast) and TIMES (how often): `PERFORM wave AT 150% 2 TIMES`");
    return false;
  }
  if (is_given(result, given.param)) {
    report_twice(span, is_speed ? "`AT`" : "`TIMES`", diagnostics_);
    return false;
  }
  Typed number = given.number;
  const Unit& unit = canonical_unit(is_speed ? vm::Dimension::percent : vm::Dimension::number);
  if (number.is_bare()) take_unit(number, {&unit, "AT of PERFORM", span}, diagnostics_);
  if (!number.is_number()) return false;
  if (number.dimension() != unit.dimension) {
    diagnostics_
        .report(Code::E0301, is_speed ? "the speed of a MOTION is a percentage of its own speed"
                                      : "TIMES is a number without a unit")
        .label(number.span)
        .helps(is_speed ? "write a percentage: `AT 150%` is half as fast again"
                        : "write `2 TIMES`");
    return false;
  }
  const vm::Value value = number.code.constant;
  if (number.is_constant() && (value <= 0 || (!is_speed && value % vm::kScale != 0))) {
    diagnostics_
        .report(Code::E0506, is_speed     ? "AT must be above 0"
                             : value <= 0 ? "TIMES must be above 0"
                                          : "TIMES must be a whole number")
        .label(number.span);
    return false;
  }
  result.arguments.push_back({given.param, std::move(number.code)});
  return true;
}

}  // namespace robosync::compiler
