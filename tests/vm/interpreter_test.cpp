// Every opcode, run by the interpreter: that it takes the operands it says and leaves the rest
// alone. What the arithmetic gives is arithmetic_test's matter.
#include "vm/interpreter.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/oracles/rsl/values.hpp"
#include "vm/arithmetic.hpp"
#include "vm/opcode.hpp"
#include "vm/output.hpp"

using namespace robosync::vm;
using Op = Opcode;
namespace oracle = robosync::oracle;

namespace {

constexpr Value kUntouched = 0x5A5A5A;
constexpr unsigned kResult = 250;  // far cells, so that operand bytes with the top bit are used
constexpr unsigned kLeft = 7;
constexpr unsigned kRight = 200;

Machine machine_of(Value* frame, const Value* constants) {
  Machine machine;
  machine.frame = frame;
  machine.constants = constants;
  return machine;
}

// Runs one instruction, with a frame around its operands, and checks that only the result changed.
Value run(Word instruction, Value left, Value right, std::span<const Value> constants = {}) {
  std::array<Value, kMaxCells> frame{};
  frame.fill(kUntouched);
  frame[kLeft] = left;
  frame[kRight] = right;
  const std::array<Word, 2> code{instruction, encode(Op::ret, kResult)};
  Machine machine = machine_of(frame.data(), constants.data());
  const Value result = evaluate(machine, code.data());
  CHECK(frame[kResult] == result);
  frame[kResult] = kUntouched;
  frame[kLeft] = frame[kRight] = kUntouched;
  CHECK(std::all_of(frame.begin(), frame.end(), [](Value v) { return v == kUntouched; }));
  return result;
}

Value binary(Opcode op, Value left, Value right) {
  return run(encode(op, kResult, kLeft, kRight), left, right);
}
Value unary(Opcode op, Value operand) {
  return run(encode(op, kResult, kLeft), operand, kUntouched);
}
Value with_constant(Opcode op, Value left, Value right) {
  std::array<Value, 256> constants{};
  constants.fill(kUntouched);
  constants[254] = right;
  return run(encode(op, kResult, kLeft, 254), left, kUntouched, constants);
}

const std::vector<Value> kOperands = {
    kUnknown, kValueMin, kValueMin + 1, -1500,   -1000,         -1,       0, 1, 500, 1000, 1500,
    2999,     3000,      3001,          1 << 30, kValueMax - 1, kValueMax};

template <typename Model>
void agrees(Opcode op, Model model) {
  INFO(kOpcodes[static_cast<std::size_t>(op)].name);
  for (const Value left : kOperands)
    for (const Value right : kOperands) {
      CAPTURE(left, right);
      CHECK(binary(op, left, right) == model(left, right));
    }
}

// A relation over 64 bits, unknown if an operand is.
template <typename Relation>
auto relation(Relation holds) {
  return [holds](Value left, Value right) {
    if (left == kUnknown || right == kUnknown) return kUnknown;
    return holds(std::int64_t{left}, std::int64_t{right}) ? kTrue : kFalse;
  };
}

template <typename Model>
void agrees_with_constant(Opcode op, Model model) {
  INFO(kOpcodes[static_cast<std::size_t>(op)].name);
  for (const Value left : kOperands)
    for (const Value right : kOperands) {
      if (right == kUnknown) continue;  // not in a verified image
      CAPTURE(left, right);
      CHECK(with_constant(op, left, right) == model(left, right));
    }
}

struct Out {
  std::array<Word, 8> words{};
  std::size_t length = 0;
};

Out respond_to(std::initializer_list<Word> code, std::size_t room = 8) {
  std::array<Value, kMaxCells> frame{};
  frame[kLeft] = -42;
  std::vector<Value> constants(300, kUntouched);
  constants[299] = 70 * kScale;
  Out output;
  output.words.fill(0xEEEEEEEE);
  Machine machine = machine_of(frame.data(), constants.data());
  machine.output = output.words.data();
  machine.output_end = output.words.data() + room;
  const Progress progress = respond(machine, std::data(code));
  CHECK(progress.pause == Pause::ended);
  CHECK(progress.next == nullptr);
  output.length = static_cast<std::size_t>(machine.output - output.words.data());
  CHECK(std::all_of(output.words.begin() + static_cast<std::ptrdiff_t>(output.length),
                    output.words.end(), [](Word w) { return w == 0xEEEEEEEE; }));
  return output;
}

std::vector<Word> words(const Out& output) {
  return {output.words.begin(), output.words.begin() + static_cast<std::ptrdiff_t>(output.length)};
}

}  // namespace

TEST_CASE("move and load copy any value, unknown as well") {
  for (const Value value : kOperands) {
    CHECK(unary(Op::move, value) == value);
    std::vector<Value> constants(0x1235, kUntouched);
    constants[0x1234] = value;
    CHECK(run(encode_wide(Op::load, kResult, 0x1234), 0, 0, constants) == value);
  }
}

TEST_CASE("arithmetic opcodes do what the naive arithmetic says") {
  agrees(Op::add, oracle::on_values(oracle::add));
  agrees(Op::sub, oracle::on_values(oracle::subtract));
  agrees(Op::mul, oracle::on_values(oracle::multiply));
  agrees(Op::div, oracle::on_values(oracle::divide));
  agrees(Op::mod, oracle::on_values(oracle::modulo));
  for (const Value value : kOperands)
    CHECK(unary(Op::neg, value) == oracle::value_of(oracle::negate(oracle::number_of(value))));
  agrees(Op::min, oracle::on_values(oracle::lesser));
  agrees(Op::max, oracle::on_values(oracle::greater));
  agrees(Op::round, oracle::on_values(oracle::to_multiple));
  for (const Value value : kOperands)
    CHECK(unary(Op::abs, value) == oracle::value_of(oracle::absolute(oracle::number_of(value))));
}

TEST_CASE("the lesser and the greater, unknown if the operand is") {
  const auto model = [](bool lesser) {
    return [lesser](Value left, Value right) {
      if (left == kUnknown) return kUnknown;
      return lesser ? std::min(left, right) : std::max(left, right);
    };
  };
  agrees_with_constant(Op::min_k, model(true));
  agrees_with_constant(Op::max_k, model(false));
}

TEST_CASE("a division by zero is noticed, an unknown is no zero") {
  const auto divided_by_zero = [](Op op, Value left, Value right) {
    std::array<Value, 2> frame{left, right};
    const std::array<Word, 2> code{encode(op, 0, 0, 1), encode(Op::ret_number, 0)};
    Machine machine = machine_of(frame.data(), nullptr);
    static_cast<void>(evaluate(machine, code.data()));
    return machine.divided_by_zero;
  };
  for (const Op op : {Op::div, Op::mod}) {
    CHECK(divided_by_zero(op, 1, 0));
    CHECK(divided_by_zero(op, 0, 0));
    CHECK_FALSE(divided_by_zero(op, 0, 1));
    CHECK_FALSE(divided_by_zero(op, kUnknown, 0));
    CHECK_FALSE(divided_by_zero(op, 1, kUnknown));
  }
}

TEST_CASE("comparisons are three-valued") {
  agrees(Op::lt, relation([](auto l, auto r) { return l < r; }));
  agrees(Op::le, relation([](auto l, auto r) { return l <= r; }));
  agrees(Op::eq, relation([](auto l, auto r) { return l == r; }));
  agrees(Op::ne, relation([](auto l, auto r) { return l != r; }));
  agrees_with_constant(Op::lt_k, relation([](auto l, auto r) { return l < r; }));
  agrees_with_constant(Op::le_k, relation([](auto l, auto r) { return l <= r; }));
  agrees_with_constant(Op::gt_k, relation([](auto l, auto r) { return l > r; }));
  agrees_with_constant(Op::ge_k, relation([](auto l, auto r) { return l >= r; }));
  agrees_with_constant(Op::eq_k, relation([](auto l, auto r) { return l == r; }));
  agrees_with_constant(Op::ne_k, relation([](auto l, auto r) { return l != r; }));
}

TEST_CASE("AND, OR and NOT are Kleene's") {
  // Rows and columns: false, unknown, true; Kleene's AND is the smaller in this order, OR the
  // larger.
  const std::array<Value, 3> truths{kFalse, kUnknown, kTrue};
  for (std::size_t left = 0; left < 3; ++left) {
    CHECK(unary(Op::not_, truths[left]) == truths[2 - left]);
    for (std::size_t right = 0; right < 3; ++right) {
      CHECK(binary(Op::and_, truths[left], truths[right]) == truths[std::min(left, right)]);
      CHECK(binary(Op::or_, truths[left], truths[right]) == truths[std::max(left, right)]);
    }
  }
}

TEST_CASE("an opcode may write the cell it reads") {
  std::array<Value, 2> frame{3 * kScale, 2 * kScale};
  const std::array<Word, 3> code{encode(Op::sub, 0, 0, 1), encode(Op::mul, 0, 0, 0),
                                 encode(Op::ret, 0)};
  Machine machine = machine_of(frame.data(), nullptr);
  CHECK(evaluate(machine, code.data()) == 1 * kScale);
}

TEST_CASE("responses put out their words in order") {
  const Word first = encode(Op::cmd, 1, 2, 3);
  const Word last = encode(Op::cmd_end, 4, 5, kNoWord);
  CHECK(words(respond_to({first, last, encode(Op::cmd, 9, 9, 9)})) ==
        std::vector<Word>{first, last});
  CHECK(words(respond_to({first, encode(Op::end), last})) == std::vector<Word>{first});
  CHECK(words(respond_to({encode(Op::end)})).empty());

  const Word arg_r = encode(Op::arg, 2, kLeft);
  const Word arg_c = encode_wide(Op::arg_k, 3, 299);
  CHECK(words(respond_to({arg_r, arg_c, last})) ==
        std::vector<Word>{arg_r, static_cast<Word>(-42), arg_c, 70 * kScale, last});
}

TEST_CASE("output that does not fit is dropped") {
  const Word first = encode(Op::cmd, 1, 2, 3);
  const Word param = encode(Op::arg, 2, kLeft);
  CHECK(words(respond_to({first, first, encode(Op::cmd_end)}, 2)) ==
        std::vector<Word>{first, first});
  CHECK(words(respond_to({encode(Op::cmd_end)}, 0)).empty());
  // A parameter without room for its value is dropped as a whole.
  CHECK(words(respond_to({first, param, encode(Op::end)}, 2)) == std::vector<Word>{first});
  CHECK(words(respond_to({first, encode_wide(Op::arg_k, 2, 299), encode(Op::end)}, 2)) ==
        std::vector<Word>{first});
}

TEST_CASE("several responses append to one output") {
  std::array<Word, 4> out{};
  const Word one = encode(Op::cmd_end, 1);
  const Word two = encode(Op::cmd_end, 2);
  Machine machine;
  machine.output = out.data();
  machine.output_end = out.data() + out.size();
  CHECK(respond(machine, &one).pause == Pause::ended);
  CHECK(respond(machine, &two).pause == Pause::ended);
  CHECK(machine.output == out.data() + 2);
  CHECK(out[0] == one);
  CHECK(out[1] == two);
}

TEST_CASE("the output reader gives each command its own parameters") {
  const auto to = static_cast<unsigned>(Param::to);
  const auto at = static_cast<unsigned>(Param::at);
  const Out output =
      respond_to({encode(Op::arg, to, kLeft), encode_wide(Op::arg_k, at, 299),
                  encode(Op::cmd, 1, 2, 3), encode(Op::cmd_end, kGroupBit, 4, kNoWord)});
  Params params{};
  OutputReader reader(std::span(output.words).first(output.length), params);
  Output command;
  REQUIRE(reader.next(command));
  CHECK(command.kind == OutputKind::command);
  CHECK(command.target == 1);
  CHECK(command.verb == 2);
  CHECK(command.word == 3);
  CHECK(command.given == (1U << to | 1U << at));
  CHECK(params[to] == -42);
  CHECK(params[at] == 70 * kScale);
  REQUIRE(reader.next(command));
  CHECK(command.target == kGroupBit);
  CHECK(command.word == kNoWord);
  CHECK(command.given == 0);
  CHECK_FALSE(reader.next(command));
}

TEST_CASE("the output reader stops at what no response puts out") {
  Output command;
  Params params{};
  for (const std::vector<Word>& words : {std::vector<Word>{encode(Op::arg, 0, 0)},
                                         {encode(Op::arg, 8, 0), 1, encode(Op::cmd)},
                                         {encode(Op::add, 0, 0, 0), encode(Op::cmd)},
                                         {0xFFFFFFFF, encode(Op::cmd)}}) {
    OutputReader reader(words, params);
    CHECK_FALSE(reader.next(command));
    CHECK_FALSE(reader.next(command));
  }
}

TEST_CASE("the output reader gives texts and halts, each with what was given to it") {
  const Out output = respond_to({encode(Op::arg, 1, kLeft), encode_wide(Op::log, 0, 0x1234),
                                 encode_wide(Op::alert, 0, 0xFFFE), encode(Op::halt, kAllActuators),
                                 encode(Op::end)});
  Params params{};
  OutputReader reader(std::span(output.words).first(output.length), params);
  Output said;
  REQUIRE(reader.next(said));
  CHECK(said.kind == OutputKind::log);
  CHECK(said.text == 0x1234);
  CHECK(said.given == 0b10);
  CHECK(params[1] == -42);
  REQUIRE(reader.next(said));
  CHECK(said.kind == OutputKind::alert);
  CHECK(said.text == 0xFFFE);
  CHECK(said.given == 0);
  REQUIRE(reader.next(said));
  CHECK(said.kind == OutputKind::halt);
  CHECK(said.target == kAllActuators);
  CHECK_FALSE(reader.next(said));
}

// ---- what a TIMER is made of

namespace {

struct Asked {
  Value result;
  std::uint32_t wake;
};

Asked at_time(std::uint32_t now, Word instruction, Value begin, Value length) {
  std::array<Value, kMaxCells> frame{};
  frame[kLeft] = begin;
  frame[kRight] = length;
  const std::array<Word, 2> code{instruction, encode(Op::ret_number, kResult)};
  Machine machine = machine_of(frame.data(), nullptr);
  machine.now = now;
  const Value result = evaluate(machine, code.data());
  return {result, machine.wake};
}

Value begun(std::uint32_t now) {
  return at_time(now, encode(Op::now, kResult), 0, 0).result;
}
Value elapsed(std::uint32_t now, Value begin) {
  return at_time(now, encode(Op::elapsed, kResult, kLeft), begin, 0).result;
}
Asked lasted(std::uint32_t now, Value begin, Value length) {
  return at_time(now, encode(Op::lasted, kResult, kLeft, kRight), begin, length);
}

}  // namespace

TEST_CASE(
    "the time since a moment counts milliseconds, over the wrap as well, and stays at its end") {
  for (const std::uint32_t begin : {0U, 1U, 5000U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFF0U}) {
    CAPTURE(begin);
    const Value moment = begun(begin);
    CHECK(moment != kUnknown);  // which SET would not take
    const Value early = begin == 0x80000000U ? 1 : 0;
    for (const Value later : {0, 1, 30'000, kValueMax - 1})
      CHECK(elapsed(begin + static_cast<std::uint32_t>(later), moment) == later + early);
    CHECK(elapsed(begin + 0x80000000U, moment) == kValueMax);
    CHECK(elapsed(begin + 0xFFFFFFFEU, moment) == kValueMax);
  }
}

TEST_CASE("a time has lasted from its last millisecond on, and until then it wakes the machine") {
  for (const std::uint32_t begin : {0U, 5000U, 0xFFFFFFF0U}) {
    CAPTURE(begin);
    const Value moment = begun(begin);
    for (const std::uint32_t later : {0U, 1U, 29U}) {
      const Asked asked = lasted(begin + later, moment, 30);
      CHECK(asked.result == kFalse);
      CHECK(asked.wake == begin + 30);
    }
    for (const std::uint32_t later : {30U, 31U, 0x7FFFFFFFU, 0xFFFFFFFEU}) {
      const Asked asked = lasted(begin + later, moment, 30);
      CHECK(asked.result == kTrue);
      CHECK(asked.wake == Machine::kNever);
    }
  }
  CHECK(lasted(7, 0, 0).result == kTrue);
  CHECK(lasted(7, 0, kValueMin).result == kTrue);
  CHECK(lasted(7, 0, kUnknown).result == kUnknown);
  CHECK(lasted(7, 0, kUnknown).wake == Machine::kNever);
  CHECK(lasted(7, 0, kValueMax).wake == kValueMax);
  CHECK(lasted(7, kUnknown, 5).result ==
        kTrue);  // no TIMER holds that; it is a time like any other
}
