#include "tests/generators/images/drawer.hpp"

#include <algorithm>
#include <bit>

namespace robosync::fuzz {
namespace {

using vm::Context;
using vm::Section;
using vm::Value;

// Draws that look for something fitting give up after so many.
constexpr int kTries = 6;

}  // namespace

Drawer::Drawer(const Draft& draft, const Object& object, Random& random)
    : image_(draft.view()), context_(object.context), random_(random) {
  const vm::Behavior& behavior = image_.behaviors[object.behavior];
  inputs_ = behavior.input_count;
  first_input_ = behavior.first_input;
  locals_end_ = inputs_ + behavior.locals;
  cells_ = behavior.cells;
  std::size_t watches = 0;
  for (std::size_t r = behavior.first_rule; r < image_.rules.size(); ++r)
    if (r < std::size_t{behavior.first_rule} + behavior.rule_count)
      watches += image_.rules[r].kind == vm::RuleKind::watch ? 1 : 0;
  first_register_ = locals_end_ + watches;
  for (std::size_t i = locals_end_; i < first_register_ && i < 256; ++i)
    truths_.set(i);
  if (context_ == Context::condition && random_.one_in(2) && !image_.timers.empty())
    next_timer_ = random_.below(image_.timers.size());
}

void Drawer::forget() {
  known_.reset();
  truths_.reset();
  for (std::size_t i = locals_end_; i < first_register_ && i < 256; ++i)
    truths_.set(i);
}

void Drawer::learn(Word word) {
  if (!is_opcode(word)) return;
  const Opcode opcode = vm::opcode_of(word);
  const vm::Flow flow = flow_of(opcode);
  if (vm::may_pause(flow) && !random_.one_in(4)) owned_ = 0;
  if (!vm::is_straight(flow) && flow != vm::Flow::if_begin) return forget();
  const unsigned a = operand(word, 0);
  bool truth = false;
  switch (kind_of(word, 0)) {
    case Operand::variable:
      if (a < 32) owned_ |= 1U << a;
      return;
    case Operand::write:
      break;
    case Operand::write_truth:
    case Operand::update_truth:
      truth = true;
      break;
    case Operand::write_same:
      if (kind_of(word, 1) == Operand::read) {
        truth = truths_[operand(word, 1)];
      } else {
        const std::size_t index = operand(word, 1);
        const Value value = index < image_.constants.size() ? image_.constants[index] : 1;
        truth = value == vm::kTrue || value == vm::kFalse;
      }
      break;
    default:
      return;
  }
  known_.set(a);
  truths_.set(a, truth);
}

Opcode Drawer::opcode_with(bool (*wanted)(Opcode)) {
  std::array<Opcode, kOpcodeCount> found{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < kOpcodeCount; ++i) {
    const auto opcode = static_cast<Opcode>(i);
    if (has_context(opcode, context_) && wanted(opcode)) found[count++] = opcode;
  }
  return count == 0 ? Opcode::move : found[random_.below(count)];
}

Word Drawer::plain() {
  return instruction(opcode_with([](Opcode opcode) {
    return flow_of(opcode) == vm::Flow::next && effect_of(opcode) != vm::Effect::param;
  }));
}

// B and C first: A may be where they are read from.
Word Drawer::instruction(Opcode opcode) {
  auto word = static_cast<Word>(opcode);
  const bool command = kind_of(word, 0) == Operand::target;
  if (command) word = with_operand(word, 0, draw(word, 0));
  for (std::size_t place = 1; place < kPlaces; ++place)
    if (!(place == 2 && vm::is_wide(kind_of(word, 1))))
      word = with_operand(word, place, draw(word, place));
  return command ? word : with_operand(word, 0, draw(word, 0));
}

unsigned Drawer::draw(Word word, std::size_t place) {
  if (odds_ != 0 && random_.one_in(odds_)) return random_.below(256);
  return draw_kind(word, place);
}

unsigned Drawer::draw_kind(Word word, std::size_t place) {
  const Opcode opcode = vm::opcode_of(word);
  switch (kind_of(word, place)) {
    case Operand::write:
      return written();
    case Operand::write_truth:
    case Operand::write_same:
      return cells_ > first_register_
                 ? static_cast<unsigned>(first_register_ + random_.below(cells_ - first_register_))
                 : 0;
    case Operand::local:
      return local();
    case Operand::read:
      return cell(known_, true);
    case Operand::read_truth:
    case Operand::update_truth:
      return truth();
    case Operand::variable:
      return variable();
    case Operand::const8:
    case Operand::positive8:
    case Operand::whole8:
    case Operand::divisor8:
      return random_.below(std::min<std::size_t>(image_.constants.size(), 256));
    case Operand::const16:
      return random_.below(image_.constants.size());
    case Operand::count16:
      return count();
    case Operand::timer:
      return timer(opcode);
    case Operand::string:
      return random_.below(image_.strings.size());
    case Operand::param:
      return random_.below(static_cast<unsigned>(vm::Param::count_));
    case Operand::target:
      return target(opcode);
    case Operand::verb:
      return verb(operand(word, 0));
    case Operand::word:
      return entry(operand(word, 1));
    case Operand::none:
    case Operand::ahead:
    case Operand::ahead8:
    case Operand::back:
      break;
  }
  return 0;
}

unsigned Drawer::cell(const Cells& among, bool with_inputs) {
  if (with_inputs && locals_end_ > 0 && random_.below(3) != 0) return random_.below(locals_end_);
  const std::size_t end = std::min<std::size_t>(std::max(cells_, first_register_), 256);
  if (end <= locals_end_) return 0;
  const std::size_t from = locals_end_ + random_.below(end - locals_end_);
  for (std::size_t i = 0; i < end - locals_end_; ++i) {
    const std::size_t at = locals_end_ + (from - locals_end_ + i) % (end - locals_end_);
    if (among[at]) return static_cast<unsigned>(at);
  }
  return with_inputs && locals_end_ > 0 ? random_.below(locals_end_) : static_cast<unsigned>(from);
}

unsigned Drawer::truth() {
  Cells among = known_;
  for (std::size_t i = locals_end_; i < first_register_ && i < 256; ++i)
    among.set(i);
  return cell(among & truths_, false);
}

unsigned Drawer::local() {
  return locals_end_ > inputs_ ? static_cast<unsigned>(inputs_ + random_.below(locals()))
                               : static_cast<unsigned>(inputs_);
}

unsigned Drawer::written() {
  if (context_ == Context::response && locals() > 0 && random_.one_in(4)) return local();
  if (owned_ != 0 && random_.one_in(3)) return static_cast<unsigned>(std::countr_zero(owned_));
  if (cells_ <= first_register_) return static_cast<unsigned>(first_register_);
  return static_cast<unsigned>(first_register_ + random_.below(cells_ - first_register_));
}

unsigned Drawer::variable() {
  const std::size_t bits = std::min<std::size_t>(inputs_, vm::kMaxWritable);
  unsigned cell = 0;
  for (int tries = 0; tries < kTries; ++tries) {
    cell = random_.below(bits);
    if (first_input_ + cell >= image_.inputs.size()) continue;
    const std::size_t input = image_.inputs[first_input_ + cell];
    const std::size_t place = input - image_.channels.size();
    if (input >= image_.channels.size() && place < image_.variables.size() &&
        image_.variables[place].kind != vm::VariableKind::band)
      break;
  }
  return cell;
}

// A loop's count is whole and above 0, and should not be too much for a step.
unsigned Drawer::count() {
  unsigned index = random_.below(image_.constants.size());
  for (int tries = 0; tries < kTries && index < image_.constants.size(); ++tries) {
    const Value value = image_.constants[index];
    if (value > 0 && value % vm::kScale == 0 && value < 100 * vm::kScale) break;
    index = random_.below(image_.constants.size());
  }
  return index;
}

unsigned Drawer::timer(Opcode opcode) {
  const vm::TimerKind kind = vm::timer_kind_of(opcode);
  for (std::size_t i = next_timer_; i < image_.timers.size() && i < 256; ++i) {
    if (image_.timers[i].kind != kind) continue;
    next_timer_ = i + 1;
    return static_cast<unsigned>(i);
  }
  return random_.below(image_.timers.size());
}

unsigned Drawer::target(Opcode opcode) {
  if (effect_of(opcode) == vm::Effect::halt && random_.one_in(4)) return vm::kAllActuators;
  if (!image_.groups.empty() && random_.one_in(4))
    return vm::kGroupBit | random_.below(image_.groups.size());
  return random_.below(image_.actuators.size());
}

unsigned Drawer::verb(unsigned target) {
  std::uint32_t known = UINT32_MAX;
  for (std::uint32_t left = image_.target_mask(static_cast<std::uint8_t>(target)); left != 0;
       left &= left - 1) {
    const auto actuator = static_cast<std::size_t>(std::countr_zero(left));
    if (actuator < image_.actuators.size()) known &= image_.actuators[actuator].verbs;
  }
  const unsigned first = random_.below(image_.verbs.size());
  for (unsigned i = 0; i < image_.verbs.size(); ++i) {
    const auto at = static_cast<unsigned>((first + i) % image_.verbs.size());
    if (at < 32 && (known >> at & 1) != 0) return at;
  }
  return first;
}

unsigned Drawer::entry(unsigned verb) {
  if (verb < image_.verbs.size() && !image_.words.empty()) {
    for (int tries = 0; tries < kTries; ++tries) {
      const unsigned index = random_.below(image_.words.size());
      const auto param = static_cast<unsigned>(image_.words[index].param);
      if (param < 8 && (image_.verbs[verb].params >> param & 1) != 0) return index;
    }
  }
  return vm::kNoWord;
}

}  // namespace robosync::fuzz
