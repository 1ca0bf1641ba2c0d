#include "compiler/sema/motions.hpp"

#include <algorithm>

#include "compiler/config/wiring.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMostRows = 255;

// True if the actuator has a verb that moves or sets it, with TO and OVER.
bool follows_keys(const ActuatorConfig& actuator) {
  return actuator.to_unit != nullptr &&
         std::ranges::any_of(actuator.verbs, [](const VerbConfig& verb) {
           return (verb.action == vm::Action::move || verb.action == vm::Action::set) &&
                  verb.has(vm::Param::to) && verb.has(vm::Param::over);
         });
}

}  // namespace

std::optional<std::size_t> Motions::find(const ast::Name& name) {
  MotionName* const known = names_.find_motion(name.text);
  if (known == nullptr) return std::nullopt;
  if (known->seen) return known->place;
  known->seen = true;
  const std::size_t reported = diagnostics_.all().size();
  if (auto motion = translate(*known->motion)) {
    known->place = motions_.size();
    motions_.push_back(std::move(*motion));
  } else if (known->in_module) {
    diagnostics_.found_from(name.span, name.shown() + " needs it", reported);
  }
  return known->place;
}

void Motions::check_unused() {
  for (const auto& [folded, known] : names_.motions())
    if (!known.in_module && !known.seen) (void)translate(*known.motion);
}

std::optional<ir::Motion> Motions::translate(const ast::Motion& motion) {
  ir::Motion result{std::string(motion.name.text), 0, {}};
  std::vector<std::vector<std::size_t>> columns;  // indices into result.tracks
  if (!add_columns(motion, columns, result)) return std::nullopt;
  if (motion.rows.size() > kMostRows) {
    diagnostics_
        .report(Code::E0407, "a MOTION can have " + std::to_string(kMostRows) + " rows, but " +
                                 motion.name.shown() + " has " + std::to_string(motion.rows.size()))
        .label(motion.name.span);
    return std::nullopt;
  }
  for (const ast::MotionRow& row : motion.rows)
    if (!add_row(motion, row, columns, result)) return std::nullopt;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!result.tracks[columns[i].front()].keys.empty()) continue;
    diagnostics_.report(Code::E0511, "this MOTION has no value for " + motion.columns[i].shown())
        .label(motion.columns[i].span, "its column is empty");
    return std::nullopt;
  }
  return result;
}

bool Motions::add_columns(const ast::Motion& motion, std::vector<std::vector<std::size_t>>& columns,
                          ir::Motion& result) {
  for (const ast::Name& column : motion.columns) {
    const auto target = names_.find_target(column.text);
    if (!target) {
      Diagnostic& d = diagnostics_.report(Code::E0501, "there is no actuator " + column.shown())
                          .label(column.span);
      if (!diagnostics_.may_search(robot_.actuators.size() + robot_.groups.size())) return false;
      const auto candidates = names_.target_names();
      did_you_mean(d, column.span, column.text, candidates);
      names_.doubt_group(d, column.text);
      if (d.help.empty()) d.helps("actuators: " + list_names(candidates));
      return false;
    }
    if (target->actuators.empty()) return false;
    columns.emplace_back();
    for (const std::size_t actuator : target->actuators) {
      if (!can_move(actuator, column)) return false;
      if (std::ranges::find(result.tracks, actuator, &ir::Track::actuator) != result.tracks.end()) {
        diagnostics_
            .report(Code::E0511, robot_.actuators[actuator].name.shown() + " has two columns")
            .label(column.span, "here it is again");
        return false;
      }
      columns.back().push_back(result.tracks.size());
      result.tracks.push_back({actuator, {}});
    }
  }
  return true;
}

bool Motions::can_move(std::size_t actuator, const ast::Name& column) {
  const ActuatorConfig& config = robot_.actuators[actuator];
  if (follows_keys(config)) return true;
  diagnostics_.report(Code::E0511, config.name.shown() + " cannot be part of a MOTION")
      .label(column.span)
      .label(config.name.span, "it has no verb with TO and OVER", false);
  return false;
}

// Rows must be in time order, and far enough apart for actuators to follow.
std::optional<vm::Value> Motions::time_of(const ast::MotionRow& row, vm::Value after) {
  const auto time = expressions_.constant_amount(
      *row.time, {&canonical_unit(vm::Dimension::duration), "AT", row.time->span});
  if (!time) return std::nullopt;
  const vm::Value value = time->code.constant;
  if (after < 0 || value >= after + static_cast<vm::Value>(vm::kMinKeyGapMs)) return value;
  const std::string least = std::to_string(vm::kMinKeyGapMs) + "ms";
  diagnostics_
      .report(Code::E0510, value <= after
                               ? std::string("this row is not later than the one above it")
                               : "this row is less than " + least + " after the one above it")
      .label(row.time->span)
      .helps("times count from the start of the MOTION, and rows must be at least " + least +
             " apart");
  return std::nullopt;
}

// `AT 300ms -20 deg`
bool Motions::has_unit_apart(const ast::MotionRow& row) {
  for (std::size_t i = 1; i < row.keys.size(); ++i) {
    const ast::Expr* number = row.keys[i - 1].value.get();
    const auto* const sign = number != nullptr ? std::get_if<ast::Negate>(&number->node) : nullptr;
    if (sign != nullptr) number = sign->value.get();
    const ast::Expr* const after = row.keys[i].value.get();
    if (number == nullptr || after == nullptr) continue;
    const auto* const quantity = std::get_if<ast::Quantity>(&number->node);
    const auto* const unit = std::get_if<ast::Operand>(&after->node);
    if (quantity == nullptr || !quantity->unit.empty() || unit == nullptr ||
        find_unit(unit->name.text) == nullptr)
      continue;
    diagnostics_.report(Code::E0505, "a unit follows its number without a space")
        .label({after->span.file, row.keys[i - 1].span.begin, after->span.end})
        .helps("write `" +
               std::string(sign != nullptr ? "-" : "")
                   .append(quantity->digits)
                   .append(unit->name.text) +
               "`");
    return true;
  }
  return false;
}

bool Motions::add_row(const ast::Motion& motion, const ast::MotionRow& row,
                      const std::vector<std::vector<std::size_t>>& columns, ir::Motion& result) {
  if (row.keys.size() != columns.size()) {
    if (has_unit_apart(row)) return false;
    const auto counted = [](std::size_t count, const std::string& what) {
      return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
    };
    diagnostics_
        .report(Code::E0511, "this row has " + counted(row.keys.size(), "value") + " for " +
                                 counted(columns.size(), "actuator"))
        .label(row.span)
        .label(motion.name.span, "the columns are named here", false)
        .helps("write `-` where an actuator is between two values");
    return false;
  }
  const bool first = &row == &motion.rows.front();
  const auto time = time_of(row, first ? -1 : result.length);
  if (!time) return false;
  result.length = *time;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (row.keys[i].value == nullptr) continue;
    for (const std::size_t track : columns[i])
      if (!add_key(row.keys[i], *time, result.tracks[track])) return false;
  }
  return true;
}

namespace {

bool is_late(const vm::Key& from, const vm::Key& to, std::int64_t limit) {
  const std::int64_t way = std::abs(std::int64_t{to.to} - from.to);
  return way * vm::kScale > (std::int64_t{to.time} - from.time) * limit;
}

// It speeds up from a standstill, and slows down to one, in `time` milliseconds.
bool is_late_with_ramps(const vm::Key& from, const vm::Key& to, std::int64_t time,
                        const ActuatorConfig& actuator) {
  if (actuator.acceleration == 0) return false;
  const std::int64_t way = std::abs(std::int64_t{to.to} - from.to);
  const std::int64_t acceleration =
      actuator.acceleration;  // thousandths per second, in a millisecond
  const std::int64_t fastest =
      std::min<std::int64_t>(actuator.speed_limit, acceleration * time / 2);
  return way * vm::kScale > fastest * time - fastest * fastest / acceleration;
}

}  // namespace

bool Motions::add_key(const ast::MotionKey& key, vm::Value time, ir::Track& track) {
  const ActuatorConfig& actuator = robot_.actuators[track.actuator];
  auto number = expressions_.constant(*key.value, "a value of a MOTION");
  if (!number) return false;
  number = expressions_.number_of(std::move(*number));
  if (!number->is_number()) return false;
  Diagnostics said_before;  // notes the unit of bare numbers once per column
  Diagnostics& notes = track.keys.empty() ? diagnostics_ : said_before;
  if (!fit_parameter(actuator, vm::Param::to, *number, notes, diagnostics_)) return false;
  const vm::Key made{time, number->code.constant};
  if (!track.keys.empty()) {
    const vm::Key& before = track.keys.back();
    const bool late = is_late(before, made, actuator.speed_limit);
    if (late || is_late_with_ramps(before, made, made.time - before.time, actuator))
      report_late(actuator, "here late", !late, key.span);
  }
  track.keys.push_back(made);
  return true;
}

// The actuator moves at its limits and arrives later than the table says. `ramps`: because of its acceleration.
void Motions::report_late(const ActuatorConfig& actuator, const std::string& where, bool ramps,
                          Span span) {
  const Unit& unit = param_unit(actuator, vm::Param::at);
  const std::string why =
      ramps ? "it stops at each row, and speeds up by no more than " +
                  format_acceleration(actuator.acceleration, unit)
            : "it goes no faster than " + format_value(actuator.speed_limit, unit);
  diagnostics_.report(Code::N0004, actuator.name.shown() + " arrives " + where + ": " + why)
      .label(span)
      .label(ramps ? actuator.acceleration_span : actuator.limit_span, "the limit", false);
}

void Motions::check_pace(std::size_t place, vm::Value pace, Span span) {
  constexpr std::int64_t kAsWritten = std::int64_t{100} * vm::kScale;
  if (pace <= kAsWritten) return;
  for (const ir::Track& track : motions_[place].tracks) {
    const ActuatorConfig& actuator = robot_.actuators[track.actuator];
    const std::int64_t share = (actuator.speed_limit * kAsWritten + pace - 1) / pace;
    const auto late = [&](const vm::Key& from, const vm::Key& to) {
      return is_late(from, to, share) && !is_late(from, to, actuator.speed_limit);
    };
    if (std::ranges::adjacent_find(track.keys, late) != track.keys.end())
      return report_late(actuator, "late at this pace", false, span);
    const auto slow = [&](const vm::Key& from, const vm::Key& to) {
      const std::int64_t time = to.time - from.time;
      return is_late_with_ramps(from, to, time * kAsWritten / pace, actuator) &&
             !is_late_with_ramps(from, to, time, actuator) &&
             !is_late(from, to, actuator.speed_limit);
    };
    if (std::ranges::adjacent_find(track.keys, slow) != track.keys.end())
      return report_late(actuator, "late at this pace", true, span);
  }
}

}  // namespace robosync::compiler
