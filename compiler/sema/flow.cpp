// IF, REPEAT and PICK ONE.
#include <algorithm>

#include "compiler/sema/statements.hpp"

namespace robosync::compiler {
namespace {

// Does every turn of the loop end by itself, or give up the processor?
bool is_bounded(const ProgramRepeat& loop) {
  const bool counted =
      loop.kind == RepeatKind::times && loop.control.operation == Operation::constant;
  return counted || std::any_of(loop.body.begin(), loop.body.end(), is_pause);
}

}  // namespace

void Statements::add(const ast::If& node, Span span, ProgramBlock& result) {
  ProgramIf choice;
  Typed condition = node.condition ? expressions_.condition(*node.condition) : Typed{};
  choice.condition = std::move(condition.code);
  choice.then_block = block(node.then_block);
  choice.else_block = block(node.else_block);
  if (condition.type == Type::condition) put(std::move(choice), span, result);
}

void Statements::add(const ast::Repeat& node, Span span, ProgramBlock& result) {
  ProgramRepeat loop;
  const std::size_t errors = diagnostics_.errors();
  bool good = true;
  if (node.times != nullptr) {
    good = repeat_times(*node.times, loop);
  } else if (node.condition != nullptr) {
    loop.kind = RepeatKind::while_;
    Typed condition = expressions_.condition(*node.condition);
    good = condition.type == Type::condition;
    loop.control = std::move(condition.code);
  } else {
    loop.kind = RepeatKind::forever;
  }
  loop.body = block(node.body);
  if (!good || diagnostics_.errors() > errors) return;  // a WAIT may be among what is wrong
  if (!is_bounded(loop)) {
    diagnostics_.report(Code::E0403, "this loop never waits, so it would hold the robot up")
        .label({span.file, span.begin, node.body.empty() ? span.end : node.body.front().span.begin})
        .helps("put a WAIT, a WAIT UNTIL or a THEN into it, not inside of an IF");
    return;
  }
  put(std::move(loop), span, result);
}

bool Statements::repeat_times(const ast::Expr& times, ProgramRepeat& result) {
  result.kind = RepeatKind::times;
  Typed count =
      expressions_.amount(times, {&canonical_unit(vm::Dimension::number), "TIMES", times.span});
  if (!count.is_number()) return false;
  result.control = std::move(count.code);
  if (result.control.operation != Operation::constant) return true;
  const vm::Value value = result.control.constant;
  if (value > 0 && value % vm::kScale == 0) return true;
  diagnostics_
      .report(Code::E0509, value > 0 ? "TIMES counts in whole numbers" : "TIMES must be above 0")
      .label(times.span);
  return false;
}

void Statements::add(const ast::PickOne& node, Span span, ProgramBlock& result) {
  ProgramPick pick;
  std::int64_t sum = 0;
  bool good = true;
  const auto has_weight = [](const ast::Option& option) { return option.weight != nullptr; };
  const bool weighted = std::any_of(node.options.begin(), node.options.end(), has_weight);
  for (const ast::Option& option : node.options) {
    ProgramOption made{vm::kScale, block(option.body)};
    if (option.weight != nullptr) {
      const auto value = weight(*option.weight);
      good = good && value;
      made.weight = value.value_or(vm::kScale);
    } else if (weighted) {
      diagnostics_.report(Code::E0509, "the other options have a weight, and this one has none")
          .label(option.span)
          .helps("give all of them one, or none");
      good = false;
    }
    sum += made.weight;
    pick.options.push_back(std::move(made));
  }
  if (good && sum > vm::kValueMax)
    diagnostics_.report(Code::E0304, "the weights of these options are too large together")
        .label(span);
  else if (good && !pick.options.empty())
    put(std::move(pick), span, result);
}

// A plain number or a percentage; only the shares count.
std::optional<vm::Value> Statements::weight(const ast::Expr& expr) {
  const auto value = expressions_.constant(expr, "the weight of an OPTION");
  if (!value) return std::nullopt;
  const vm::Dimension dimension = value->dimension();
  if (dimension != vm::Dimension::number && dimension != vm::Dimension::percent) {
    diagnostics_
        .report(Code::E0301, "the weight of an OPTION is a percentage, and this is " +
                                 std::string(dimension_phrase(dimension)))
        .label(expr.span);
    return std::nullopt;
  }
  if (value->code.constant > 0) return value->code.constant;
  diagnostics_.report(Code::E0509, "the weight of an OPTION must be above 0").label(expr.span);
  return std::nullopt;
}

}  // namespace robosync::compiler
