// Checks MOTIONs: tables of key frames with a column for each actuator or group and a row for each time.
#pragma once

#include "compiler/sema/expressions.hpp"
#include "compiler/sema/names.hpp"

namespace robosync::compiler {

inline constexpr std::string_view kPerform = "PERFORM";  // the verb; a word of RSL, not a keyword

// Checks a number for a parameter of `actuator` and reports what is wrong. Gives a bare number its unit
// (that note goes to `notes`). `verb` is the verb it is for, if that matters.
[[nodiscard]] bool fit_parameter(const ActuatorConfig& actuator, vm::Param param, Typed& number,
                                 Diagnostics& notes, Diagnostics& diagnostics,
                                 const VerbConfig* verb = nullptr);

// For the name of a MOTION in place of a DEFINE or a verb.
void suggest_perform(Diagnostic& diagnostic, const ast::Name& motion);

class Motions {
public:
  Motions(const Robot& robot, Names& names, Expressions& expressions, Diagnostics& diagnostics)
      : robot_(robot), names_(names), expressions_(expressions), diagnostics_(diagnostics) {}

  // The index of the MOTION in performed(). Nothing when no MOTION has the name, or when it has a
  // mistake, which has been reported.
  [[nodiscard]] std::optional<std::size_t> find(const ast::Name& name);
  [[nodiscard]] const ir::Motion& at(std::size_t place) const { return motions_[place]; }

  // The MOTIONs that find() has found so far, in that order.
  [[nodiscard]] const std::vector<ir::Motion>& performed() const { return motions_; }
  // Reports (N0004) if the MOTION at `place` is on time as written but late at `pace`, in percent.
  void check_pace(std::size_t place, vm::Value pace, Span span);
  // Checks the other MOTIONs; those of modules need not fit the robot.
  void check_unused();

private:
  std::optional<ir::Motion> translate(const ast::Motion& motion);
  bool add_columns(const ast::Motion& motion, std::vector<std::vector<std::size_t>>& columns,
                   ir::Motion& result);
  bool can_move(std::size_t actuator, const ast::Name& column);
  std::optional<vm::Value> time_of(const ast::MotionRow& row, vm::Value after);
  bool has_unit_apart(const ast::MotionRow& row);
  bool add_row(const ast::Motion& motion, const ast::MotionRow& row,
               const std::vector<std::vector<std::size_t>>& columns, ir::Motion& result);
  bool add_key(const ast::MotionKey& key, vm::Value time, ir::Track& track);
  void report_late(const ActuatorConfig& actuator, const std::string& where, bool ramps, Span span);

  const Robot& robot_;
  Names& names_;
  Expressions& expressions_;
  Diagnostics& diagnostics_;
  std::vector<ir::Motion> motions_;
};

}  // namespace robosync::compiler
