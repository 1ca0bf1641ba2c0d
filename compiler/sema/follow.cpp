// Part of Statements and Commands: FOLLOW. It becomes a command TO a local, repeated whenever the local
// has changed by MARGIN. Another local holds the last value given; it starts where no actuator can be.
#include <algorithm>
#include <array>
#include <utility>

#include "compiler/config/wiring.hpp"
#include "compiler/sema/statements.hpp"

namespace robosync::compiler {
namespace {

constexpr vm::Value kStepsOfRange = 2000;      // smallest steps of a servo in its range
constexpr vm::Value kNowhere = vm::kValueMin;  // farther from any value than a MARGIN

constexpr std::uint8_t kTakes =
    1u << static_cast<unsigned>(vm::Param::to) | 1u << static_cast<unsigned>(vm::Param::at);

bool knows(const ActuatorConfig& actuator, vm::Param param, bool moving) {
  return std::ranges::any_of(actuator.verbs, [&](const VerbConfig& verb) {
    const bool sets = verb.action == vm::Action::set && !moving;
    return (verb.action == vm::Action::move || sets) && verb.has(param);
  });
}

vm::Value smallest_step(const ActuatorConfig& actuator) {
  const std::int64_t range = std::int64_t{actuator.max} - actuator.min;
  if (range > vm::kValueMax) return 1;
  return std::max<vm::Value>(static_cast<vm::Value>(range / kStepsOfRange), 1);
}

bool same(const Followed& a, const Followed& b) {
  return a.margin == b.margin && a.command.verb == b.command.verb &&
         a.command.arguments == b.command.arguments;
}

// Clamps a value that may be outside the actuator's range.
Expression in_range(Typed number, const ActuatorConfig& actuator) {
  Expression value = std::move(number.code);
  if (number.low < actuator.min)
    value = make_binary(Operation::maximum, std::move(value), make_constant_code(actuator.min));
  if (number.high > actuator.max)
    value = make_binary(Operation::minimum, std::move(value), make_constant_code(actuator.max));
  return value;
}

// The MARGIN of a FOLLOW: a constant difference in the unit of TO.
bool fit_margin(const ActuatorConfig& actuator, Typed& number, Diagnostics& diagnostics) {
  const Unit& unit = param_unit(actuator, vm::Param::to);
  if (number.is_bare())
    take_unit(number, {&unit, "MARGIN for " + actuator.name.text, actuator.name.span, true},
              diagnostics);
  if (number.dimension() != unit.dimension) {
    diagnostics
        .report(Code::E0301, "`MARGIN` is " + std::string(dimension_phrase(unit.dimension)) +
                                 " here, but this is " +
                                 std::string(dimension_phrase(number.dimension())))
        .label(number.span)
        .label(actuator.name.span, "the actuator", false);
    return false;
  }
  make_difference(number);
  if (number.is_constant() && number.code.constant > 0) return true;
  diagnostics
      .report(number.is_constant() ? Code::E0509 : Code::E0305,
              number.is_constant() ? "MARGIN must be above 0"
                                   : "MARGIN must be known before the program runs")
      .label(number.span);
  return false;
}

Expression& target_of(ir::Command& command) {
  return std::ranges::find(command.arguments, vm::Param::to, &ir::Argument::param)->value;
}

}  // namespace

// ---- the command

bool Commands::is_follow(const ast::Command& command) const {
  return same_name(command.verb.text, kFollow) && !names_.is_verb(kFollow);
}

std::optional<Follow> Commands::follow(const ast::Command& command) {
  return follow(command, false);
}

// In a TEST: the commands given, without MARGIN and FOR.
std::vector<ir::Command> Commands::expected_follow(const ast::Command& command) {
  std::vector<ir::Command> commands;
  if (auto follow = this->follow(command, true))
    for (Followed& one : follow->all)
      commands.push_back(std::move(one.command));
  return commands;
}

std::optional<std::vector<Commands::Given>> Commands::evaluate_followed(const ast::Command& command,
                                                                        std::size_t named_by) {
  const bool before = expressions_.set_following(true);
  const ChooseNumber* const choice = expressions_.set_choice(nullptr);
  auto given = evaluate(command, named_by);
  const bool lost = expressions_.has_lost();
  expressions_.set_choice(choice);
  expressions_.set_following(before);
  if (!lost) return given;
  diagnostics_.report(Code::E0407, "the target of this FOLLOW cannot be recalculated all the time")
      .label(command.verb.span)
      .helps("the value given to the DEFINE has more than " + std::to_string(kMostFollowed) +
             " parts, the most that rsc copies, or is a number from a LIST");
  return std::nullopt;
}

std::optional<Follow> Commands::follow(const ast::Command& command, bool expected) {
  chosen_ = nullptr;
  if (first_word(command) == nullptr) {
    diagnostics_.report(Code::E0504, "this does not say which actuator should follow")
        .label(command.verb.span)
        .helps("name the actuator first: `FOLLOW head TO (voice DIRECTION)`");
    return std::nullopt;
  }
  std::size_t named_by = 0;
  const auto target = find_target(command, named_by);
  const auto given = evaluate_followed(command, named_by);
  if (!target || !given || target->actuators.empty()) return std::nullopt;
  const auto is_target = [](const Given& one) {
    return one.is_number && one.param == vm::Param::to;
  };
  if (!expected && std::ranges::none_of(*given, is_target)) {
    diagnostics_.report(Code::E0512, "this does not say what to follow")
        .label(command.verb.span)
        .helps("write it after TO: `FOLLOW " + target->name + " TO (…)`");
    return std::nullopt;
  }
  Follow result;
  for (const Given& one : *given)
    if (one.is_number && one.param == vm::Param::for_ && !lasts(one, result)) return std::nullopt;
  for (const std::size_t actuator : target->actuators) {
    Diagnostics repeated;  // reports notes once for a group
    Diagnostics& here = result.all.empty() ? diagnostics_ : repeated;
    auto one = follow_by(actuator, *given, command.verb, here);
    for (const Diagnostic& d : repeated.all())
      if (d.code != Code::N0002) diagnostics_.report(d.code, d.message) = d;
    if (!one) return std::nullopt;
    result.all.push_back(std::move(*one));
  }
  const auto alike = [&](const Followed& other) { return same(result.all.front(), other); };
  if (!target->group || !std::ranges::all_of(result.all, alike)) return result;
  result.all.front().command.group = target->group;
  result.all.front().command.actuators = target->actuators;
  result.all.resize(1);
  return result;
}

bool Commands::lasts(const Given& given, Follow& result) {
  Typed number = given.number;
  const Unit& unit = canonical_unit(vm::Dimension::duration);
  if (number.is_bare()) take_unit(number, {&unit, "FOR", given.argument->span}, diagnostics_);
  if (number.dimension() != vm::Dimension::duration) {
    diagnostics_
        .report(Code::E0301,
                "`FOR` is a time, but this is " + std::string(dimension_phrase(number.dimension())))
        .label(number.span);
    return false;
  }
  if (number.is_constant() && number.code.constant <= 0) {
    diagnostics_.report(Code::E0509, "FOR must be above 0").label(number.span);
    return false;
  }
  if (result.lasts) {
    diagnostics_.report(Code::E0505, "`FOR` is given twice").label(given.argument->span);
    return false;
  }
  result.lasts = std::move(number.code);
  return true;
}

std::optional<Followed> Commands::follow_by(std::size_t actuator, const std::vector<Given>& given,
                                            const ast::Name& verb, Diagnostics& diagnostics) const {
  const ActuatorConfig& config = robot_.actuators[actuator];
  if (config.to_unit == nullptr || config.shows_numbers() || !knows(config, vm::Param::to, false)) {
    diagnostics.report(Code::E0512, config.name.shown() + " cannot follow")
        .label(verb.span)
        .label(config.name.span, "it has no position to go TO", false);
    return std::nullopt;
  }
  if (config.drive) {
    diagnostics.report(Code::E0512, config.name.shown() + " cannot follow")
        .label(verb.span)
        .label(config.name.span,
               config.encoders ? "it drives one distance after the other"
                               : "it drives by timing: nothing measures where it is",
               false)
        .helps(
            "drive a distance with `DRIVE`; or wire each wheel as a `motor`, whose power can "
            "follow");
    return std::nullopt;
  }
  Followed result;
  result.command.actuators = {actuator};
  result.command.verb = {std::string(kFollow), vm::Action::follow, kTakes};
  for (const Given& one : given)
    if (!add_to_follow(config, one, result, diagnostics)) return std::nullopt;
  if (result.margin == 0) result.margin = smallest_step(config);
  return result;
}

bool Commands::add_to_follow(const ActuatorConfig& actuator, const Given& given, Followed& result,
                             Diagnostics& diagnostics) {
  using ast::Preposition;
  const Span span = given.argument->span;
  const Preposition said = given.argument->preposition;
  if (said == Preposition::for_ && given.is_number) return true;  // lasts()
  const bool speeds = said == Preposition::at && knows(actuator, vm::Param::at, true);
  if (!given.is_number || (said != Preposition::to && said != Preposition::margin && !speeds)) {
    diagnostics.report(Code::E0505, "`FOLLOW` of " + actuator.name.shown() + " does not take this")
        .label(span)
        .helps(knows(actuator, vm::Param::at, true) ? "it takes TO, AT (the speed), MARGIN and FOR"
                                                    : "it takes TO, MARGIN and FOR");
    return false;
  }
  const vm::Param param = said == Preposition::at ? vm::Param::at : vm::Param::to;
  const bool is_margin = said == Preposition::margin;
  const bool twice =
      is_margin ? result.margin != 0
                : std::ranges::count(result.command.arguments, param, &ir::Argument::param) != 0;
  if (twice) {
    diagnostics.report(Code::E0505, "this is given twice").label(span);
    return false;
  }
  Typed number = given.number;
  if (!is_margin) {
    if (!fit_parameter(actuator, param, number, diagnostics, diagnostics)) return false;
    Expression value =
        param == vm::Param::to ? in_range(std::move(number), actuator) : std::move(number.code);
    result.command.arguments.push_back({param, std::move(value)});
    return true;
  }
  if (!fit_margin(actuator, number, diagnostics)) return false;
  result.margin = number.code.constant;
  return true;
}

// ---- the statement

ir::Follow* Statements::endless_follow(ir::Block& block) {
  if (block.empty()) return nullptr;
  auto* const follow = std::get_if<ir::Follow>(&block.back().node);
  return follow != nullptr && !follow->lasts ? follow : nullptr;
}

void Statements::report_never(const ir::Block& block, Span span) {
  diagnostics_.report(Code::E0512, "this is never reached: the FOLLOW before it never ends")
      .label(span)
      .label(block.back().span, "it runs as long as its response does", false)
      .helps("move it before the FOLLOW, or limit the FOLLOW with FOR");
}

void Statements::put_first(ir::Local local, Span span, ir::Block& result) {
  if (endless_follow(result) == nullptr) return put(std::move(local), span, result);
  ir::Statement follow = std::move(result.back());
  result.pop_back();
  put(std::move(local), span, result);
  result.push_back(std::move(follow));
}

// Consecutive FOLLOWs run together; the FOR of the last one ends them all.
void Statements::follow(const ast::Command& node, Span span, ir::Block& result) {
  auto follow = commands_.follow(node);
  if (!follow) return;
  for (Followed& one : follow->all)
    if (!expressions_.stands_still(target_of(one.command), span, "the target of a FOLLOW")) return;
  if (endless_follow(result) == nullptr) put(ir::Follow{}, span, result);
  ir::Statement together = std::move(result.back());
  result.pop_back();
  auto& made = std::get<ir::Follow>(together.node);
  made.lasts = std::move(follow->lasts);
  for (Followed& one : follow->all)
    add_followed(std::move(one), span, result, made.body);
  result.push_back(std::move(together));
}

void Statements::add_followed(Followed followed, Span span, ir::Block& before, ir::Block& body) {
  const std::size_t target = locals_++, given = locals_++;
  Expression& to = target_of(followed.command);
  put(ir::Local{given, make_constant_code(kNowhere), true}, span, before);
  put(ir::Local{target, std::exchange(to, make_local(target))}, span, body);
  Expression change = make_unary(
      Operation::absolute, make_binary(Operation::subtract, make_local(target), make_local(given)));
  ir::If changed{
      make_binary(Operation::greater_equal, std::move(change), make_constant_code(followed.margin)),
      {},
      {}};
  put(std::move(followed.command), span, changed.then_block);
  put(ir::Local{given, make_local(target), true}, span, changed.then_block);
  put(std::move(changed), span, body);
}

}  // namespace robosync::compiler
