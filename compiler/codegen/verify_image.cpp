#include "compiler/codegen/verify_image.hpp"

#include "compiler/codegen/costly_rules.hpp"
#include "vm/timers.hpp"
#include "vm/verifier.hpp"

namespace robosync::compiler {
namespace {

// Reports the rules that make the step expensive. A single object may cost more than can be counted; then `span` is its place.
void report_costly_step(const Emitted& emitted, Span span, Diagnostics& diagnostics) {
  vm::Image image;
  const bool whole = vm::view_image(emitted.image, image);
  const std::uint32_t cost = whole ? vm::step_cost(image) : 0;
  const std::string most = std::to_string(vm::Limits{}.step_cost);
  Diagnostic& report = diagnostics.report(
      Code::E0407, cost > vm::Limits{}.step_cost
                       ? "one step of the program could take up to " + std::to_string(cost) +
                             " instructions on the robot; the limit is " + most
                       : "one step of the program could take more than " + most +
                             " instructions, the most that a robot allows");
  report.helps(std::string(kHelpForCostlyStep));
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

std::string too_much(std::size_t count, const std::string& of_what, std::size_t limit) {
  return "the program needs " + std::to_string(count) + " " + of_what + "; the limit is " +
         std::to_string(limit);
}

// Tells which of the three sums over the whole image is too large.
std::string too_many(const Emitted& emitted) {
  vm::Image image;
  if (!vm::view_image(emitted.image, image)) return {};
  constexpr vm::Limits limits;
  std::size_t cells = 0, timer_words = 0, samples = 0;
  for (const vm::Behavior& behavior : image.behaviors)
    cells += behavior.cells;
  for (const vm::Timer& timer : image.timers)
    timer_words += vm::timer_words(timer);
  for (const vm::Check& check : image.checks)
    if (check.window > 1) samples += check.window;
  if (cells > limits.frame_cells)
    return too_much(cells, "cells for the inputs and values of its behaviours", limits.frame_cells);
  if (timer_words > limits.timer_words)
    return too_much(timer_words, "words of memory for its time words", limits.timer_words);
  return samples > limits.samples ? too_much(samples, "readings to smooth over", limits.samples)
                                  : "";
}

// Explains a refusal to the author of a program that is too large; empty for other refusals.
std::string too_large(vm::Refusal refusal, const Emitted& emitted) {
  switch (refusal) {
    case vm::Refusal::too_large:
      return "the program has " + std::to_string(emitted.image.size()) + " bytes; the limit is " +
             std::to_string(vm::Limits{}.image_bytes);
    case vm::Refusal::too_many:
      return too_many(emitted);
    case vm::Refusal::too_much_output:
      return "the commands up to here take more than " + std::to_string(vm::kMaxResponseOutput) +
             " words, the most that a robot can handle in one step";
    case vm::Refusal::too_deep:
      return "blocks are nested more than " + std::to_string(vm::kMaxBlocks) + " levels deep here";
    default:
      return {};
  }
}

void report_too_large(vm::Refusal refusal, std::string what, Span span, Diagnostics& diagnostics) {
  Diagnostic& d = diagnostics.report(Code::E0407, std::move(what)).label(span);
  if (refusal == vm::Refusal::too_much_output)
    d.helps(
        "put THEN or a WAIT between them to spread them over several steps; a command takes "
        "one word, and two more for each of its numbers");
}

void report_refused(const vm::Verdict& verdict, Span span, Diagnostics& diagnostics) {
  diagnostics
      .report(Code::E0499, "rsc produced an image that the robot rejects: " +
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
  const std::string what = too_large(verdict.refusal, emitted);
  if (verdict.refusal == vm::Refusal::too_costly)
    report_costly_step(emitted, span, diagnostics);
  else if (!what.empty())
    report_too_large(verdict.refusal, what, span, diagnostics);
  else
    report_refused(verdict, span, diagnostics);
  return false;
}

}  // namespace robosync::compiler
