// What programs become, as they are written and optimised: programs/NAME.rsl and NAME.txt.
#include <set>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "tests/compiler/codegen/build.hpp"
#include "tests/support/golden.hpp"

using namespace robosync;
using namespace robosync::compiler;
using robosync::compiler::testing::listing;
using robosync::testing::read_file;
namespace fs = std::filesystem;

namespace {

const fs::path kFolder = fs::path(ROBOSYNC_SOURCE_DIR) / "tests/compiler/optimize/programs";

std::vector<std::byte> compiled(const fs::path& program, bool optimize) {
  const Options options{.source_lines = false, .optimize = optimize};
  Result result =
      compile({"robot.rsl", read_file(program)},
              {"robot.json", read_file(kFolder / "robot.json")}, options);
  for (const Diagnostic& one : result.diagnostics.all())
    UNSCOPED_INFO(one.message);
  REQUIRE(!result.image.empty());
  return std::move(result.image);
}

vm::Image view(const std::vector<std::byte>& bytes) {
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  return image;
}

std::size_t response_bytes(const char* name) {
  const std::vector<std::byte> bytes = compiled(kFolder / name, true);
  const vm::Image image = view(bytes);
  REQUIRE(image.responses.size() == 1);
  return image.responses[0].length * sizeof(vm::Word);
}

}  // namespace

TEST_CASE("programs as they are written, and optimised", "[golden]") {
  std::set<fs::path> programs;
  for (const auto& entry : fs::directory_iterator(kFolder))
    if (entry.path().extension() == ".rsl") programs.insert(entry.path());
  CHECK(programs.size() >= 12);
  for (const fs::path& program : programs) {
    INFO(program);
    const std::vector<std::byte> plain = compiled(program, false);
    const std::vector<std::byte> optimized = compiled(program, true);
    fs::path golden = program;
    robosync::testing::expect_golden(golden.replace_extension(".txt"),
                                     "-O0\n" + listing(view(plain)) + "\n-O1\n" +
                                         listing(view(optimized)));
    CHECK(view(optimized).code.size() <= view(plain).code.size());
    CHECK(view(optimized).header->step_cost <= view(plain).header->step_cost);
  }
}

TEST_CASE("the workloads fit their bars") {
  CHECK(response_bytes("sum_of_squares.rsl") <= 40);
  CHECK(response_bytes("filter.rsl") <= 90);
}
