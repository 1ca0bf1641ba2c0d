// Blocks have the shapes that opcodes.def and docs/bytecode.md define; the verifier accepts no others.
#include "compiler/codegen/response_emitter.hpp"

#include <algorithm>
#include <utility>

#include "compiler/codegen/expression_emitter.hpp"
#include "compiler/ir/walk.hpp"

namespace robosync::compiler {
namespace {

// An AND becomes nested blocks while fewer than this many blocks are open.
constexpr unsigned kSpareBlocks = vm::kMaxBlocks / 2;

// The number of a local that stands for a variable's cell, unclamped. No response has that many locals.
constexpr std::size_t kItsCell = SIZE_MAX;

// The sum that RAISE and LOWER build up, which the next step clamps.
Expression sum_of(const ir::Set& set) {
  Expression before;
  before.operation = Operation::local;
  before.index = kItsCell;
  before.fact = set.before;
  Expression sum;
  sum.operation = Operation::add;
  sum.operands = {std::move(before), set.value};
  return sum;
}

// To `load`, these constants are truth values, which a variable must not hold.
bool looks_like_truth(vm::Value constant) {
  return constant == vm::kTrue || constant == vm::kFalse;
}

// ---- nesting of blocks

unsigned blocks_in(const ir::Block& block);

// The nesting depth of blocks in the code of a statement, including the blocks inside it. A statement without blocks has depth 0,
// unless an overload below says otherwise.
template <typename Node>
unsigned blocks_of(const Node& node) {
  for_each_block(node, [](auto& block) {
    static_assert(std::is_void_v<decltype(block)>, "how many blocks does it open around this one?");
  });
  return 0;
}

unsigned blocks_of(const ir::WaitUntil&) {
  return 1;
}

unsigned blocks_of(const ir::Follow& follow) {
  return blocks_in(follow.body) + 1;
}

unsigned blocks_of(const ir::If& choice) {
  const bool asks_if_known = !choice.else_block.empty() && !choice.condition.fact.known;
  return std::max(blocks_in(choice.then_block) + (asks_if_known ? 2 : 1),
                  blocks_in(choice.else_block) + 1);
}

unsigned blocks_of(const ir::Repeat& repeat) {
  const std::optional<vm::Value> times = constant_count(repeat);
  if (times && *times == 0) return 0;
  const bool once = times || repeat.kind == ir::RepeatKind::forever;
  return blocks_in(repeat.body) + (once ? 1 : 2);
}

// Every option except the first and the last is in the ELSE of the one before.
unsigned blocks_of(const ir::Pick& pick) {
  if (pick.options.size() == 1) return blocks_in(pick.options.front().body);
  unsigned most = 0;
  for (const ir::Option& option : pick.options) {
    const bool middle = &option != &pick.options.front() && &option != &pick.options.back();
    most = std::max(most, blocks_in(option.body) + (middle ? 2 : 1));
  }
  return most;
}

unsigned blocks_in(const ir::Block& block) {
  unsigned most = 0;
  for (const ir::Statement& statement : block)
    most = std::max(most,
                    std::visit([](const auto& node) { return blocks_of(node); }, statement.node));
  return most;
}

// ---- the emitter

class ResponseEmitter {  // for one response
public:
  explicit ResponseEmitter(Parts& parts)
      : parts_(parts), expressions_(parts, response_.code, TimeWords::watched) {}
  ResponseEmitter(const ResponseEmitter&) = delete;
  ResponseEmitter& operator=(const ResponseEmitter&) = delete;

  [[nodiscard]] ResponseCode emit(const ir::Block& block);

private:
  using Opcode = vm::Opcode;

  void block(const ir::Block& statements);
  void statement(const ir::Statement& statement);
  void emit(const ir::Command& command);
  void emit(const ir::Local& local);
  void emit(const ir::Set& set);
  void emit(const ir::Wait& wait);
  void emit(const ir::Then& then);
  void emit(const ir::Log& log);
  void emit(const ir::Halt& halt);
  void argument(vm::Param param, const Expression& value);
  void emit(const ir::WaitUntil& wait);
  void emit(const ir::Follow& follow);
  void emit(const ir::If& choice);
  void emit(const ir::Repeat& repeat);
  void emit(const ir::Pick& pick);
  void write_ahead(const ir::Repeat& repeat);
  void repeat_times(const ir::Repeat& repeat);
  void repeat_constant_times(const ir::Repeat& repeat);
  void repeat_forever(const ir::Repeat& repeat);
  void repeat_while(const ir::Repeat& repeat);
  void options(const ir::Pick& pick, Cell drawn);
  // Emits the start of a block; returns its index, for the jump to the block's end.
  std::size_t open(Opcode opcode, Operand a = {}, Operand b = {});
  // Opens a block that runs if the condition is true.
  std::size_t open_unless(const Expression& condition);
  std::size_t open_unless(Operation comparison, Cell left, vm::Value right);
  // The same, but with nested blocks for the parts of an AND, as far as the nesting limit allows with `inside` more blocks in
  // them. The outermost comes first.
  std::vector<std::size_t> open_unless_all(const Expression& condition, unsigned inside);
  // Counts one more open block.
  void count_block();
  // Ends the block that began at `begin`, and begins its ELSE; returns the index of the ELSE.
  std::size_t otherwise(std::size_t begin);
  // The same if the enclosing block ends at the same place; the ELSE becomes part of it.
  std::size_t otherwise_to_same_end(std::size_t begin);
  void close(std::size_t begin);  // ends the block here
  // Ends a loop or the evaluation of a wait with `opcode`, which may jump back to its start.
  void close_around(Opcode opcode, Operand a, std::size_t begin);

  CodeDraft& code() { return response_.code; }
  // Instructions emitted from now on come from the current statement.
  void mark() { code().mark({current_->line, current_->span}); }

  Parts& parts_;
  ResponseCode response_;
  ExpressionEmitter expressions_;
  const ir::Statement* current_ = nullptr;  // never null while a statement is emitted
  unsigned open_blocks_ = 0;
};

ResponseCode ResponseEmitter::emit(const ir::Block& statements) {
  for_each_of<ir::Set>(statements, [this](const ir::Set& set) {
    if (set.relative && (set.may_be_below || set.may_be_above))
      expressions_.bound_reads(set.variable);
  });
  block(statements);
  if (!statements.empty() && std::holds_alternative<ir::Command>(statements.back().node))
    code().end_with_command();
  else
    code().emit(Opcode::end);
  return std::move(response_);
}

void ResponseEmitter::block(const ir::Block& statements) {
  for (const ir::Statement& one : statements)
    statement(one);
}

void ResponseEmitter::statement(const ir::Statement& statement) {
  const ir::Statement* const outer = current_;
  current_ = &statement;
  mark();
  std::visit([this](const auto& node) { emit(node); }, statement.node);
  current_ = outer;
}

void ResponseEmitter::emit(const ir::Command& command) {
  for (const ir::Argument& one : command.arguments)
    argument(one.param, one.value);
  code().emit(Opcode::cmd, parts_.tables.target(command), parts_.tables.verb(command),
              parts_.tables.word(command));
  response_.actuators |= parts_.tables.mask_of(command.actuators);
}

void ResponseEmitter::argument(vm::Param param, const Expression& value) {
  const auto number = static_cast<std::uint32_t>(param);
  if (value.operation == Operation::constant)
    code().emit(Opcode::arg_k, number,
                static_cast<std::uint32_t>(parts_.pool.constant(value.constant)));
  else
    code().emit(Opcode::arg, number, expressions_.value(value));
}

void ResponseEmitter::emit(const ir::Local& local) {
  const auto known = expressions_.locals().find(local.number);
  const Cell cell = known != expressions_.locals().end() ? known->second : parts_.frame.add_local();
  expressions_.value_into(cell, local.value);
  expressions_.locals()[local.number] = cell;
}

// SET is clamped here. RAISE and LOWER are added up; the sum is clamped when it is read, and in the next step.
void ResponseEmitter::emit(const ir::Set& set) {
  const ir::Variable& variable = parts_.program.variables[set.variable];
  const Cell target = parts_.frame.write(parts_.tables.variable(set.variable));
  bool in_place = set.in_place;
  Cell value;
  if (needs_clamping(set)) {
    if (set.relative) expressions_.locals()[kItsCell] = target;
    value = expressions_.value(set.relative ? sum_of(set) : set.value);
    if (!set.relative) value = expressions_.clamped(value, variable, set);
  } else {
    const vm::Value constant = std::clamp(set.value.constant, variable.min, variable.max);
    value = expressions_.constant(constant);
    in_place = in_place && !looks_like_truth(constant);
  }
  if (in_place)
    expressions_.put_into(target, value);
  else
    code().emit(set.relative ? Opcode::shift : Opcode::set, target, value);
}

void ResponseEmitter::emit(const ir::Wait& wait) {
  code().emit(Opcode::wait, expressions_.value(wait.duration));
}

void ResponseEmitter::emit(const ir::Then&) {
  code().emit(Opcode::wait_done);
}

void ResponseEmitter::emit(const ir::Log& log) {
  for (std::size_t i = 0; i < log.values.size(); ++i)
    argument(static_cast<vm::Param>(i), log.values[i]);
  code().emit(log.alert ? Opcode::alert : Opcode::log, {}, parts_.strings.offset(log.text));
}

void ResponseEmitter::emit(const ir::Halt& halt) {
  for (const std::uint8_t target : parts_.tables.targets(halt))
    code().emit(Opcode::halt, target);
  response_.actuators |= parts_.tables.mask_of(halt);
}

// ---- blocks

void ResponseEmitter::count_block() {
  ++open_blocks_;
  if (open_blocks_ == vm::kMaxBlocks + 1)
    parts_.too_large(
        "blocks are nested more than " + std::to_string(vm::kMaxBlocks) + " levels deep here",
        current_->span);
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

// The right side is skipped if the left one is not true, so it must have no side effects.
std::vector<std::size_t> ResponseEmitter::open_unless_all(const Expression& condition,
                                                          unsigned inside) {
  const bool has_room = open_blocks_ < kSpareBlocks && open_blocks_ + inside + 2 <= vm::kMaxBlocks;
  const bool splits = parts_.program.optimized && has_room &&
                      condition.operation == Operation::logical_and &&
                      is_pure(condition.operands[1]);
  if (!splits) return {open_unless(condition)};
  std::vector<std::size_t> begins = open_unless_all(condition.operands[0], inside + 1);
  for (const std::size_t inner : open_unless_all(condition.operands[1], inside))
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

// If the condition is unknown, neither side runs. Without ELSE, that needs no extra test.
void ResponseEmitter::emit(const ir::If& choice) {
  if (choice.else_block.empty()) {
    const std::vector<std::size_t> begins =
        open_unless_all(choice.condition, blocks_in(choice.then_block));
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

void ResponseEmitter::emit(const ir::Repeat& repeat) {
  switch (repeat.kind) {
    case ir::RepeatKind::times:
      if (constant_count(repeat)) return repeat_constant_times(repeat);
      return repeat_times(repeat);
    case ir::RepeatKind::while_:
      return repeat_while(repeat);
    case ir::RepeatKind::forever:
      return repeat_forever(repeat);
  }
}

void ResponseEmitter::repeat_constant_times(const ir::Repeat& repeat) {
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

// Writes the variables' own values: the loop is certain to write them, and can then do so in place in every round.
void ResponseEmitter::write_ahead(const ir::Repeat& repeat) {
  const auto write = [this](Opcode opcode, std::size_t variable) {
    const Cell target = parts_.frame.write(parts_.tables.variable(variable));
    code().emit(opcode, target, target);
  };
  for (const std::size_t variable : repeat.assigned)
    write(Opcode::set, variable);
  for (const std::size_t variable : repeat.shifted)
    write(Opcode::shift, variable);
}

void ResponseEmitter::repeat_times(const ir::Repeat& repeat) {
  const Cell counter = parts_.frame.add_local();
  expressions_.value_into(counter, repeat.control);
  const std::size_t any = open_unless(Operation::greater, counter, 0);
  const std::size_t begin = open(Opcode::times_v, counter, counter);
  block(repeat.body);
  mark();
  close_around(Opcode::again, counter, begin);
  close(any);
}

void ResponseEmitter::repeat_while(const ir::Repeat& repeat) {
  const std::size_t first = open_unless(repeat.control);
  const std::size_t begin = open(Opcode::loop);
  block(repeat.body);
  mark();
  close_around(Opcode::around, expressions_.value(repeat.control), begin);
  close(first);
}

void ResponseEmitter::repeat_forever(const ir::Repeat& repeat) {
  const std::size_t begin = open(Opcode::loop);
  block(repeat.body);
  mark();
  close_around(Opcode::around_always, {}, begin);
}

void ResponseEmitter::emit(const ir::Pick& pick) {
  if (pick.options.size() == 1) return block(pick.options.front().body);
  if (pick.options.empty()) return;
  std::int64_t total = 0;
  for (const ir::Option& option : pick.options)
    total += option.weight;
  if (total > vm::kValueMax)
    return parts_.too_large("the shares of the options add up to " +
                                std::to_string(total / vm::kScale) + "; the limit is " +
                                std::to_string(vm::kValueMax / vm::kScale),
                            current_->span);
  const Cell least = expressions_.constant(0, 0);
  const Cell most = expressions_.constant(static_cast<vm::Value>(total - 1), 1);
  const Cell drawn = parts_.frame.add_local();
  code().emit(Opcode::random, drawn, least, most);
  options(pick, drawn);
}

// Each option except the last is an IF whose ELSE holds the following ones; all end at the same place.
void ResponseEmitter::options(const ir::Pick& pick, Cell drawn) {
  std::vector<std::size_t> jumps;
  vm::Value share = 0;  // the sum of the weights so far
  for (const ir::Option& option : pick.options) {
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

void ResponseEmitter::emit(const ir::WaitUntil& wait) {
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

// A poll that runs its body in every step, and ends only when its time is over.
void ResponseEmitter::emit(const ir::Follow& follow) {
  std::optional<Cell> deadline;
  if (follow.lasts) {
    deadline = parts_.frame.add_local();
    code().emit(Opcode::deadline, *deadline, expressions_.value(*follow.lasts));
  }
  const std::size_t poll = open(Opcode::poll);
  block(follow.body);
  mark();
  const Cell over = deadline ? parts_.frame.temporary(0) : expressions_.constant(vm::kFalse);
  if (deadline) code().emit(Opcode::reached, over, *deadline);
  close_around(Opcode::until, over, poll);
}

}  // namespace

bool needs_clamping(const ir::Set& set) {
  return set.relative || set.value.operation != Operation::constant;
}

ResponseCode emit_response(Parts& parts, const ir::Block& response) {
  return ResponseEmitter(parts).emit(response);
}

}  // namespace robosync::compiler
