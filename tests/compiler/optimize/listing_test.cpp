// What programs become, as they are written and optimised: programs/NAME.rsl and NAME.txt.
#include <set>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "tests/compiler/build.hpp"
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
  Result result = compile({"robot.rsl", read_file(program)},
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
    robosync::testing::expect_golden(
        golden.replace_extension(".txt"),
        "-O0\n" + listing(view(plain)) + "\n-O1\n" + listing(view(optimized)));
    CHECK(view(optimized).code.size() <= view(plain).code.size());
    CHECK(view(optimized).header->step_cost <= view(plain).header->step_cost);
  }
}

// 255 words: what a jump that compares can skip.
TEST_CASE("a jump that compares becomes two instructions where its target is too far away") {
  using namespace robosync::compiler::testing;
  for (const std::size_t sets : {252U, 253U, 300U}) {
    ir::Block body;
    for (std::size_t i = 0; i < sets; ++i)
      body.push_back(line(2, ir::Set{i % 2, number(static_cast<double>(i % 7) + 1)}));
    body.push_back(line(3, ir::Then{}));
    const ir::If inner{less(channel(1), number(2)), body, {}};
    const ir::If outer{less(channel(0), number(1)), {line(1, inner)}, {}};
    const ir::Rule rule = at_start({line(1, outer), line(4, ir::Then{})});
    const Built built = build(program_of({rule}, {plain("a"), plain("b")}),
                              {.source_lines = true, .optimize = true});
    INFO(sets);
    REQUIRE(!built.bytes.empty());  // so it was verified
    const std::string text = listing(built.image);
    const bool near = sets == 252;  // of the inner one; the outer one skips one word more
    CHECK((text.find("unless_lt_k r3, 2, +255") != std::string::npos) == near);
    CHECK((text.find("lt_k     r4, r3, 2") != std::string::npos) == !near);
    CHECK(text.find("lt_k     r4, r2, 1") != std::string::npos);
    CHECK(built.image.source_lines.back().line == 4);
    CHECK(built.image.source_lines.back().word + 2U == built.image.code.size());
  }
}

TEST_CASE("the workloads fit their bars") {
  CHECK(response_bytes("sum_of_squares.rsl") <= 40);
  CHECK(response_bytes("filter.rsl") <= 90);
}
