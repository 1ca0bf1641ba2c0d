// Uses the same functions as the board and `rsc check --timing`.
#include "rsc/judge.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/bus_load.hpp"
#include "analysis/report.hpp"
#include "compiler/codegen/costly_rules.hpp"
#include "compiler/reading.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/failure.hpp"
#include "rsc/timing.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::tool {
namespace {

using compiler::Code, compiler::Diagnostic;

const std::string kCannotKeepUp = "the board cannot keep up with the program: ";

analysis::ResponseReport responses_of(const vm::Image& image, const policy::BoardCosts& board) {
  return analysis::response_report(image, board, module_cost, cap_of(image),
                                   analysis::Depth::until_refused);
}

void judge_memory(const vm::Image& image, const policy::BoardMemory& board,
                  compiler::Diagnostics& diagnostics) {
  const policy::Needs needs = needs_on_board(image, board);
  const vm::Verdict verdict = policy::judge(needs, board);
  if (verdict.ok()) return;
  const bool no_room = verdict.refusal == vm::Refusal::no_room;
  diagnostics
      .report(Code::E0407, no_room ? no_room_text(needs, board) : too_many_text(needs, verdict))
      .label(compiler::Span{})
      .helps("leave out what takes most, or name a board with more memory in robot.json (`board`)");
}

// Labels the rules that cost most in a step; the first one is the primary label.
void label_rules(Diagnostic& report, const vm::Image& image,
                 const std::vector<compiler::Span>& places) {
  bool primary = true;
  for (const compiler::CostlyRule& costly : compiler::costly_rules(image)) {
    if (costly.rule >= places.size()) continue;
    report.label(places[costly.rule],
                 fmt::format("this rule takes up to {} instructions", costly.cost.step()), primary);
    primary = false;
  }
  if (primary) report.label(compiler::Span{});
}

void judge_step(const vm::Image& image, const compiler::Result& compiled,
                compiler::Diagnostics& diagnostics) {
  if (image.header->step_cost <= compiled.board.step_budget) return;
  Diagnostic& report = diagnostics.report(
      Code::E0407, fmt::format("a step of the program costs up to {} instructions, the board "
                               "allows {}",
                               image.header->step_cost, compiled.board.step_budget));
  label_rules(report, image, compiled.rules);
  report.helps(std::string(compiler::kHelpForCostlyStep));
}

Diagnostic& report_overload(const Overload& overload, compiler::Diagnostics& diagnostics) {
  Diagnostic& report = diagnostics.report(Code::E0412, kCannotKeepUp + overload.what);
  for (const std::string& reason : overload.why)
    report.helps(reason);
  return report;
}

std::string ms_text(std::uint32_t us) {
  return fmt::format("{:.2f} ms", us / 1000.0);
}

Overload overload_of_bus(const vm::Image& image, const analysis::BusLoad& load) {
  Overload overload{
      fmt::format("{} bus {} needs {} for all that may be asked of it together, and has {}",
                  load.spi ? "SPI" : "I2C", load.bus, ms_text(load.us), ms_text(load.window_us)),
      {"leave out channels or sensors on this bus"}};
  if (load.shares.size() == 1) return overload;
  std::vector<std::string> parts;
  for (const auto& [sensor, us] : load.shares)
    parts.push_back(fmt::format("{} {}", image.string(image.sensors[sensor].name), ms_text(us)));
  overload.why.insert(
      overload.why.begin(),
      fmt::format("the sensors are read together at the start, and whenever their periods meet: {}",
                  fmt::join(parts, ", ")));
  return overload;
}

// Labels the bus's sensors in robot.json; the one that takes most is the primary label. Displays and servo chips are not among
// them.
void label_sensors(Diagnostic& report, const vm::Image& image, const analysis::BusLoad& load,
                   const std::vector<compiler::SensorConfig>& sensors) {
  const auto most = std::ranges::max(load.shares, {}, &analysis::BusLoad::Share::us);
  for (const auto& [number, us] : load.shares) {
    const std::string_view name = image.string(image.sensors[number].name);
    for (const compiler::SensorConfig& sensor : sensors)
      if (sensor.name.text == name)
        report.label(sensor.name.span, ms_text(us) + " of it", number == most.sensor);
  }
  if (report.labels.empty()) report.label(compiler::Span{});
  if (std::ranges::none_of(report.labels, &compiler::Label::primary))
    report.labels.front().primary = true;
}

void judge_buses(const vm::Image& image, const compiler::Result& compiled,
                 compiler::Diagnostics& diagnostics) {
  for (const analysis::BusLoad& load :
       analysis::overloaded_buses(image, costs_of(compiled.board))) {
    Diagnostic& report = report_overload(overload_of_bus(image, load), diagnostics);
    label_sensors(report, image, load, compiled.reading->robot->sensors);
  }
}

void judge_time(const vm::Image& image, const compiler::Result& compiled,
                compiler::Diagnostics& diagnostics) {
  const Overload overload = overload_of(responses_of(image, costs_of(compiled.board)));
  if (overload.what.empty()) return;
  label_rules(report_overload(overload, diagnostics), image, compiled.rules);
}

}  // namespace

void judge(compiler::Result& result, Judged judged) {
  vm::Image image;
  if (judged == Judged::not_at_all || result.diagnostics.errors() > 0 ||
      !vm::view_image(result.image, image)) {
    return;
  }
  judge_memory(image, memory_of(result.board), result.diagnostics);
  if (judged == Judged::by_memory) return;
  judge_step(image, result, result.diagnostics);
  judge_buses(image, result, result.diagnostics);
  if (result.diagnostics.errors() == 0) judge_time(image, result, result.diagnostics);
}

void judge_time(const Program& program, const std::string& name) {
  const vm::Image& image = program.image();
  const auto board = board_of(*image.header);
  const policy::BoardCosts& costs = board ? costs_of(*board) : board_costs();
  const auto buses = analysis::overloaded_buses(image, costs);
  const Overload overload = buses.empty() ? overload_of(responses_of(image, costs))
                                          : overload_of_bus(image, buses.front());
  if (overload.what.empty()) return;
  throw Failure(Exit::program,
                fmt::format("{}: {}{}\n  {}\n  --anyway uploads it anyway", name, kCannotKeepUp,
                            overload.what, fmt::join(overload.why, "\n  ")));
}

}  // namespace robosync::tool
