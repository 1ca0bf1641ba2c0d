#include "compiler/sema/variables.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/sema/lints.hpp"
#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

constexpr double kFadeOne = 2147483648.0;  // 2^31, the scale of vm::Variable::fade
constexpr double kLeft = 0.05;             // part of the distance left after FADES … OVER
constexpr double kTick = vm::kFadeTickMs;  // a duration counts milliseconds, too

// At least 1: 0 would mean that it does not fade at all.
std::uint32_t fade_factor(vm::Value over) {
  const double factor = std::round(kFadeOne * std::pow(kLeft, kTick / over));
  return static_cast<std::uint32_t>(std::clamp(factor, 1.0, kFadeOne - 1));
}

}  // namespace

void Variables::declare(ir::Program& program) {
  for (VariableName& name : names_.variables()) {
    ir::Variable result;
    result.name = name.name.text;
    result.kind = name.kind;
    result.labels = name.labels;
    if (const auto* node = std::get_if<const ast::Remember*>(&name.declared))
      declare(**node, name, result);
    if (const auto* node = std::get_if<const ast::State*>(&name.declared))
      declare(**node, name, result);
    if (std::holds_alternative<const ast::Timer*>(name.declared)) declare_timer(name);
    if (const auto* node = std::get_if<const ast::Feeling*>(&name.declared))
      declare(**node, name, result);
    if (name.unit != nullptr) result.dimension = name.unit->dimension;
    result.unit = name.unit;
    program.variables.push_back(std::move(result));
  }
  check_kept();
  for (VariableName& name : names_.variables())
    name.ready = name.kind != vm::VariableKind::band;
  for (VariableName& name : names_.variables())
    if (const auto* node = std::get_if<const ast::Check*>(&name.declared))
      declare(**node, name, program);
  for (VariableName& name : names_.variables())
    name.ready = true;
}

void Variables::declare(const ast::Remember& node, VariableName& name, ir::Variable& result) {
  name.unit = &canonical_unit(vm::Dimension::number);
  name.unit_span = node.name.span;
  if (node.value == nullptr) return;
  const auto value = expressions_.constant(*node.value, "the first value of a REMEMBER");
  name.taken = name.taken || !value;
  if (!value) return;
  result.initial = value->code.constant;
  if (name.kind == vm::VariableKind::plain && !names_.is_set(name)) name.fixed = result.initial;
  if (value->is_bare()) return;
  name.unit = value->unit;
  name.unit_span = value->unit_span;
}

// A KEPT value is found again by its name, in any behaviour.
void Variables::check_kept() {
  NameIndex kept;
  std::vector<Span> places;
  for (const VariableName& name : names_.variables()) {
    if (name.kind != vm::VariableKind::kept) continue;
    const VariableName* global = names_.find_variable(name.name.text);
    if (global != nullptr && global->index != name.index) continue;  // reported elsewhere
    const Span place = name.name.span;
    if (!kept.add(name.name.text, places.size())) {
      diagnostics_.report(Code::E0101, "there is another KEPT " + name.name.shown())
          .label(place)
          .label(places[*kept.find(name.name.text)], "the first one", false)
          .helps("kept values are found by their names: rename one of them");
    }
    places.push_back(place);
  }
  if (places.size() <= vm::kMaxKept) return;
  diagnostics_
      .report(Code::E0407, "the program has " + std::to_string(places.size()) +
                               " KEPT numbers; the limit is " + std::to_string(vm::kMaxKept))
      .label(places[vm::kMaxKept], "this is one too many")
      .helps("use KEPT only for what must survive a power-off");
}

void Variables::declare(const ast::State& node, VariableName& name, ir::Variable& result) {
  check_labels(node.labels);
  name.unit = &canonical_unit(vm::Dimension::number);
  result.min = 0;
  result.max = label_value(std::max<std::size_t>(node.labels.size(), 1) - 1);
}

void Variables::declare_timer(VariableName& name) {
  name.unit = &canonical_unit(vm::Dimension::duration);
  name.unit_span = name.name.span;
  name.low = 0;
}

void Variables::check_labels(const std::vector<ast::Name>& labels) {
  NameIndex known;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const ast::Name& label = labels[i];
    if (known.add(label.text, i) || label.text.empty()) continue;
    diagnostics_.report(Code::E0101, "the label " + label.shown() + " is given twice")
        .label(label.span)
        .label(labels[*known.find(label.text)].span, "first given here", false);
  }
}

// All its numbers have one dimension: that of the first one with a unit.
void Variables::declare(const ast::Feeling& node, VariableName& name, ir::Variable& result) {
  name.unit = &canonical_unit(vm::Dimension::number);
  name.unit_span = node.name.span;
  if (!node.from || !node.to || !node.start) return;
  for (const auto* part : {&node.from, &node.to, &node.start}) {
    const auto value = expressions_.constant(**part, "the range of a FEELING");
    if (!value) return;
    if (value->is_bare()) continue;
    name.unit = value->unit;
    name.unit_span = value->unit_span;
    break;
  }
  const Wanted wanted{name.unit, std::string(node.name.text), name.unit_span};
  const auto from = expressions_.constant_amount(*node.from, wanted);
  const auto to = expressions_.constant_amount(*node.to, wanted);
  if (!from || !to) return;
  if (from->code.constant >= to->code.constant) {
    diagnostics_.report(Code::E0509, "a FEELING takes the smaller number first")
        .label(node.to->span)
        .label(node.from->span, "not above this", false);
    return;
  }
  result.min = from->code.constant;
  result.max = to->code.constant;
  name.low = result.min;
  name.high = result.max;
  result.initial = inside(*node.start, wanted, result).value_or(result.min);
  if (node.fades_to && node.fades_over) fade(node, wanted, result);
}

void Variables::fade(const ast::Feeling& node, const Wanted& wanted, ir::Variable& result) {
  const auto target = inside(*node.fades_to, wanted, result);
  const auto over = expressions_.constant_duration(*node.fades_over, "OVER");
  if (!target || !over) return;
  result.fades_to = *target;
  result.fade = fade_factor(*over);
}

std::optional<vm::Value> Variables::inside(const ast::Expr& expr, const Wanted& wanted,
                                           const ir::Variable& feeling) {
  const auto value = expressions_.constant_amount(expr, wanted);
  if (!value) return std::nullopt;
  const vm::Value number = value->code.constant;
  if (number >= feeling.min && number <= feeling.max) return number;
  diagnostics_
      .report(Code::E0509, "`" + feeling.name + "` goes from " +
                               format_value(feeling.min, *wanted.unit) + " to " +
                               format_value(feeling.max, *wanted.unit))
      .label(expr.span, "outside that range");
  return std::nullopt;
}

// ---- CHECK
//
// CHECK: the bands of a number.
//
// The first band that contains the value is the result. A band keeps a value that is up to MARGIN outside
// its written limits, but never one that belongs to an earlier band: an earlier band is entered
// at the number written for it. OTHERWISE has no limits of its own; it has the values that the others
// leave.

namespace {

constexpr std::size_t kMostBands = UINT8_MAX;  // in an image
constexpr std::uint16_t kFedPeriodMs = 20;     // for a sensor without a period of its own

void hold_nothing(vm::Band& band) {
  band.stay_low = vm::kValueMax;
  band.stay_high = vm::kValueMin;
}

// Removes the end of the range that `other` covers. False if `other` covers the middle, or all of it.
bool cut(const vm::Band& other, vm::Value& low, vm::Value& high) {
  if (other.high < low || other.low > high) return true;
  const bool at_bottom = other.low <= low;
  const bool at_top = other.high >= high;
  if (at_bottom == at_top) return false;
  if (at_bottom)
    low = vm::add(other.high, 1);
  else
    high = vm::subtract(other.low, 1);
  return true;
}

// Removes the values of earlier bands from a band. If that does not leave a single range, the band
// cannot keep any value.
void give_way(const std::vector<vm::Band>& earlier, vm::Band& band) {
  for (const vm::Band& other : earlier) {
    const bool one_range = cut(other, band.low, band.high);
    const bool holds = band.stay_low <= band.stay_high;
    if (holds && (!one_range || !cut(other, band.stay_low, band.stay_high))) hold_nothing(band);
  }
}

// Only a sampled sensor has a rate that could be lower, not a fed one or another kind of value.
bool has_rate(const Typed& input, const Names& names) {
  return input.code.operation == Operation::input &&
         names.channel(input.code.channel).period_ms != 0;
}

std::uint16_t sample_period(const Typed& input, const Names& names) {
  if (input.code.operation != Operation::input) return vm::kFadeTickMs;
  const std::uint16_t period = names.channel(input.code.channel).period_ms;
  return period == 0 ? kFedPeriodMs : period;
}

}  // namespace

void Variables::declare(const ast::Check& node, VariableName& name, ir::Program& program) {
  name.unit = &canonical_unit(vm::Dimension::number);
  ir::Variable& variable = program.variables[name.index];
  variable.initial = vm::kUnknown;
  variable.min = 0;
  variable.max = label_value(std::max<std::size_t>(node.bands.size(), 1) - 1);
  std::vector<ast::Name> labels;
  for (const ast::Band& band : node.bands)
    labels.push_back(band.label);
  check_labels(labels);
  const Typed number = input(node);
  if (!number.is_number()) return;
  Wanted wanted{number.unit, number.source, number.unit_span};
  vm::Value margin = 0;
  if (node.margin) {
    Wanted difference = wanted;
    difference.difference = true;
    const auto value = expressions_.constant_amount(*node.margin, difference);
    if (value && value->code.constant <= 0)
      diagnostics_.report(Code::E0509, "MARGIN must be above 0").label(node.margin->span);
    else if (value)
      margin = value->code.constant;
  }
  ir::Check check;
  check.variable = name.index;
  check.input = number.code;
  check.sample_ms = sample_period(number, names_);
  if (node.smooth) smooth(node, number, check);
  for (const ast::Band& part : node.bands) {
    auto made = band(part, wanted, margin);
    if (!made) return;
    // More bands than an image holds are rejected, so their ranges do not matter.
    if (check.bands.size() < kMostBands) give_way(check.bands, *made);
    check.bands.push_back(*made);
  }
  if (check.bands.size() <= kMostBands) lint_bands(node, check, number, diagnostics_);
  program.checks.push_back(std::move(check));
}

Typed Variables::input(const ast::Check& node) {
  if (!node.operand) return {};
  const auto* operand = std::get_if<ast::Operand>(&node.operand->node);
  const VariableName* variable =
      operand != nullptr && !operand->channel ? names_.find_variable(operand->name.text) : nullptr;
  if (variable != nullptr && variable->kind == vm::VariableKind::band) {
    diagnostics_.report(Code::E0306, "a CHECK cannot check another CHECK")
        .label(node.operand->span)
        .helps("it checks a sensor, a FEELING or a REMEMBER with a number");
    return make_nothing(node.operand->span);
  }
  Typed result = expressions_.any(*node.operand);
  if (!expressions_.stands_still(result.code, node.operand->span, "a CHECK"))
    return make_nothing(node.operand->span);
  const bool good = result.is_number() && (result.code.operation == Operation::input ||
                                           result.code.operation == Operation::variable);
  if (good || result.type == Type::nothing) return result;
  diagnostics_.report(Code::E0306, "a CHECK needs a sensor, a FEELING or a REMEMBER with a number")
      .label(node.operand->span);
  return make_nothing(node.operand->span);
}

std::optional<vm::Band> Variables::band(const ast::Band& node, const Wanted& wanted,
                                        vm::Value margin) {
  vm::Band band{vm::kValueMin, vm::kValueMax, vm::kValueMin, vm::kValueMax};
  if (node.kind == ast::BandKind::otherwise) return band;
  if (node.low) {
    const auto low = expressions_.constant_amount(*node.low, wanted);
    if (!low) return std::nullopt;
    const bool above = node.kind == ast::BandKind::above;
    band.low = above ? vm::add(low->code.constant, 1) : low->code.constant;
    band.stay_low = margin == 0 ? band.low : vm::subtract(low->code.constant, margin);
  }
  if (node.high) {
    const auto high = expressions_.constant_amount(*node.high, wanted);
    if (!high) return std::nullopt;
    const bool below = node.kind == ast::BandKind::below;
    band.high = below ? vm::subtract(high->code.constant, 1) : high->code.constant;
    band.stay_high = margin == 0 ? band.high : vm::add(high->code.constant, margin);
  }
  if (band.low <= band.high) return band;
  diagnostics_.report(Code::E0509, "BETWEEN takes the smaller number first").label(node.span);
  return std::nullopt;
}

void Variables::smooth(const ast::Check& node, const Typed& input, ir::Check& result) {
  const auto over = expressions_.constant_duration(*node.smooth, "SMOOTH OVER");
  if (!over) return;
  const std::int64_t period = result.sample_ms;  // a duration counts milliseconds, too
  const std::int64_t window = std::max<std::int64_t>((*over + period / 2) / period, 1);
  if (window <= vm::kMaxWindow) {
    result.window = static_cast<std::uint16_t>(window);
    return;
  }
  const Unit& second = canonical_unit(vm::Dimension::duration);
  diagnostics_
      .report(Code::E0509, "SMOOTH can use at most " + std::to_string(vm::kMaxWindow) +
                               " samples, but this is " + std::to_string(window))
      .label(node.smooth->span)
      .label(input.span, "a sample every " + std::to_string(period) + "ms", false)
      .helps("smooth over at most " + format_value(period * vm::kMaxWindow, second) +
             (has_rate(input, names_) ? ", or give the sensor a lower rate" : ""));
}

}  // namespace robosync::compiler
