#include "tests/fuzz/host_engine.hpp"

#include <algorithm>
#include <cstdlib>

namespace robosync::fuzz {

using vm::Machine;
using vm::Value;
using vm::Word;

void HostEngine::begin(const vm::Image& image) {
  image_ = &image;
  constants_ = constant_slot_.copy(image.constants.data(), image.constants.size());
  timers_ = timer_slot_.copy(image.timers.data(), image.timers.size());
}

Value* HostEngine::frame(std::size_t cells) {
  cells_ = cells;
  return frame_slot_.exact<Value>(cells);
}
std::uint32_t* HostEngine::timer_memory(std::size_t words) {
  timer_words_ = words;
  return memory_slot_.exact<std::uint32_t>(words);
}
Word* HostEngine::output(std::size_t words) {
  output_words_ = words;
  return output_slot_.exact<Word>(words);
}

// The object's words alone, and the two machines in the same state.
const Word* HostEngine::enter(Machine& machine, const CodeObject& object) {
  machine.constants = constants_;
  machine.timers = timers_;
  stepped_ = machine;
  std::copy_n(machine.frame, cells_, stepped_frame_.begin());
  std::copy_n(machine.timer_memory, timer_words_, stepped_memory_.begin());
  stepped_.frame = stepped_frame_.data();
  stepped_.timer_memory = stepped_memory_.data();
  stepped_.output = stepped_output_.data();
  stepped_.output_end = stepped_output_.data() + output_words_;
  return code_slot_.copy(image_->code.data() + object.start, object.length);
}

void HostEngine::compare(const Machine& machine) {
  const bool same = std::equal(machine.frame, machine.frame + cells_, stepped_frame_.begin()) &&
                    std::equal(machine.timer_memory, machine.timer_memory + timer_words_,
                               stepped_memory_.begin()) &&
                    machine.wake == stepped_.wake && machine.random == stepped_.random &&
                    machine.event == stepped_.event && machine.shifted == stepped_.shifted &&
                    machine.assigned == stepped_.assigned &&
                    machine.divided_by_zero == stepped_.divided_by_zero;
  if (!same) fail("word by word, the interpreter leaves something else");
}

Value HostEngine::evaluate(Machine& machine, const CodeObject& object, std::uint32_t& cost) {
  const Word* const code = enter(machine, object);
  Stepper stepper(*image_, image_->header->step_cost, *this);
  const Value expected = stepper.evaluate(stepped_, object, cost);
  const Value value = vm::evaluate(machine, code);
  if (value != expected) fail("word by word, a condition gives something else");
  compare(machine);
  return value;
}

Run HostEngine::respond(Machine& machine, const CodeObject& object, std::size_t from) {
  const Word* const code = enter(machine, object);
  Stepper stepper(*image_, image_->header->step_cost, *this);
  const Run expected = stepper.respond(stepped_, object, from);
  const Word* const output = machine.output;
  const vm::Progress progress = vm::respond(machine, code + from);
  compare(machine);
  Run run{progress.pause, 0, progress.wake, expected.cost};
  if (progress.next != nullptr) run.next = static_cast<std::size_t>(progress.next - code);
  if (run.pause != expected.pause || run.next != expected.next || run.wake != expected.wake)
    fail("word by word, a response pauses elsewhere");
  const Word* const stepped = stepped_output_.data();
  if (machine.output - output != stepped_.output - stepped ||
      !std::equal(output, static_cast<const Word*>(machine.output), stepped))
    fail("word by word, a response puts out something else");
  return run;
}

void HostEngine::fail(const char* what) {
  failed_(what);
  std::abort();
}

}  // namespace robosync::fuzz
