// Expressions with what is known about them during checking, and the rules for units.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/ir/program.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {

enum class Type : std::uint8_t {
  nothing,  // has a mistake, which has been reported: no more messages
  condition,
  number,
  word  // one of several labels: a STATE, a CHECK, or a channel of words
};

struct Typed {
  Type type = Type::nothing;
  Expression code;
  Span span;
  // For a number. Without a unit it is a bare constant, which takes the unit of the number it is combined with.
  const Unit* unit = nullptr;
  Span unit_span;                    // where the unit is written
  std::string source;                // what has this unit: "touch LEVEL", or empty
  Decimal bare;                      // the exact constant, if there is no unit
  std::string digits;                // as written, if it is a literal
  std::int64_t low = vm::kValueMin;  // its range
  std::int64_t high = vm::kValueMax;
  // For a word: its labels, which outlive this. Its code is the index of the label.
  const std::vector<std::string>* labels = nullptr;
  bool truth = false;  // its second label means true, so it may be a condition

  [[nodiscard]] bool is_number() const { return type == Type::number; }
  [[nodiscard]] bool is_bare() const { return is_number() && unit == nullptr; }
  [[nodiscard]] bool is_constant() const { return code.operation == Operation::constant; }
  [[nodiscard]] vm::Dimension dimension() const {
    return unit == nullptr ? vm::Dimension::number : unit->dimension;
  }
};

[[nodiscard]] Typed make_constant(vm::Value value, const Unit& unit, Span span);
[[nodiscard]] Typed make_nothing(Span span);
[[nodiscard]] Typed make_condition(Expression code, Span span);
[[nodiscard]] Expression make_constant_code(vm::Value value);
[[nodiscard]] Expression make_local(std::size_t number);
[[nodiscard]] Expression make_unary(Operation operation, Expression operand);
[[nodiscard]] Expression make_binary(Operation operation, Expression left, Expression right);

// A quantity that is required elsewhere, by its unit.
struct Wanted {
  const Unit* unit = nullptr;
  std::string source;       // what requires it: "touch LEVEL", "TO of left_arm"
  Span unit_span;           // where the unit is written
  bool difference = false;  // added or subtracted, not compared: offsets of units do not apply
  bool remembered = false;  // its unit is that of the value it starts with
};

// How a plain number becomes one with a unit, or the other way round. Nothing for a literal, which just takes another unit.
void help_with_unit(Diagnostic& diagnostic, const Typed& number, const Unit& wanted);

// Gives a bare constant the wanted unit, with a note if it is a real unit (N0002).
void take_unit(Typed& number, const Wanted& wanted, Diagnostics& diagnostics);

// Notes the rounded value of a number written with more digits than the robot keeps (N0005).
void note_rounded(Decimal number, vm::Value value, const Unit& unit, Span span,
                  Diagnostics& diagnostics);

// Makes a literal a difference: 9F more is 5C more, whatever the offsets of the scales.
void make_difference(Typed& number);

// Brings both to one dimension. Reports E0301 and returns false if they differ;
// `doing` describes the operation: "compares {} with {}".
[[nodiscard]] bool unify(Typed& left, Typed& right, std::string_view doing, bool difference,
                         Diagnostics& diagnostics);

// Reports "this multiplies a distance by a force", with both places.
Diagnostic& report_mismatch(const Typed& left, const Typed& right, std::string_view doing,
                            Diagnostics& diagnostics);

// ---- a temperature in F is a point on a scale with an offset; a difference of two has no offset

[[nodiscard]] bool is_point(const Typed& number);
[[nodiscard]] bool is_difference(const Typed& number);

// Reports that this calculation cannot use a point. True if it is one.
[[nodiscard]] bool report_point(const Typed& number, Diagnostics& diagnostics);

// False, and reported, if a difference is wanted and this is a point, or the other way round. A literal becomes a difference.
[[nodiscard]] bool fits_scale(Typed& number, const Wanted& wanted, Diagnostics& diagnostics);

// A comparison: two points or two differences. A literal becomes what the other side is.
[[nodiscard]] bool unify_scales(Typed& left, Typed& right, std::string_view doing,
                                Diagnostics& diagnostics);

// The unit of a sum or difference of two numbers of one dimension: a point and a difference make a point, two points only a
// difference. A literal is a difference, except in front of a minus. nullptr: reported.
[[nodiscard]] const Unit* unify_sum(Typed& left, Typed& right, bool subtracts,
                                    std::string_view doing, Diagnostics& diagnostics);

}  // namespace robosync::compiler
