// docs/timing.md shows what rsc prints. ROBOSYNC_UPDATE_GOLDEN=1 rewrites what it shows.
#include <catch2/catch.hpp>

#include "analysis/report.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/board.hpp"
#include "rsc/judge.hpp"
#include "rsc/timing.hpp"
#include "runtime-m4/boards/memory.hpp"
#include "tests/timing/programs.hpp"

using namespace robosync;

namespace {

const std::filesystem::path kPage = std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "docs/timing.md";

// The text between `opening` and the end of the fenced block that it begins.
struct Block {
  std::size_t begin = 0, end = 0;
};
Block block_after(const std::string& page, const std::string& opening) {
  const std::size_t at = page.find(opening);
  REQUIRE(at != std::string::npos);
  const std::size_t begin = at + opening.size();
  return {begin, page.find("```", begin)};
}

void expect_printed(const std::string& command, const std::string& printed) {
  std::string page = testing::read_file(kPage);
  const Block block = block_after(page, "<!-- printed: " + command + " -->\n```\n");
  if (testing::updating_golden()) {
    page.replace(block.begin, block.end - block.begin, printed);
    std::ofstream(kPage, std::ios::binary) << page;
    return;
  }
  CHECK(page.substr(block.begin, block.end - block.begin) == printed);
}

}  // namespace

TEST_CASE("docs/timing.md: the table of an example") {
  const std::string file = "examples/greeting_robot/robot.rsl";
  const tool::Program program = test::compile_example(file);
  expect_printed("rsc check --timing " + file,
                 tool::timing_text(tool::timing_of(program.image()), file));
}

TEST_CASE("docs/timing.md: the response times of an example") {
  const std::string file = "examples/touch_companion/robot.rsl";
  const tool::Program program = test::compile_example(file);
  expect_printed("rsc check --timing " + file + ", its end",
                 tool::response_text(analysis::response_report(program.image(), tool::board_costs(),
                                                               tool::module_cost)));
}

TEST_CASE("docs/timing.md: a program that costs too much, and its mend") {
  const std::string page = testing::read_file(kPage);
  const Block block = block_after(page, "```rsl\n");
  const std::string text = page.substr(block.begin, block.end - block.begin);
  const tool::Program program = test::compile_with_docs_robot(text);
  CHECK(tool::timing_of(program.image()).step.used > boards::kMemory.step_budget);
  compiler::Result result = test::compiled_with_docs_robot(text);
  tool::judge(result, tool::Judged::by_time);
  compiler::Diagnostics errors;
  for (const compiler::Diagnostic& diagnostic : result.diagnostics.all())
    if (diagnostic.level == compiler::Level::error) errors.add(diagnostic);
  expect_printed("rsc check robot.rsl", compiler::render_human(errors, result.sources, false));

  std::string mended = text;
  mended.insert(mended.find("    END"), "      WAIT 1ms\n");
  const tool::Program cheap = test::compile_with_docs_robot(mended);
  CHECK(tool::timing_of(cheap.image()).step.used < 1000);
}
