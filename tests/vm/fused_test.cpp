// The opcodes of hot loops: arithmetic with constants, arithmetic that looks at nothing, and
// comparisons that jump. Against models in 64 bits.
#include <array>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/vm/response_checks.hpp"
#include "vm/arithmetic.hpp"
#include "vm/interpreter.hpp"
#include "vm/opcode.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using namespace robosync::vm::test::response;

namespace {

const std::vector<Value> kSamples = {
    kUnknown, kValueMin,     kValueMin + 1, -123456789, -251000, -3000, -1500,  -1001,
    -1000,    -999,          -500,          -3,         -1,      0,     1,      2,
    499,      500,           501,           1000,       1500,    3000,  251000, 123456789,
    1 << 30,  kValueMax / 2, kValueMax - 1, kValueMax};

// Runs the word with cells 0 and 1, constant 1 and the result in cell 2.
Value run(Op op, Value left, Value right) {
  std::array<Value, 3> frame{left, right, 77};
  const std::array<Value, 2> constants{99, right};
  const std::array<Word, 2> code{encode(op, 2, 0, 1), encode(Op::ret_number, 2)};
  Machine machine;
  machine.frame = frame.data();
  machine.constants = constants.data();
  const Value result = evaluate(machine, code.data());
  CHECK(frame[0] == left);
  CHECK(frame[1] == right);
  return result;
}

// The lower 32 bits.
Value wrapped(std::int64_t value) {
  return static_cast<Value>(static_cast<std::uint32_t>(value));
}
Value saturated(std::int64_t value) {
  if (value > kValueMax) return kValueMax;
  return value < kValueMin ? kValueMin : static_cast<Value>(value);
}

template <typename Model>
void agrees(Op op, Model model, bool (*allowed)(Value)) {
  INFO(kOpcodes[static_cast<std::size_t>(op)].name);
  for (const Value left : kSamples)
    for (const Value right : kSamples) {
      if (!allowed(right)) continue;
      CAPTURE(left, right);
      CHECK(run(op, left, right) == model(std::int64_t{left}, std::int64_t{right}));
    }
}

constexpr bool is_any(Value) {
  return true;
}
constexpr bool is_known(Value value) {
  return value != kUnknown;
}
constexpr bool is_positive(Value value) {
  return value > 0;
}

// A quotient of integers, rounded half away from zero.
Value rounded(std::int64_t left, std::int64_t right) {
  const std::int64_t twice = 2 * (left < 0 ? -left : left);
  const std::int64_t size = (twice + right) / (2 * right);
  return static_cast<Value>(left < 0 ? -size : size);
}

enum class Order { lt, le, gt, ge, eq, ne };

bool holds(Order order, Value left, Value right) {
  if (left == kUnknown || right == kUnknown) return false;
  switch (order) {
    case Order::lt:
      return left < right;
    case Order::le:
      return left <= right;
    case Order::gt:
      return left > right;
    case Order::ge:
      return left >= right;
    case Order::eq:
      return left == right;
    case Order::ne:
      return left != right;
  }
  return false;
}

// How many of the 255 words behind it does the branch skip?
std::ptrdiff_t skipped(Word word, Value left, Value right) {
  std::vector<Word> code(257, encode(Op::wait_done));
  code[0] = word;
  std::array<Value, 2> frame{left, right};
  const std::array<Value, 2> constants{99, right};
  Machine machine;
  machine.frame = frame.data();
  machine.constants = constants.data();
  return respond(machine, code.data()).next - code.data() - 2;
}

struct Branch {
  Op op;
  Order order;
  bool constant;
};
constexpr Branch kBranches[] = {
    {Op::unless_lt, Order::lt, false},  {Op::unless_le, Order::le, false},
    {Op::unless_eq, Order::eq, false},  {Op::unless_ne, Order::ne, false},
    {Op::unless_lt_k, Order::lt, true}, {Op::unless_le_k, Order::le, true},
    {Op::unless_gt_k, Order::gt, true}, {Op::unless_ge_k, Order::ge, true},
    {Op::unless_eq_k, Order::eq, true}, {Op::unless_ne_k, Order::ne, true}};

}  // namespace

TEST_CASE("arithmetic with a constant saturates, and knows the unknown") {
  agrees(
      Op::add_k, [](auto l, auto r) { return l == kUnknown ? kUnknown : saturated(l + r); },
      is_known);
  agrees(
      Op::div_k, [](auto l, auto n) { return l == kUnknown ? kUnknown : rounded(l, n); },
      is_positive);
  agrees(
      Op::mod_k,
      [](auto l, auto r) { return l == kUnknown ? kUnknown : static_cast<Value>((l % r + r) % r); },
      is_positive);
}

TEST_CASE("what looks at nothing gives the lower 32 bits, whatever its operands") {
  agrees(
      Op::add_fast, [](auto l, auto r) { return wrapped(l + r); }, is_any);
  agrees(
      Op::add_k_fast, [](auto l, auto r) { return wrapped(l + r); }, is_known);
  agrees(
      Op::mul_fast, [](auto l, auto r) { return wrapped(l / 1000 * r); }, is_any);
  agrees(
      Op::mul_k_fast, [](auto l, auto n) { return wrapped(l * n); }, is_known);
}

TEST_CASE("where it was proved to fit, the fast arithmetic is the careful one") {
  for (const Value left : {-3000, 0, 1000, 46000})
    for (const Value right : {-46000, -999, 0, 1, 251000}) {
      CHECK(run(Op::add_fast, left, right) == add(left, right));
      CHECK(run(Op::add_k_fast, left, right) == add(left, right));
      CHECK(run(Op::mul_fast, left, right) == multiply(left, right));
      CHECK(run(Op::mul_k_fast, right, left / kScale) == multiply(left, right));
    }
}

TEST_CASE("a branch goes on if its comparison is true, and skips if it is false or unknown") {
  for (const Branch& branch : kBranches) {
    INFO(kOpcodes[static_cast<std::size_t>(branch.op)].name);
    const Word word = encode(branch.op, 0, 1, 200);
    for (const Value left : kSamples)
      for (const Value right : kSamples) {
        if (branch.constant && right == kUnknown) continue;  // not in a verified image
        CAPTURE(left, right);
        CHECK(skipped(word, left, right) == (holds(branch.order, left, right) ? 0 : 200));
      }
    for (const unsigned distance : {0U, 1U, 255U})
      CHECK(skipped(encode(branch.op, 0, 1, distance), kUnknown, 1) == distance);
  }
}

TEST_CASE("a branch begins a block that ends where it leads") {
  for (const Branch& branch : kBranches) {
    INFO(kOpcodes[static_cast<std::size_t>(branch.op)].name);
    const auto to = [&](unsigned ahead) { return encode(branch.op, 1, kThree, ahead); };
    accepted({to(0), kEnd});
    accepted({to(2), kCommand, jump(1), kCommand, kEnd});
    refused(Refusal::bad_jump, 0, {to(1), kEnd});
    refused(Refusal::bad_jump, 0, {to(255), kEnd});
    refused(Refusal::bad_jump, 1, {to(2), to(2), kCommand, kCommand, kEnd});
    refused(Refusal::bad_jump, 3, {times(kThree), to(2), kCommand, again(3), kEnd});
    refused(Refusal::endless, 3, {encode(Op::loop), to(1), kWait, forever(3), kEnd});
    CHECK(found_cost({to(1), kCommand, kEnd}) == cost({to(1), kCommand, kEnd}));
  }
}

TEST_CASE("a branch's operands are cells and constants, and are checked") {
  for (const Branch& branch : kBranches) {
    INFO(kOpcodes[static_cast<std::size_t>(branch.op)].name);
    refused(Refusal::bad_operand, 0, {encode(branch.op, 10, 0, 0), kEnd});
    refused(Refusal::unset_cell, 0, {encode(branch.op, kRegister, 0, 0), kEnd});
    refused(branch.constant ? Refusal::bad_operand : Refusal::unset_cell, 0,
            {encode(branch.op, 1, kRegister, 0), kEnd});
    refused(Refusal::bad_operand, 0, {encode(branch.op, 1, 10, 0), kEnd});
  }
}

TEST_CASE("registers are carried into the block of a branch, and lost at its end") {
  const Word write = encode(Op::move, kRegister, 1);
  const Word read = encode(Op::move, kRegister + 1, kRegister);
  for (const Branch& branch : kBranches) {
    const Word word = encode(branch.op, 1, kThree, 1);
    accepted({write, word, read, kEnd});
    refused(Refusal::unset_cell, 3, {write, word, read, read, kEnd});
  }
}

TEST_CASE("a constant that divides is above zero") {
  for (const Op op : {Op::div_k, Op::mod_k}) {
    accepted({encode(op, kRegister, 1, kTwo), kEnd});
    for (const unsigned constant : {unsigned{kZero}, unsigned{kLess}, 6U, 255U})
      refused(Refusal::bad_operand, 0, {encode(op, kRegister, 1, constant), kEnd});
  }
  for (const Op op : {Op::add_k, Op::add_k_fast, Op::mul_k_fast}) {
    for (const unsigned constant : {kTwo, kZero, kLess})
      accepted({encode(op, kRegister, 1, constant), kEnd});
    for (const unsigned constant : {6U, 255U})
      refused(Refusal::bad_operand, 0, {encode(op, kRegister, 1, constant), kEnd});
  }
}

TEST_CASE("the hot loop of a sum is accepted, and costs what its rounds cost") {
  // i and s are visitors; in this frame there is one variable.
  const Code code{encode(Op::set, 0, 0),
                  times(kThree),
                  encode(Op::mul_fast, kRegister, 0, 0),
                  encode(Op::mod_k, kRegister, kRegister, kTwo),
                  encode(Op::add_fast, 0, 0, kRegister),
                  encode(Op::add_k_fast, 0, 0, kTwo),
                  again(5),
                  kEnd};
  accepted(code);
  const Code body(code.begin() + 2, code.end() - 1);
  CHECK(found_cost(code) == cost(code) + 2 * cost(body));
}
