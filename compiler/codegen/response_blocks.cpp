// Responses, part: statements that hold others, and the wait that is evaluated again and again.
//
// Shapes are those of opcodes.def and docs/bytecode.md; the verifier accepts no others.
#include <algorithm>

#include "compiler/codegen/response_emitter.hpp"
#include "compiler/optimize/expression_facts.hpp"

namespace robosync::compiler {
namespace {

// An AND becomes blocks in blocks as long as so many places for blocks are left.
constexpr unsigned kSpareBlocks = vm::kMaxBlocks / 2;

}  // namespace

void ResponseEmitter::count_block() {
  ++open_blocks_;
  if (open_blocks_ == vm::kMaxBlocks + 1)
    parts_.too_large("blocks are nested too deeply here for the robot", current_->span);
}

std::size_t ResponseEmitter::open(Opcode opcode, Operand a, Operand b) {
  count_block();
  return code().emit(opcode, a, b);
}

std::size_t ResponseEmitter::open_unless(const Expression& condition) {
  if (parts_.program.optimized)
    if (const auto jump = expressions_.jump_unless(condition)) {
      count_block();
      return *jump;
    }
  return open(Opcode::unless, expressions_.value(condition));
}

std::size_t ResponseEmitter::open_unless(Operation comparison, Cell left, vm::Value right) {
  if (parts_.program.optimized)
    if (const auto jump = expressions_.jump_unless(comparison, left, right)) {
      count_block();
      return *jump;
    }
  return open(Opcode::unless, expressions_.compare(comparison, left, right, 0));
}

// The right side is left out when the left one is not true, so nobody may notice that.
std::vector<std::size_t> ResponseEmitter::open_unless_all(const Expression& condition) {
  const bool splits = parts_.program.optimized && open_blocks_ < kSpareBlocks &&
                      condition.operation == Operation::logical_and &&
                      is_pure(condition.operands[1]);
  if (!splits) return {open_unless(condition)};
  std::vector<std::size_t> begins = open_unless_all(condition.operands[0]);
  for (const std::size_t inner : open_unless_all(condition.operands[1]))
    begins.push_back(inner);
  return begins;
}

std::size_t ResponseEmitter::otherwise(std::size_t begin) {
  code().emit(Opcode::jump);
  code().land(begin);
  return code().size() - 1;
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
    const std::vector<std::size_t> begins = open_unless_all(choice.condition);
    block(choice.then_block);
    std::for_each(begins.rbegin(), begins.rend(), [this](std::size_t begin) { close(begin); });
    return;
  }
  if (parts_.program.optimized && choice.condition.fact.known) {
    const std::size_t begin = open_unless(choice.condition);
    block(choice.then_block);
    mark();
    const std::size_t jump = otherwise(begin);
    block(choice.else_block);
    return close(jump);
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
      if (constant_count(repeat)) return repeat_constant_times(repeat);
      return repeat_times(repeat);
    case RepeatKind::while_:
      return repeat_while(repeat);
    case RepeatKind::forever:
      return repeat_forever(repeat);
  }
}

void ResponseEmitter::repeat_constant_times(const ProgramRepeat& repeat) {
  const vm::Value times = constant_count(repeat).value_or(0);
  if (times == 0) return;
  write_ahead(repeat);
  const Cell counter = parts_.frame.add_local();
  const auto place = parts_.pool.constant(times);
  const std::size_t begin = open(Opcode::times, counter, static_cast<std::uint32_t>(place));
  block(repeat.body);
  mark();
  close_around(Opcode::again, counter, begin);
}

// To what they are: the loop certainly writes them, and then need not say so in each round.
void ResponseEmitter::write_ahead(const ProgramRepeat& repeat) {
  const auto write = [this](Opcode opcode, std::size_t variable) {
    const Cell target = parts_.frame.write(parts_.tables.variable(variable));
    code().emit(opcode, target, target);
  };
  for (const std::size_t variable : repeat.assigned)
    write(Opcode::set, variable);
  for (const std::size_t variable : repeat.shifted)
    write(Opcode::shift, variable);
}

void ResponseEmitter::repeat_times(const ProgramRepeat& repeat) {
  const Cell counter = parts_.frame.add_local();
  expressions_.value_into(counter, repeat.control);
  const std::size_t any = open_unless(Operation::greater, counter, 0);
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
    const std::size_t begin = open_unless(Operation::less, drawn, share);
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
