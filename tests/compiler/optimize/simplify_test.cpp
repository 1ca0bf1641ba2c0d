// Simplified expressions give what they gave before, whatever their parts turn out to be.
#include "compiler/optimize/simplify.hpp"

#include <random>

#include <catch2/catch.hpp>

#include "compiler/optimize/expression_facts.hpp"
#include "tests/oracles/rsl/evaluator.hpp"

using namespace robosync;
using namespace robosync::compiler;

namespace {

using vm::Value;

Expression constant(Value value) {
  Expression made;
  made.constant = value;
  return made;
}

Expression variable_at(std::size_t place) {
  Expression made;
  made.operation = Operation::variable;
  made.index = place;
  return made;
}

Expression make(Operation operation, std::vector<Expression> operands) {
  Expression made;
  made.operation = operation;
  made.operands = std::move(operands);
  return made;
}

Value evaluate(const Expression& expression, const oracle::Snapshot& variables) {
  const bool is_truth =
      expression.operation >= Operation::less && expression.operation <= Operation::logical_or;
  oracle::Evaluator evaluator;
  const oracle::Sight sight{variables};
  return is_truth ? oracle::value_of(evaluator.truth(expression, sight))
                  : oracle::value_of(evaluator.number(expression, sight));
}

const std::vector<Value> kValues = {vm::kUnknown,
                                    vm::kValueMin,
                                    vm::kValueMin + 1,
                                    -2000000,
                                    -4000,
                                    -3996,
                                    -1001,
                                    -1000,
                                    -501,
                                    -500,
                                    -1,
                                    0,
                                    1,
                                    499,
                                    500,
                                    1000,
                                    1499,
                                    1500,
                                    3995,
                                    3996,
                                    4000,
                                    1234567,
                                    vm::kValueMax - 1,
                                    vm::kValueMax};

class Maker {
public:
  explicit Maker(unsigned seed) : random_(seed) {}

  Expression number(unsigned depth) {
    if (depth == 0 || below(4) == 0) return below(2) == 0 ? variable_at(below(2)) : some_constant();
    if (below(6) == 0) return make(Operation::negate, {number(depth - 1)});
    const auto operation = static_cast<Operation>(static_cast<unsigned>(Operation::add) + below(5));
    return make(operation, {number(depth - 1), number(depth - 1)});
  }

  Expression truth(unsigned depth) {
    if (depth > 0 && below(4) == 0) return make(Operation::logical_not, {truth(depth - 1)});
    if (depth > 0 && below(3) == 0)
      return make(below(2) == 0 ? Operation::logical_and : Operation::logical_or,
                  {truth(depth - 1), truth(depth - 1)});
    const auto operation =
        static_cast<Operation>(static_cast<unsigned>(Operation::less) + below(6));
    return make(operation, {number(3), number(2)});
  }

private:
  unsigned below(unsigned end) {
    return std::uniform_int_distribution<unsigned>(0, end - 1)(random_);
  }
  Expression some_constant() {
    return constant(kValues[1 + below(static_cast<unsigned>(kValues.size()) - 1)]);
  }

  std::mt19937 random_;
};

std::size_t size_of(const Expression& expression) {
  std::size_t size = 1;
  for (const Expression& operand : expression.operands)
    size += size_of(operand);
  return size;
}

}  // namespace

TEST_CASE("simplified expressions give the same values") {
  std::size_t saved = 0;
  for (unsigned seed = 0; seed < 3000; ++seed) {
    const Expression before = Maker(seed).truth(3);
    Expression after = before;
    simplify(after);
    CHECK(size_of(after) <= size_of(before));
    saved += size_of(before) - size_of(after);
    for (const Value x : kValues)
      for (const Value y : kValues) {
        const oracle::Snapshot variables{{}, {oracle::number_of(x), oracle::number_of(y)}};
        if (evaluate(before, variables) == evaluate(after, variables)) continue;
        CAPTURE(seed, x, y);
        FAIL("another value");
      }
  }
  CHECK(saved > 3000);
}

TEST_CASE("a comparison of a computed number becomes one of what it was computed from") {
  // x / 8 < 0.5 is true up to 3.995, for 3.996 / 8 is rounded to 0.5.
  Expression mean = make(
      Operation::less, {make(Operation::divide, {variable_at(0), constant(8000)}), constant(500)});
  simplify(mean);
  CHECK(mean == make(Operation::less, {variable_at(0), constant(3996)}));

  Expression falling =
      make(Operation::less,
           {make(Operation::subtract, {constant(5000), variable_at(0)}), constant(2000)});
  simplify(falling);
  CHECK(falling == make(Operation::greater, {variable_at(0), constant(3000)}));

  Expression never =
      make(Operation::greater,
           {make(Operation::divide, {variable_at(0), constant(8000)}), constant(vm::kValueMax)});
  simplify(never);
  CHECK(never == make(Operation::less, {variable_at(0), constant(vm::kValueMin)}));
}

TEST_CASE("what draws, remembers or may divide by zero is not pure") {
  CHECK(is_pure(make(Operation::divide, {variable_at(0), constant(1)})));
  CHECK(!is_pure(make(Operation::divide, {variable_at(0), variable_at(1)})));
  CHECK(!is_pure(make(Operation::modulo, {variable_at(0), constant(0)})));
  CHECK(!is_pure(make(Operation::add,
                      {make(Operation::random, {variable_at(0), variable_at(1)}), constant(1)})));
  CHECK(!is_pure(make(Operation::held, {variable_at(0)})));
}
