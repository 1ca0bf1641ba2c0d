// Compiled programs for the tests of rsc/timing.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "compiler/diagnostics/render.hpp"
#include "rsc/program.hpp"
#include "tests/support/golden.hpp"

namespace robosync::test {

inline const std::filesystem::path kRoot = ROBOSYNC_SOURCE_DIR;

inline tool::Program as_program(compiler::Result result) {
  INFO(compiler::render_human(result.diagnostics, result.sources, false));
  REQUIRE(result.diagnostics.errors() == 0);
  return {std::move(result.image), "robot.rsl"};
}

// `file` from the top of the repository.
inline tool::Program compile_example(const std::string& file) {
  return as_program(tool::compile_file((kRoot / file).string(), {}));
}

// On docs/robot.json.
inline compiler::Result compiled_with_docs_robot(const std::string& text) {
  return compiler::compile({"robot.rsl", text},
                           {"robot.json", testing::read_file(kRoot / "docs/robot.json")});
}
inline tool::Program compile_with_docs_robot(const std::string& text) {
  return as_program(compiled_with_docs_robot(text));
}

}  // namespace robosync::test
