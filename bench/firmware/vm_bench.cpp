// Runs each opcode of the shipped VM alone between markers, with operands from the edges of their range.
//
// bench/figures.py reads the counts; the markers are in the order of opcodes.def.
#include <array>

#include "bench/firmware/mark.hpp"
#include "vm/interpreter.hpp"
#include "vm/opcode.hpp"

namespace robosync::bench {
namespace {

using vm::Value;
using vm::Word;

std::array<Value, 256> frame;
std::array<Word, 64> output;
std::array<std::uint32_t, vm::kMaxEdges + 1> timer_memory;
vm::Timer timer;

vm::Machine machine(const Value* constants) {
  vm::Machine m;
  m.frame = frame.data();
  m.constants = constants;
  m.output = output.data();
  m.output_end = output.data() + output.size();
  m.timers = &timer;
  m.timer_memory = timer_memory.data();
  m.now = 1000;
  m.wake = 5000;  // so that an earlier time must be compared with it
  return m;
}

constexpr std::array<Value, 16> kEdges = {
    0,    1,     -1,        499,        500,     1000,          -1000,         -1500,
    3000, 46341, 123456789, -987654321, 0x7FFFF, vm::kValueMax, vm::kValueMin, vm::kUnknown};

void count_condition(vm::Machine& m, const Word* code) {
  BENCH_MARK(condition_begin);
  const Value result = vm::evaluate(m, code);
  BENCH_MARK(condition_end);
  frame[3] = result;
}

void count_response(vm::Machine& m, const Word* code) {
  BENCH_MARK(response_begin);
  const vm::Progress progress = vm::respond(m, code);
  BENCH_MARK(response_end);
  frame[3] = static_cast<Value>(progress.wake);
}

// The memory of a time word, in as many ways as there are edges: for each kind, all that take another path through its code. The
// machine's time is 1000.
void fill_timer(vm::Opcode opcode, unsigned way) {
  timer = {vm::timer_kind_of(opcode), vm::kMaxEdges, 0, 100};
  constexpr std::uint32_t kOld = 800;
  constexpr std::uint32_t kRecent = 950;
  constexpr std::array<std::uint32_t, 4> kDue = {0, 900, 1100, UINT32_MAX};
  switch (timer.kind) {
    case vm::TimerKind::held:
      timer_memory[0] = kDue[way % kDue.size()];
      break;
    case vm::TimerKind::counted:
      timer_memory[0] = vm::kMaxEdges - 1;
      for (unsigned i = 1; i < timer_memory.size(); ++i)
        timer_memory[i] = i <= way ? kOld : kRecent;
      break;
    case vm::TimerKind::sequence:
      timer_memory[0] = (way & 8U) != 0 ? kOld : kRecent;
      timer_memory[1] = way & 7U;
      break;
    case vm::TimerKind::changed:
      timer_memory[0] = static_cast<std::uint32_t>(kEdges[way]) ^ 0x80000000U;
      break;
    default:
      timer_memory[0] = way % 3;
  }
}

constexpr bool is_constant(vm::Operand kind) {
  return vm::widened(kind) == vm::Operand::const8;
}
constexpr bool has_constant(const vm::OpcodeInfo& info) {
  return is_constant(info.operands[1]) || is_constant(info.operands[2]);
}

// True if the verifier allows this constant.
constexpr bool is_allowed(const vm::OpcodeInfo& info, Value constant) {
  const bool positive = vm::is_positive(info.operands[1]) || vm::is_positive(info.operands[2]);
  return positive ? constant > 0 : constant != vm::kUnknown;
}

// Operands are in cells 0 and 1 and constant 0; the result goes to cell 2. Jumps skip nothing.
constexpr Word word_of(vm::Opcode opcode) {
  const vm::OpcodeInfo& info = vm::info_of(opcode);
  const unsigned right = has_constant(info) || info.operands[2] == vm::Operand::timer ? 0 : 1;
  if (info.operands[2] == vm::Operand::ahead8) return vm::encode(opcode, 0, right, 0);
  const unsigned a = info.operands[0] == vm::Operand::param ? 0 : 2;
  return vm::is_wide(info.operands[1]) ? vm::encode_wide(opcode, a, 0)
                                       : vm::encode(opcode, a, 0, right);
}

// Runs the opcode before a terminator, or as the terminator. Truth operands have only three values; the others do no harm.
void measure_opcode(vm::Opcode opcode) {
  const vm::OpcodeInfo& info = vm::info_of(opcode);
  const bool in_conditions = (static_cast<unsigned>(info.contexts) & 1) != 0;
  const bool in_responses = (static_cast<unsigned>(info.contexts) & 6) != 0;
  const Word word = word_of(opcode);
  const std::array condition = {word, vm::encode(vm::Opcode::ret, 2)};
  const std::array response = {word, vm::encode(vm::Opcode::end)};
  const bool timed = info.operands[2] == vm::Operand::timer;
  const unsigned ways = timed ? kEdges.size() : 1;
  for (const Value left : kEdges) {
    for (const Value& right : kEdges) {
      if (has_constant(info) && !is_allowed(info, right)) continue;
      for (unsigned way = 0; way < ways; ++way) {
        frame[0] = left;
        frame[1] = frame[2] = right;
        if (timed) fill_timer(opcode, way);
        vm::Machine m = machine(&right);
        if (in_conditions) count_condition(m, condition.data());
        if (in_responses) count_response(m, response.data());
      }
    }
  }
}

void measure_opcodes() {
  for (unsigned i = 0; i < static_cast<unsigned>(vm::Opcode::count_); ++i) {
    BENCH_MARK(next_opcode);
    measure_opcode(static_cast<vm::Opcode>(i));
  }
}

}  // namespace
}  // namespace robosync::bench

int main() {
  robosync::bench::measure_opcodes();
  robosync::bench::leave(true);
}
