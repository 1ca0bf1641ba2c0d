// Responses, part: statements that hold others, and the wait that is evaluated again and again.
//
// Shapes are those of opcodes.def and docs/bytecode.md; the verifier accepts no others.
#include <algorithm>

#include "compiler/codegen/response_emitter.hpp"

namespace robosync::compiler {
namespace {

// A part of a time counts as a time, as it does where the robot works out the number.
std::int64_t whole(vm::Value times) {
  constexpr std::int64_t kMost = vm::kValueMax / vm::kScale;
  return std::min(kMost, (std::int64_t{times} + vm::kScale - 1) / vm::kScale) * vm::kScale;
}

}  // namespace

std::size_t ResponseEmitter::open(Opcode opcode, Operand a, Operand b) {
  ++open_blocks_;
  if (open_blocks_ == vm::kMaxBlocks + 1)
    parts_.too_large("blocks are nested too deeply here for the robot", current_->span);
  return code().emit(opcode, a, b);
}

std::size_t ResponseEmitter::otherwise(std::size_t begin) {
  const std::size_t jump = code().emit(Opcode::jump);
  code().land(begin);
  return jump;
}

std::size_t ResponseEmitter::otherwise_to_same_end(std::size_t begin) {
  --open_blocks_;
  return otherwise(begin);
}

void ResponseEmitter::close(std::size_t begin) {
  code().land(begin);
  --open_blocks_;
}

void ResponseEmitter::close_around(Opcode opcode, Operand a, std::size_t begin) {
  code().emit(opcode, a, code().back_to(begin + 1));
  --open_blocks_;
}

// With the condition unknown neither side runs; without ELSE that comes by itself.
void ResponseEmitter::emit(const ProgramIf& choice) {
  if (choice.else_block.empty()) {
    const std::size_t begin = open_unless(choice.condition);
    block(choice.then_block);
    close(begin);
    return;
  }
  const Cell truth = expressions_.value(choice.condition);
  const std::size_t known = open(Opcode::unless_known, truth);
  const std::size_t begin = open(Opcode::unless, truth);
  block(choice.then_block);
  mark();
  const std::size_t jump = otherwise_to_same_end(begin);
  block(choice.else_block);
  code().land(jump);
  close(known);
}

void ResponseEmitter::emit(const ProgramRepeat& repeat) {
  switch (repeat.kind) {
    case RepeatKind::times:
      if (repeat.control.operation == Operation::constant) return repeat_constant_times(repeat);
      return repeat_times(repeat);
    case RepeatKind::while_:
      return repeat_while(repeat);
    case RepeatKind::forever:
      return repeat_forever(repeat);
  }
}

void ResponseEmitter::repeat_constant_times(const ProgramRepeat& repeat) {
  const std::int64_t times = whole(repeat.control.constant);
  if (times <= 0) return;
  const Cell counter = parts_.frame.add_local();
  const auto place = parts_.pool.constant(static_cast<vm::Value>(times));
  const std::size_t begin = open(Opcode::times, counter, static_cast<std::uint32_t>(place));
  block(repeat.body);
  mark();
  close_around(Opcode::again, counter, begin);
}

void ResponseEmitter::repeat_times(const ProgramRepeat& repeat) {
  const Cell counter = parts_.frame.add_local();
  expressions_.value_into(counter, repeat.control);
  const std::size_t any =
      open(Opcode::unless, expressions_.compare(Operation::greater, counter, 0, 0));
  const std::size_t begin = open(Opcode::times_v, counter, counter);
  block(repeat.body);
  mark();
  close_around(Opcode::again, counter, begin);
  close(any);
}

void ResponseEmitter::repeat_while(const ProgramRepeat& repeat) {
  const std::size_t first = open_unless(repeat.control);
  const std::size_t begin = open(Opcode::loop);
  block(repeat.body);
  mark();
  close_around(Opcode::around, expressions_.value(repeat.control), begin);
  close(first);
}

void ResponseEmitter::repeat_forever(const ProgramRepeat& repeat) {
  const std::size_t begin = open(Opcode::loop);
  block(repeat.body);
  mark();
  close_around(Opcode::around_always, {}, begin);
}

void ResponseEmitter::emit(const ProgramPick& pick) {
  if (pick.options.size() == 1) return block(pick.options.front().body);
  if (pick.options.empty()) return;
  std::int64_t total = 0;
  for (const ProgramOption& option : pick.options)
    total += option.weight;
  if (total > vm::kValueMax)
    return parts_.too_large("the shares of the options are too large together", current_->span);
  const Cell least = expressions_.constant(0, 0);
  const Cell most = expressions_.constant(static_cast<vm::Value>(total - 1), 1);
  const Cell drawn = parts_.frame.add_local();
  code().emit(Opcode::random, drawn, least, most);
  options(pick, drawn);
}

// Each option but the last is an IF whose ELSE holds those that follow; all end in the same place.
void ResponseEmitter::options(const ProgramPick& pick, Cell drawn) {
  std::vector<std::size_t> jumps;
  vm::Value share = 0;  // of the options so far
  for (const ProgramOption& option : pick.options) {
    share += option.weight;
    if (&option == &pick.options.back()) {
      block(option.body);
      break;
    }
    const std::size_t begin =
        open(Opcode::unless, expressions_.compare(Operation::less, drawn, share, 0));
    block(option.body);
    mark();
    jumps.push_back(jumps.empty() ? otherwise(begin) : otherwise_to_same_end(begin));
  }
  for (const std::size_t jump : jumps)
    code().land(jump);
  --open_blocks_;
}

void ResponseEmitter::emit(const ProgramWaitUntil& wait) {
  std::optional<Cell> deadline;
  if (wait.within) {
    deadline = parts_.frame.add_local();
    code().emit(Opcode::deadline, *deadline, expressions_.value(*wait.within));
  }
  const std::size_t poll = open(Opcode::poll);
  Cell truth = expressions_.value(wait.condition);
  if (deadline) {
    const std::uint32_t depth = truth.zone == Zone::temporary ? 1 : 0;
    const Cell late = parts_.frame.temporary(depth);
    code().emit(Opcode::reached, late, *deadline);
    const Cell either = parts_.frame.temporary(0);
    code().emit(Opcode::or_, either, truth, late);
    truth = either;
  }
  close_around(Opcode::until, truth, poll);
}

}  // namespace robosync::compiler
