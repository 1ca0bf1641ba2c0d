// Every wrong program in golden/ with all that the front end says about it.
#include <catch2/catch.hpp>

#include "tests/compiler/parsed.hpp"

using namespace robosync::compiler::testing;

TEST_CASE("messages about wrong programs", "[golden]") {
  const auto programs = files_in("golden", ".rsl");
  CHECK(programs.size() >= 25);
  for (auto path : programs) {
    const std::string name = path.filename().string();
    const Parsed parsed = parse_text(robosync::testing::read_file(path), name);
    CHECK(!parsed.diagnostics.all().empty());
    robosync::testing::expect_golden(path.replace_extension(".txt"), messages(parsed));
  }
}
