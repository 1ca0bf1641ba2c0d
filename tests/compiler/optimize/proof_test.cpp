// What is proved of the variables of whole programs.
#include <catch2/catch.hpp>

#include "compiler/optimize/variable_facts.hpp"
#include "tests/compiler/build.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

constexpr std::size_t kI = 0, kS = 1;

VariableFacts prove(ir::Program program) {
  return prove_variables(program, small_robot());
}

Fact units(vm::Value low, vm::Value high) {
  return known_between(low * vm::kScale, high * vm::kScale, true);
}

E sum(E left, E right) {
  return of(Operation::add, {std::move(left), std::move(right)});
}

ir::Statement set(std::size_t variable, E value) {
  return line(1, ir::Set{variable, std::move(value)});
}

ir::Statement raise(std::size_t variable, E value) {
  return line(1, ir::Set{variable, std::move(value), true});
}

ir::Statement repeat(double times, ir::Block body) {
  return line(1, ir::Repeat{ir::RepeatKind::times, number(times), std::move(body)});
}

// s := s + i * i MOD 251; i := i + 1
ir::Block round_of_w2() {
  const E square = of(Operation::multiply, {variable(kI), variable(kI)});
  const E rest = of(Operation::modulo, {square, number(251)});
  return {set(kS, sum(variable(kS), rest)), set(kI, sum(variable(kI), number(1)))};
}

const std::vector<ir::Variable> kTwo = {plain("i"), plain("s")};
const E kClose = less(channel(1), number(1));

}  // namespace

TEST_CASE("a counted loop at the start raises variables by so much and no more") {
  const VariableFacts facts = prove(program_of({at_start({repeat(1000, round_of_w2())})}, kTwo));
  CHECK(facts[kI] == units(0, 1000));
  CHECK(facts[kS] == units(0, 250000));
}

TEST_CASE("so does one that is set up each time") {
  const ir::Block response = {set(kI, number(0)), set(kS, number(0)), repeat(1000, round_of_w2())};
  const VariableFacts facts = prove(program_of({when(kClose, response)}, kTwo));
  CHECK(facts[kI] == units(0, 1000));
  CHECK(facts[kS] == units(0, 250000));
}

TEST_CASE("a loop that is run again goes on from where it was, without end") {
  const VariableFacts facts =
      prove(program_of({when(kClose, {repeat(1000, round_of_w2())})}, kTwo));
  CHECK(facts[kI].high == vm::kValueMax);
  CHECK(!facts[kI].whole);
  CHECK(facts[kI].low == 0);
}

TEST_CASE("a response to AT START that waits sees what it has written") {
  const ir::Statement pause = line(2, ir::Wait{number(1)});
  const ir::Block counting = {set(kI, sum(variable(kI), number(1))), pause,
                              set(kI, sum(variable(kI), number(1)))};
  CHECK(prove(program_of({at_start(counting)}, kTwo))[kI].high == vm::kValueMax);
  const ir::Block at_once = {counting[0], counting[2]};
  CHECK(prove(program_of({at_start(at_once)}, kTwo))[kI] == units(0, 2));
}

TEST_CASE("a loop whose body waits proves nothing about its rounds") {
  const ir::Block body = {set(kI, sum(variable(kI), number(1))), line(2, ir::Then{})};
  const ir::Block response = {set(kI, number(0)), repeat(10, body)};
  CHECK(prove(program_of({when(kClose, response)}, kTwo))[kI].high == vm::kValueMax);
}

TEST_CASE("a variable that is only set to constants is one of them") {
  const VariableFacts facts = prove(
      program_of({when(kClose, {set(kI, number(3))}), when(kClose, {set(kI, number(-2))})}, kTwo));
  CHECK(facts[kI] == units(-2, 3));
  CHECK(facts[kS] == units(0, 0));
}

TEST_CASE("to set something unknown does nothing") {
  const VariableFacts facts = prove(program_of({when(kClose, {set(kI, channel(3))})}, kTwo));
  CHECK(facts[kI] == known_between(0, vm::kScale, false));
}

TEST_CASE("differences of several rules come together") {
  const ir::Program program = program_of({when(kClose, {raise(kI, number(1))}),
                                          when(kClose, {set(kI, number(2)), raise(kI, number(1))})},
                                         {ranged("i", 0, 10), plain("s")});
  CHECK(prove(program)[kI] == units(0, 10));
  ir::Program falling = program_of({when(kClose, {raise(kI, number(-1))})}, kTwo);
  const Fact fact = prove(falling)[kI];
  CHECK(fact.low == vm::kValueMin);
  CHECK(fact.high == 0);
  CHECK(!fact.whole);
}

TEST_CASE("what fades is anything on its way") {
  ir::Variable fading = ranged("i", 0, 10);
  fading.fade = 1;
  fading.fades_to = 5000;
  const Fact fact = prove(program_of({when(kClose, {set(0, number(7))})}, {fading}))[0];
  CHECK(fact == known_between(0, 7000, false));
}

TEST_CASE("a branch that never runs writes nothing") {
  const E never = greater(channel(3), number(2));  // a word: 0 or 1
  const ir::Block response = {line(1, ir::If{never, {set(kI, number(9))}, {}})};
  CHECK(prove(program_of({when(kClose, response)}, kTwo))[kI] == units(0, 0));
}

// As FOLLOW has one, which the body writes for its next run.
TEST_CASE("a local with other writers may be anything they leave there") {
  for (const bool others : {false, true}) {
    const ir::Block response = {line(1, ir::Local{0, number(7), others}), set(kI, local(0))};
    const Fact fact = prove(program_of({when(kClose, response)}, kTwo))[kI];
    CHECK((fact == units(0, 7)) == !others);
    CHECK((fact.high == vm::kValueMax) == others);
  }
}

TEST_CASE("chains of variables come to an end") {
  std::vector<ir::Variable> variables;
  std::vector<ir::Rule> rules;
  for (std::size_t i = 0; i < 30; ++i)
    variables.push_back(plain("v" + std::to_string(i)));
  for (std::size_t i = 0; i < 30; ++i)
    rules.push_back(when(kClose, {set(i, sum(variable((i + 1) % 30), number(0.5)))}));
  for (const Fact& fact : prove(program_of(rules, variables))) {
    CHECK(fact.high == vm::kValueMax);
    CHECK(!fact.whole);
  }
}
