// What fits the robot as it is written fits when it is optimised.
#include <catch2/catch.hpp>

#include "compiler/optimize/optimize.hpp"
#include "tests/compiler/build.hpp"
#include "vm/verifier.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

// Worked out twice, it asks for a cell.
E dear() {
  return of(Operation::multiply, {variable(0), of(Operation::add, {variable(0), variable(1)})});
}

// As many texts as a step may put out.
ir::Rule shares_numbers() {
  constexpr unsigned kWords = 5;  // of a text with two numbers
  ir::Block block;
  for (unsigned i = 1; i <= vm::kMaxResponseOutput / kWords; ++i) {
    const E number_of_its_own = of(Operation::add, {dear(), number(i)});
    block.push_back(line(2, ir::Log{false, "{} {}", {number_of_its_own, number_of_its_own}}));
  }
  return at_start(block);
}

ir::Rule shares_in_condition() {
  return when(
      of(Operation::logical_or,
         {less(dear(), number(1)),
          of(Operation::logical_and, {less(number(7), dear()), held(less(dear(), number(3)), 1)})}),
      {line(9, move(0))});
}

// A loop each, which keeps a counter.
ir::Rule loops(unsigned count) {
  ir::Block block;
  for (unsigned i = 0; i < count; ++i)
    block.push_back(line(3, ir::Repeat{ir::RepeatKind::times, variable(1), {line(3, ir::Then{})}}));
  return at_start(block);
}

ir::Program with_loops(unsigned count) {
  return program_of({shares_numbers(), shares_in_condition(), loops(count)},
                    {plain("a"), plain("b")});
}

std::size_t cells(const Built& built) {
  return built.image.behaviors[0].cells;
}

}  // namespace

TEST_CASE("values are worked out once as far as the frame has room") {
  const Built roomy = build(with_loops(10), {.optimize = true});
  REQUIRE(!roomy.bytes.empty());
  const Built plainly = must_build(with_loops(10));
  CHECK(roomy.image.header->step_cost < plainly.image.header->step_cost);

  const std::size_t others = cells(must_build(with_loops(0)));
  for (std::size_t cells_left = 0; cells_left < 40; ++cells_left) {
    const ir::Program program =
        with_loops(static_cast<unsigned>(vm::kMaxCells - others - cells_left));
    INFO(cells_left);
    REQUIRE(cells(must_build(program)) == vm::kMaxCells - cells_left);
    const Built optimized = build(program, {.optimize = true});
    REQUIRE(!optimized.bytes.empty());
  }
}

TEST_CASE("so it is with the frames of all behaviours together") {
  ir::Program program = with_loops(vm::kMaxCells - 40);
  const std::size_t own = cells(must_build(program));
  const std::size_t behaviors = vm::Limits{}.frame_cells / own;
  for (std::size_t i = 1; i < behaviors; ++i)
    program.behaviors.push_back(
        {static_cast<std::int16_t>(50 - i), "b" + std::to_string(i), program.behaviors[0].rules});
  const std::size_t left = vm::Limits{}.frame_cells - own * behaviors;
  program.behaviors[0].rules.push_back(
      loops(static_cast<unsigned>(std::min<std::size_t>(left, 9))));
  REQUIRE(!build(program).bytes.empty());
  CHECK(!build(program, {.optimize = true}).bytes.empty());
}

TEST_CASE("an AND becomes blocks in blocks as far as there is room") {
  for (unsigned parts = 2; parts <= 24; ++parts) {
    E condition = less(channel(0), number(1));
    for (unsigned i = 1; i < parts; ++i)
      condition = of(Operation::logical_and, {condition, less(channel(1), number(i))});
    for (unsigned depth = 0; depth < vm::kMaxBlocks; ++depth) {
      ir::Block inside = {line(4, ir::Then{})};
      for (unsigned i = 0; i < depth; ++i)
        inside = {line(4, ir::If{less(channel(2), number(2)), inside, {}})};
      const ir::Program program = program_of({at_start({line(3, ir::If{condition, inside, {}})})});
      INFO(parts << " parts around " << depth << " blocks");
      REQUIRE(!build(program).bytes.empty());
      REQUIRE(!build(program, {.optimize = true}).bytes.empty());
    }
  }
}
