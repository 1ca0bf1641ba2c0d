#include "tests/oracles/bytecode/stepper.hpp"

#include "tests/oracles/bytecode/instruction.hpp"

namespace robosync::fuzz {

using oracle::Went;
using vm::Context;
using vm::Machine;
using vm::Pause;
using vm::Value;

namespace {

bool is_truth(Value value) {
  return value == vm::kTrue || value == vm::kFalse || value == vm::kUnknown;
}

}  // namespace

void Stepper::begin(Machine& machine, const CodeObject& object) {
  machine_ = &machine;
  object_ = &object;
  const vm::Behavior& behavior = *object.behavior;
  inputs_ = behavior.input_count;
  locals_end_ = inputs_ + behavior.locals;
  first_register_ = locals_end_;
  for (std::size_t r = 0; r < behavior.rule_count; ++r)
    first_register_ += image_.rules[behavior.first_rule + r].kind == vm::RuleKind::watch ? 1 : 0;
  cells_ = behavior.cells;
  cost_ = owned_ = 0;
  known_.reset();
  truths_.reset();
  for (std::size_t i = 0; i < first_register_; ++i) {
    known_.set(i);
    truths_.set(i, i >= locals_end_);
  }
}

Value Stepper::evaluate(Machine& machine, const CodeObject& object, std::uint32_t& cost) {
  begin(machine, object);
  for (std::size_t at = 0;; ++at) {
    check(at);
    const Word word = image_.code[object.start + at];
    const oracle::Done done = oracle::run(machine, word);
    cost = cost_;
    if (done.went == Went::ended) return done.result;
    require(done.went == Went::on, "a condition that does not go straight on");
    learn(word);
  }
}

Run Stepper::respond(Machine& machine, const CodeObject& object, std::size_t from) {
  begin(machine, object);
  for (std::size_t at = from;;) {
    check(at);
    const Word word = image_.code[object.start + at];
    const std::size_t target = target_of(at, word);
    const oracle::Done done = oracle::run(machine, word);
    switch (done.went) {
      case Went::on:
        learn(word);
        ++at;
        break;
      case Went::to_target:
        learn(word);
        at = target;
        break;
      case Went::paused:
        return {done.pause, done.pauses_at_target ? target : at + 1, done.wake, cost_};
      case Went::ended:
        return {Pause::ended, 0, done.wake, cost_};
    }
  }
}

// Where a jump at `at` leads; behind it where it is none.
std::size_t Stepper::target_of(std::size_t at, Word word) {
  const Distance distance = distance_of(vm::opcode_of(word));
  const std::size_t far = distance.jump == Jump::none ? 0 : operand(word, distance.place);
  return distance.jump == Jump::back ? at + 1 - far : at + 1 + far;
}

void Stepper::check(std::size_t at) {
  require(at < object_->length, "left its code object");
  const Word word = image_.code[object_->start + at];
  require(is_opcode(word), "ran what is no opcode");
  const Context context = object_->is_condition ? Context::condition
                          : object_->is_safety  ? Context::safety
                                                : Context::response;
  require(has_context(vm::opcode_of(word), context), "ran what may not stand there");
  cost_ += info_of(word).cost;
  require(cost_ <= limit_, "cost more than declared");
  for (std::size_t place = 0; place < kPlaces; ++place)
    if (!(place == 2 && vm::is_wide(kind_of(word, 1)))) check_operand(at, word, place);
}

void Stepper::check_operand(std::size_t at, Word word, std::size_t place) {
  const unsigned value = operand(word, place);
  const Opcode opcode = vm::opcode_of(word);
  switch (kind_of(word, place)) {
    case Operand::none:
      return require(value == 0, "an operand where there is none");
    case Operand::read:
      return check_read(value, false);
    case Operand::read_truth:
      return check_read(value, true);
    case Operand::update_truth:
      check_read(value, true);
      return check_write(word, value);
    case Operand::write:
    case Operand::write_truth:
    case Operand::write_same:
      return check_write(word, value);
    case Operand::local:
      return require(value >= inputs_ && value < locals_end_, "no local");
    case Operand::variable:
      return require(value < inputs_ && value < vm::kMaxWritable, "no variable");
    case Operand::const8:
    case Operand::const16:
    case Operand::whole8:
    case Operand::positive8:
    case Operand::divisor8:
    case Operand::count16:
      return check_constant(kind_of(word, place), value);
    case Operand::timer:
      require(value < image_.timers.size(), "no timer");
      return require(image_.timers[value].kind == vm::timer_kind_of(opcode),
                     "another word's timer");
    case Operand::string:
      return require(value < image_.strings.size(), "no string");
    case Operand::param:
      return require(value < static_cast<unsigned>(vm::Param::count_), "no parameter");
    case Operand::ahead:
    case Operand::ahead8:
    case Operand::back:
      return check_distance(at, word, place);
    case Operand::target:
    case Operand::verb:
    case Operand::word:
      return;  // exercise.cpp: what was put out
  }
}

void Stepper::check_constant(Operand kind, std::size_t index) {
  require(index < image_.constants.size(), "no constant");
  const Value constant = image_.constants[index];
  require(constant != vm::kUnknown, "an unknown constant");
  if (vm::is_positive(kind)) require(constant > 0, "a constant that is not above 0");
  if (kind == Operand::count16) require(constant % vm::kScale == 0, "a count that is not whole");
}

void Stepper::check_read(unsigned cell, bool truth) {
  require(cell < cells_, "reads outside the frame");
  require(known_[cell], "reads what nothing was written to");
  if (!truth) return;
  require(truths_[cell], "takes a number for a truth value");
  require(is_truth(machine_->frame[cell]), "a truth value that is none");
}

// A register, a local of a response, or a variable that this run has set.
void Stepper::check_write(Word word, unsigned cell) {
  require(cell < cells_, "writes outside the frame");
  if (cell >= first_register_) return;
  require(cell < locals_end_, "writes a watched truth");
  require(!object_->is_condition, "a condition writes more than registers");
  const Operand kind = kind_of(word, 0);
  require(kind != Operand::update_truth, "updates what is no register");
  if (cell < inputs_) require(cell < 32 && (owned_ >> cell & 1) != 0, "writes an input");
}

void Stepper::check_distance(std::size_t at, Word word, std::size_t place) {
  const std::size_t far = operand(word, place);
  const bool inside =
      kind_of(word, place) == Operand::back ? far <= at + 1 : at + 1 + far < object_->length;
  require(inside, "jumps outside");
}

void Stepper::learn(Word word) {
  const unsigned a = operand(word, 0);
  bool truth = false;
  switch (kind_of(word, 0)) {
    case Operand::variable:
      owned_ |= 1U << a;
      return;
    case Operand::write:
      break;
    case Operand::write_truth:
    case Operand::update_truth:
      truth = true;
      break;
    case Operand::write_same: {
      const unsigned b = operand(word, 1);
      const bool constant = kind_of(word, 1) == Operand::const16;
      truth = constant ? image_.constants[b] == vm::kTrue || image_.constants[b] == vm::kFalse
                       : truths_[b];
      break;
    }
    default:
      return;
  }
  known_.set(a);
  truths_.set(a, truth && a >= first_register_);
}

}  // namespace robosync::fuzz
