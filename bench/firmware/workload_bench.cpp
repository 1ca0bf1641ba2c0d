// Runs the first rule of a given image between markers, once for each reading: the workloads W1 to W3 (bench/programs), as the
// behaviour's thread runs them. After each run, prints the inputs and the number of output words, which bench/workloads.py
// checks.
//
// The image is verified first; a response that pauses is not a workload.
#include <array>
#include <span>

#include "bench/firmware/given.hpp"
#include "bench/firmware/mark.hpp"
#include "vm/image.hpp"
#include "vm/interpreter.hpp"
#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

namespace robosync::bench {
namespace {

using vm::Value;
using vm::Word;

constexpr std::uint32_t kStepMs = 50;
constexpr unsigned kUnused = 255;  // a cell that no behaviour has

std::array<Value, 256> frame;
std::array<Word, vm::kMaxResponseOutput> output;
std::array<std::uint32_t, 64> timer_memory;

bool verified(vm::Image& image) {
  const std::span bytes = given_image();
  BENCH_MARK(verify_begin);
  const vm::Verdict verdict = vm::verify(bytes, vm::Limits{}, image);
  BENCH_MARK(verify_end);
  const std::array why = {static_cast<std::int32_t>(verdict.refusal),
                          static_cast<std::int32_t>(verdict.section),
                          static_cast<std::int32_t>(verdict.index)};
  if (!verdict.ok()) say("refused", why);
  return verdict.ok();
}

// Variables start as the program says; channels are unknown until they are read. Returns the cell of the only channel that the
// rule reads; if there is none, a cell that is never read.
unsigned latch(const vm::Image& image, const vm::Behavior& behavior) {
  frame.fill(vm::kUnknown);
  unsigned reading = kUnused;
  for (unsigned i = 0; i < behavior.input_count; ++i) {
    const unsigned input = image.inputs[behavior.first_input + i];
    if (input < image.channels.size()) {
      reading = i;
    } else {
      frame[i] = image.variables[input - image.channels.size()].initial;
    }
  }
  return reading;
}

vm::Machine machine(const vm::Image& image, std::uint32_t now) {
  vm::Machine m;
  m.frame = frame.data();
  m.constants = image.constants.data();
  m.output = output.data();
  m.output_end = output.data() + output.size();
  m.timers = image.timers.data();
  m.timer_memory = timer_memory.data();
  m.now = now;
  return m;
}

// The code of a rule that runs in a step.
struct Code {
  const Word* condition;
  const Word* then_side;
  const Word* else_side;
};

// Rules of other kinds than WHEN respond whatever their condition gives; AT START has none.
Code code_of(const vm::Image& image, const vm::Rule& rule) {
  static constexpr std::array kNone = {vm::encode(vm::Opcode::ret, kUnused)};
  const bool chooses = rule.kind == vm::RuleKind::when && rule.else_response != vm::kNoIndex;
  const std::uint16_t otherwise = chooses ? rule.else_response : rule.then_response;
  const bool at_start = rule.kind == vm::RuleKind::start;
  return {at_start ? kNone.data() : &image.code[rule.condition_start],
          &image.code[image.responses[rule.then_response].start],
          &image.code[image.responses[otherwise].start]};
}

// Counts from setting the reading to the end of the response.
void run(vm::Machine& m, const Code& code, unsigned cell, Value reading) {
  BENCH_MARK(rule_begin);
  frame[cell] = reading;
  const Value truth = vm::evaluate(m, code.condition);
  const auto progress = vm::respond(m, truth == vm::kTrue ? code.then_side : code.else_side);
  BENCH_MARK(rule_end);
  if (progress.pause != vm::Pause::ended) leave(false);
}

void measure(const vm::Image& image) {
  const vm::Rule& rule = image.rules[0];
  const vm::Behavior& behavior = image.behaviors[0];
  const Code code = code_of(image, rule);
  const unsigned cell = latch(image, behavior);
  std::uint32_t now = 0;
  for (const Value reading : given_readings()) {
    now += kStepMs;
    vm::Machine m = machine(image, now);
    run(m, code, cell, reading);
    say("inputs", std::span(frame).first(behavior.input_count));
    const std::array words = {static_cast<std::int32_t>(m.output - output.data())};
    say("words", words);
  }
}

}  // namespace
}  // namespace robosync::bench

int main() {
  using namespace robosync;
  vm::Image image;
  if (!bench::verified(image)) bench::leave(false);
  if (!image.rules.empty()) bench::measure(image);
  bench::leave(true);
}
