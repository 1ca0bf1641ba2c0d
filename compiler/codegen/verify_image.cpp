#include "compiler/codegen/verify_image.hpp"

#include "compiler/codegen/costly_rules.hpp"
#include "vm/verifier.hpp"

namespace robosync::compiler {
namespace {

// Shows which rules make the step costly. One object alone may cost more than can be counted: that
// is `span`.
void report_costly_step(const Emitted& emitted, Span span, Diagnostics& diagnostics) {
  Diagnostic& report = diagnostics.report(
      Code::E0407, "one step of the program could take too long on the robot: at most " +
                       std::to_string(vm::Limits{}.step_cost) + " instructions may run in it");
  report.helps(std::string(kHelpForCostlyStep));
  vm::Image image;
  const bool whole = vm::view_image(emitted.image, image);
  bool primary = true;
  for (const CostlyRule& costly : whole ? costly_rules(image) : std::vector<CostlyRule>{}) {
    const vm::Rule& rule = image.rules[costly.rule];
    const bool in_else = costly.cost.else_response > costly.cost.then_response;
    const std::uint16_t response = in_else ? rule.else_response : rule.then_response;
    const bool in_response = costly.cost.worst_response() > costly.cost.condition;
    const std::size_t word = in_response ? image.responses[response].start : rule.condition_start;
    report.label(emitted.code.span_of(word),
                 "its rule takes up to " + std::to_string(costly.cost.step()) + " instructions",
                 primary);
    primary = false;
  }
  if (primary) report.label(span);
}

// What a refusal means to the writer of a program that is too large; empty for all others.
std::string_view too_large(vm::Refusal refusal) {
  switch (refusal) {
    case vm::Refusal::too_large:
      return "the program is larger than 64 KiB";
    case vm::Refusal::too_many:
      return "the program needs more memory than a robot has";
    case vm::Refusal::too_much_output:
      return "there are more commands here than a robot takes in one step";
    case vm::Refusal::too_deep:
      return "blocks are nested too deeply here for the robot";
    default:
      return {};
  }
}

void report_too_large(vm::Refusal refusal, std::string_view what, Span span,
                      Diagnostics& diagnostics) {
  Diagnostic& d = diagnostics.report(Code::E0407, std::string(what)).label(span);
  if (refusal == vm::Refusal::too_much_output)
    d.helps("write THEN or a WAIT between them, so that they come one step after the other");
}

void report_refused(const vm::Verdict& verdict, Span span, Diagnostics& diagnostics) {
  diagnostics
      .report(Code::E0499, "rsc made an image that the robot refuses: " +
                               std::string(vm::describe(verdict.refusal)) + " (" +
                               std::string(vm::describe(verdict.section)) + " " +
                               std::to_string(verdict.index) + ")")
      .label(span)
      .helps("please report this, with the program and its robot.json");
}

}  // namespace

bool verify_image(const Emitted& emitted, Diagnostics& diagnostics) {
  vm::Image image;
  const vm::Verdict verdict = vm::verify(emitted.image, vm::Limits{}, image);
  if (verdict.ok()) return true;
  const bool in_code = verdict.section == vm::Section::code;
  const Span span = in_code ? emitted.code.span_of(verdict.index) : Span{};
  const std::string_view what = too_large(verdict.refusal);
  if (verdict.refusal == vm::Refusal::too_costly)
    report_costly_step(emitted, span, diagnostics);
  else if (!what.empty())
    report_too_large(verdict.refusal, what, span, diagnostics);
  else
    report_refused(verdict, span, diagnostics);
  return false;
}

}  // namespace robosync::compiler
