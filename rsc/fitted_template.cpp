// See fitted_template.hpp.
#include "rsc/fitted_template.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "rsc/algorithm_modules.hpp"
#include "rsc/failure.hpp"
#include "rsc/judge.hpp"

namespace robosync::tool {
namespace {

constexpr std::string_view kRobot = "robot.json";

const TemplateFile& file_of(const Template& robot, std::string_view name) {
  return *std::ranges::find(robot.files, name, &TemplateFile::name);
}

std::string key_of(std::string_view board) {
  return fmt::format("\"board\": \"{}\"", board);
}

bool names(const Template& robot, std::string_view text) {
  return file_of(robot, kRobot).text().find(text) != std::string_view::npos;
}

std::string those_for(std::string_view board) {
  std::vector<std::string_view> fitting;
  for (const Template& robot : templates())
    if (why_not_on(board, robot).empty()) fitting.push_back(robot.name);
  return fitting.empty() ? "none does" : fmt::format("these do: {}", fmt::join(fitting, ", "));
}

}  // namespace

std::string text_on(std::string_view board, const TemplateFile& file) {
  std::string text(file.text());
  if (board.empty() || file.name != kRobot || text.find("\"board\"") != std::string::npos)
    return text;
  return text.insert(text.find('{') + 1, fmt::format("\n  {},", key_of(board)));
}

std::string why_not_on(std::string_view board, const Template& robot) {
  if (names(robot, "\"board\"") && !names(robot, key_of(board))) return "it is for another board";
  constexpr std::string_view kProgram = "robot.rsl";
  compiler::Result result =
      compiler::compile({std::string(kProgram), std::string(file_of(robot, kProgram).text())},
                        {std::string(kRobot), text_on(board, file_of(robot, kRobot))},
                        {.algorithms = algorithm_modules()});
  judge(result, Judged::by_time);
  const auto& all = result.diagnostics.all();
  const auto error = std::ranges::find(all, compiler::Level::error, &compiler::Diagnostic::level);
  return error == all.end() ? "" : error->message;
}

const Template& template_for(std::string_view board) {
  const auto all = templates();
  auto found =
      std::ranges::find_if(all, [&](const Template& robot) { return names(robot, key_of(board)); });
  if (found == all.end())
    found = std::ranges::find_if(
        all, [&](const Template& robot) { return why_not_on(board, robot).empty(); });
  if (found == all.end())
    throw Failure(Exit::usage, fmt::format("no template fits the board {}", board));
  return *found;
}

void refuse_misfit(std::string_view board, const Template& robot) {
  const std::string why = why_not_on(board, robot);
  if (why.empty()) return;
  throw Failure(Exit::usage, fmt::format("the template {} does not fit the board {}: {}; {}",
                                         robot.name, board, why, those_for(board)));
}

}  // namespace robosync::tool
