// Runs the shipped VM between markers: the verifier and the first rule of an image that QEMU's
// loader has put into RAM, then each opcode alone over operands from the edges of its range.
//
// bench/bench.py reads the counts; the order of the markers is the order of opcodes.def.
#include <array>
#include <cstring>
#include <span>

#include "bench/firmware/mark.hpp"
#include "vm/image.hpp"
#include "vm/interpreter.hpp"
#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

namespace robosync::bench {
namespace {

using vm::Value;
using vm::Word;

// bench.py: -device loader,file=IMAGE,addr=0x21000000,force-raw=on
const auto* const kImage = reinterpret_cast<const std::byte*>(0x21000000);

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
  m.wake = 5000;  // so that a sooner time must be compared with it
  return m;
}

bool measure_verifier(vm::Image& image) {
  vm::ImageHeader header;
  std::memcpy(&header, kImage, sizeof header);
  const std::span bytes(kImage, header.total_length);
  BENCH_MARK(verify_begin);
  const vm::Verdict verdict = vm::verify(bytes, vm::Limits{}, image);
  BENCH_MARK(verify_end);
  return verdict.ok();
}

// W1: from setting the reading to both outputs done, once for each side of the paper's rule.
bool measure_rule(const vm::Image& image) {
  const vm::Rule& rule = image.rules[0];
  const Word* const condition = &image.code[rule.condition_start];
  const Word* const do_side = &image.code[image.responses[rule.then_response].start];
  const Word* const else_side = &image.code[image.responses[rule.else_response].start];
  for (const Value reading : {0, 1000, 2000, 3000, 4000, 5000}) {
    vm::Machine m = machine(image.constants.data());
    BENCH_MARK(rule_begin);
    frame[0] = reading;
    const Value truth = vm::evaluate(m, condition);
    (void)vm::respond(m, truth == vm::kTrue ? do_side : else_side);
    BENCH_MARK(rule_end);
    if (m.output != output.data() + 2) return false;  // the two commands of either response
  }
  return true;
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

// For a time word: its timer, full of what it may remember, of which `old` is too long ago.
void fill_timer(vm::Opcode opcode, unsigned old) {
  const unsigned place = static_cast<unsigned>(opcode) - static_cast<unsigned>(vm::Opcode::held);
  if (place >= static_cast<unsigned>(vm::TimerKind::count_)) return;
  timer = {static_cast<vm::TimerKind>(place), vm::kMaxEdges, 0, 100};
  for (unsigned i = 1; i < timer_memory.size(); ++i)
    timer_memory[i] = i <= old ? 800 : 950;
  timer_memory[0] = timer.kind == vm::TimerKind::counted ? vm::kMaxEdges - 1 : old;
}

constexpr bool has_constant(const vm::OpcodeInfo& info) {
  return info.operands[1] == vm::Operand::const8 || info.operands[2] == vm::Operand::const8;
}

// Does the verifier allow this constant?
constexpr bool is_allowed(vm::Opcode opcode, Value constant) {
  const bool divides = opcode == vm::Opcode::div_k || opcode == vm::Opcode::mod_k;
  return divides ? constant > 0 : constant != vm::kUnknown;
}

// Operands are in cells 0 and 1 and constant 0, the result goes to cell 2. Jumps skip nothing.
constexpr Word word_of(vm::Opcode opcode) {
  const vm::OpcodeInfo& info = vm::kOpcodes[static_cast<std::size_t>(opcode)];
  const unsigned right = has_constant(info) || info.operands[2] == vm::Operand::timer ? 0 : 1;
  if (info.operands[2] == vm::Operand::ahead8) return vm::encode(opcode, 0, right, 0);
  const unsigned a = info.operands[0] == vm::Operand::param ? 0 : 2;
  return vm::is_wide(info.operands[1]) ? vm::encode_wide(opcode, a, 0)
                                       : vm::encode(opcode, a, 0, right);
}

// The opcode before a terminator, or as the terminator. Truth operands only have their three
// values; more do not hurt.
void measure_opcode(vm::Opcode opcode) {
  const vm::OpcodeInfo& info = vm::kOpcodes[static_cast<std::size_t>(opcode)];
  const bool in_conditions = (static_cast<unsigned>(info.contexts) & 1) != 0;
  const bool in_responses = (static_cast<unsigned>(info.contexts) & 6) != 0;
  const Word word = word_of(opcode);
  const std::array condition = {word, vm::encode(vm::Opcode::ret, 2)};
  const std::array response = {word, vm::encode(vm::Opcode::end)};
  for (const Value left : kEdges) {
    for (const Value right : kEdges) {
      if (has_constant(info) && !is_allowed(opcode, right)) continue;
      frame[0] = left;
      frame[1] = frame[2] = right;
      fill_timer(opcode, static_cast<unsigned>(&right - kEdges.data()));
      vm::Machine m = machine(&right);
      if (in_conditions) count_condition(m, condition.data());
      if (in_responses) count_response(m, response.data());
    }
  }
}

void measure_opcodes() {
  for (unsigned i = 0; i < static_cast<unsigned>(vm::Opcode::count_); ++i) {
    BENCH_MARK(next_opcode);
    measure_opcode(static_cast<vm::Opcode>(i));
  }
}

// The size of what a thread needs to run code, as a symbol.
void record_sizes() {
  asm volatile(".global size_machine\n.equ size_machine, %c0" ::"i"(sizeof(vm::Machine)));
}

}  // namespace
}  // namespace robosync::bench

int main() {
  robosync::bench::record_sizes();
  robosync::vm::Image image;
  if (!robosync::bench::measure_verifier(image)) robosync::bench::leave(false);
  if (!robosync::bench::measure_rule(image)) robosync::bench::leave(false);
  robosync::bench::measure_opcodes();
  robosync::bench::leave(true);
}
