// What the tests of the documentation do with a page: its programs are checked and run by the built rsc.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/rsc/process.hpp"
#include "tests/support/golden.hpp"

namespace robosync::test {

// The fenced blocks of `language` in a Markdown text.
inline std::vector<std::string> blocks_in(const std::string& text, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  std::vector<std::string> found;
  for (auto at = text.find(fence); at != std::string::npos; at = text.find(fence, at)) {
    at += fence.size();
    const auto end = text.find("```", at);
    found.push_back(text.substr(at, end - at));
    at = std::min(end, text.size());
  }
  return found;
}

inline void check_runs(const Outcome& outcome) {
  INFO(outcome.out);
  INFO(outcome.err);
  CHECK(outcome.exit == 0);
}

inline std::size_t warnings_in(const std::string& report) {
  const auto found = nlohmann::json::parse(report).at("diagnostics");
  return static_cast<std::size_t>(std::count_if(
      found.begin(), found.end(), [](const auto& one) { return one.at("level") == "warning"; }));
}

// A page is a promise: not even a warning.
inline void check_program(const std::string& program, const std::string& robot) {
  const Folder folder;
  folder.write("robot.json", robot);
  const std::string file = folder.write("robot.rsl", program);
  INFO(program);

  const Outcome report = rsc({"check", file, "--format", "json"});
  INFO(report.out);
  REQUIRE(report.exit == 0);
  CHECK(warnings_in(report.out) == 0);
  check_runs(rsc({"run", file, "--duration", "2s"}));
  if (program.find("TEST \"") != std::string::npos) check_runs(rsc({"test", file}));
}

}  // namespace robosync::test
