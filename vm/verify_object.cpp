// Verifier, part: the instructions of one code object.
//
// One loop over the words. The properties of an opcode come from its columns in opcodes.def (Traits);
// no opcode is treated by name. verify_blocks.cpp checks how blocks nest.
#include "vm/verify_object.hpp"

#include <algorithm>
#include <bit>

#include "vm/opcode_traits.hpp"
#include "vm/verify_blocks.hpp"

namespace robosync::vm {
namespace {

// One byte each, because the other columns fill the word of Traits.
constexpr std::array<std::uint8_t, kOpcodes.size()> kCosts = [] {
  std::array<std::uint8_t, kOpcodes.size()> costs{};
  for (std::size_t i = 0; i < costs.size(); ++i)
    costs[i] = static_cast<std::uint8_t>(kOpcodes[i].cost);
  return costs;
}();
static_assert(std::all_of(kOpcodes.begin(), kOpcodes.end(),
                          [](const OpcodeInfo& info) { return info.cost <= UINT8_MAX; }));

constexpr Context context_of(ObjectKind kind) {
  if (kind == ObjectKind::response) return Context::response;
  return kind == ObjectKind::safety ? Context::safety : Context::condition;
}

// Has a constructor, because an aggregate would be zeroed first, including the array of blocks.
struct Pass {
  Pass(Frame& frame, ObjectKind what, std::size_t last)
      : verification(frame.verification),
        image(frame.verification.image),
        behavior(frame.behavior),
        cells(frame.cells),
        kind(what),
        context(context_of(what)),
        blocks(image, last) {}

  Verification& verification;
  const Image& image;
  const Behavior& behavior;
  Cells& cells;
  ObjectKind kind;
  Context context;
  Blocks blocks;
  std::uint32_t params = 0;  // given so far for the next command
  std::uint32_t actuators = 0;
};

Refusal check_read(const Pass& pass, std::uint8_t cell, bool truth) {
  if (!pass.cells.in_frame(cell)) return Refusal::bad_operand;
  if (!pass.cells.is_set(cell)) return Refusal::unset_cell;
  return good_or(Refusal::not_a_truth, !truth || pass.cells.is_truth(cell));
}

// A local belongs to one response: others may run while it waits.
Refusal check_local(const Pass& pass, std::uint8_t cell) {
  if (pass.context == Context::condition) return Refusal::bad_operand;
  return good_or(Refusal::shared_local,
                 !pass.cells.is_taken(cell) && !pass.blocks.is_counter(cell));
}

// A register accepts numbers and truths, a variable that the response owns only numbers.
Refusal check_write(Pass& pass, std::uint8_t cell, bool truth) {
  if (pass.cells.is_local(cell)) return check_local(pass, cell);
  return good_or(Refusal::bad_operand,
                 pass.cells.is_register(cell) ||
                     (!truth && pass.cells.is_input(cell) && pass.blocks.change(cell)));
}

// A variable that is not the result of a CHECK, and is among the inputs that have a bit each.
bool is_writable(const Pass& pass, std::uint8_t cell) {
  if (cell >= kMaxWritable || !pass.cells.is_input(cell)) return false;
  const std::size_t input = pass.image.inputs[pass.behavior.first_input + std::size_t{cell}];
  const std::size_t channels = pass.image.channels.size();
  return input >= channels && pass.image.variables[input - channels].kind != VariableKind::band;
}

// Timers must be used in rising order, so that none is used twice.
Refusal check_timer(const Pass& pass, Opcode opcode, std::size_t index) {
  if (index >= pass.image.timers.size()) return Refusal::bad_operand;
  if (index < pass.verification.next_timer) return Refusal::shared_timer;
  pass.verification.next_timer = static_cast<std::uint32_t>(index + 1);
  return good_or(Refusal::wrong_timer, time_word_of(pass.image.timers[index].kind) == opcode);
}

bool is_constant_good(const Pass& pass, Operand kind, std::size_t index) {
  if (index >= pass.image.constants.size()) return false;
  const Value constant = pass.image.constants[index];
  if (is_positive(kind) && constant <= 0) return false;
  return kind != Operand::count16 || constant % kScale == 0;
}

// Checks an operand that is not written. verify_blocks.cpp checks distances; command() checks targets,
// verbs and words together.
Refusal check_operand(const Pass& pass, Operand kind, Opcode opcode, std::size_t number) {
  switch (kind) {
    case Operand::none:
      return good_or(Refusal::bad_operand, number == 0);
    case Operand::read:
    case Operand::read_truth:
      return check_read(pass, static_cast<std::uint8_t>(number), kind == Operand::read_truth);
    case Operand::const8:
    case Operand::const16:
    case Operand::positive8:
    case Operand::divisor8:
    case Operand::whole8:
    case Operand::count16:
      return good_or(Refusal::bad_operand, is_constant_good(pass, kind, number));
    case Operand::string:
      return good_or(Refusal::bad_operand, number < pass.image.strings.size());
    case Operand::timer:
      return check_timer(pass, opcode, number);
    default:
      return Refusal::none;
  }
}

// Does write_same write a truth value, as given by B?
bool gives_truth(const Pass& pass, Operand kind_b, Word word) {
  if (kind_b == Operand::read) return pass.cells.is_truth(operand_b(word));
  const Value constant = pass.image.constants[operand_wide(word)];
  return constant == kTrue || constant == kFalse;
}

// Does every actuator in `targets` know the verb?
bool all_know(const Image& image, std::uint32_t targets, std::uint8_t verb) {
  for (; targets != 0; targets &= targets - 1) {
    const auto actuator = static_cast<std::size_t>(std::countr_zero(targets));
    if ((image.actuators[actuator].verbs >> verb & 1) == 0) return false;
  }
  return true;
}

Refusal command(Pass& pass, Word word) {
  const Image& image = pass.image;
  const std::uint32_t targets = image.target_mask(operand_a(word));
  const std::uint8_t verb = operand_b(word);
  const std::uint8_t entry = operand_c(word);
  if (targets == 0 || verb >= image.verbs.size()) return Refusal::bad_operand;
  if (entry != kNoWord) {
    if (entry >= image.words.size()) return Refusal::bad_operand;
    pass.params |= std::uint32_t{1} << static_cast<unsigned>(image.words[entry].param);
  }
  const std::uint32_t unwanted = pass.params & ~std::uint32_t{image.verbs[verb].params};
  if (unwanted != 0 || !all_know(image, targets, verb)) return Refusal::wrong_verb;
  pass.params = 0;
  pass.actuators |= targets;
  return Refusal::none;
}

Refusal halt(Pass& pass, std::uint8_t target) {
  const std::uint32_t targets = target == kAllActuators ? low_bits(pass.image.actuators.size())
                                                        : pass.image.target_mask(target);
  pass.actuators |= targets;
  return good_or(Refusal::bad_operand, targets != 0 || target == kAllActuators);
}

// Checks A, after B and C have been checked, and applies the instruction's effect on it.
Refusal perform(Pass& pass, Traits traits, Word word) {
  const std::uint8_t a = operand_a(word);
  const Operand kind = traits.operand(0);
  Refusal refusal = Refusal::none;
  bool truth = kind != Operand::write && kind != Operand::local;
  switch (kind) {
    case Operand::update_truth:
      refusal = check_read(pass, a, true);
      break;
    case Operand::write_same:
      truth = gives_truth(pass, traits.operand(1), word);
      break;
    case Operand::write:
    case Operand::write_truth:
      break;
    case Operand::local:
      if (!pass.cells.is_local(a)) return Refusal::bad_operand;
      if (traits.flow() == Flow::count_end) return Refusal::none;  // checked in verify_blocks.cpp
      break;
    case Operand::variable:
      pass.blocks.own(a);
      return good_or(Refusal::bad_operand, is_writable(pass, a));
    case Operand::param:
      pass.params |= std::uint32_t{1} << (a & 31U);
      return good_or(Refusal::bad_operand, a < static_cast<std::uint8_t>(Param::count_));
    case Operand::target:
      return traits.effect() == Effect::halt ? halt(pass, a) : command(pass, word);
    default:
      if (traits.effect() == Effect::log || traits.effect() == Effect::alert) pass.params = 0;
      return check_operand(pass, kind, opcode_of(word), a);
  }
  if (refusal == Refusal::none) refusal = check_write(pass, a, truth);
  pass.cells.set(a, truth);
  return refusal;
}

Refusal check_operands(Pass& pass, Traits traits, Word word) {
  const Operand kind_b = traits.operand(1);
  const Opcode opcode = opcode_of(word);
  const bool wide = is_wide(kind_b);
  Refusal refusal =
      check_operand(pass, kind_b, opcode, wide ? operand_wide(word) : operand_b(word));
  if (refusal == Refusal::none && !wide)
    refusal = check_operand(pass, traits.operand(2), opcode, operand_c(word));
  return refusal != Refusal::none ? refusal : perform(pass, traits, word);
}

// Neither registers nor parameters are kept where paths meet.
Refusal end_blocks(Pass& pass, std::size_t at) {
  pass.cells.forget_registers();
  const Refusal refusal = pass.blocks.arrive(at);
  return refusal == Refusal::none && pass.params != 0 ? Refusal::unused_param : refusal;
}

// Blocks and waits: neither are kept here, except that registers stay known inside an IF.
Refusal flow(Pass& pass, Traits traits, std::size_t at, Word word) {
  if (pass.params != 0) return Refusal::unused_param;
  if (traits.flow() != Flow::if_begin) pass.cells.forget_registers();
  return pass.blocks.flow(at, word, traits);
}

// Is an instruction with `traits` allowed here? An object has the terminator of its kind as its last
// word and nowhere else.
Refusal check_place(const Pass& pass, Traits traits, bool last) {
  const bool ends = traits.flow() == Flow::end;
  if (!traits.stands_in(pass.context) || (ends && !last)) return Refusal::wrong_context;
  if (!last) return Refusal::none;
  if (!ends) return Refusal::no_end;
  const Operand given = traits.operand(0);
  const bool other_end = (given == Operand::read_truth && pass.kind != ObjectKind::condition) ||
                         (given == Operand::read && pass.kind != ObjectKind::period);
  return good_or(Refusal::wrong_context, !other_end);
}

Refusal check_instruction(Pass& pass, std::size_t at, Word word, bool last) {
  const std::size_t number = word & 0xFF;
  if (number >= kTraits.size()) return Refusal::bad_opcode;
  const Traits traits = kTraits[number];
  Refusal refusal = check_place(pass, traits, last);
  if (refusal == Refusal::none && pass.blocks.ends_at(at)) refusal = end_blocks(pass, at);
  if (refusal == Refusal::none) refusal = check_operands(pass, traits, word);
  if (refusal == Refusal::none)
    refusal = pass.blocks.spend(kCosts[number], output_words(traits.effect()));
  if (refusal == Refusal::none && !is_straight(traits.flow()))
    refusal = flow(pass, traits, at, word);
  if (refusal == Refusal::none && pass.params != 0 && (last || traits.effect() == Effect::halt))
    refusal = Refusal::unused_param;
  return refusal;
}

}  // namespace

bool check_object(Frame& frame, ObjectKind kind, CodeRange range, std::uint32_t& cost,
                  std::uint32_t& actuators) {
  Verification& verification = frame.verification;
  const std::size_t last = range.start + range.length - 1U;
  verification.words += range.length;
  if (verification.words > verification.limits.step_cost)
    return verification.refuse(Refusal::too_costly, Section::code, range.start);
  Pass pass(frame, kind, last);
  frame.cells.begin_object();
  for (std::size_t at = range.start; at <= last; ++at) {
    const Refusal refusal = check_instruction(pass, at, pass.image.code[at], at == last);
    if (refusal != Refusal::none) return verification.refuse(refusal, Section::code, at);
  }
  cost = pass.blocks.worst();
  actuators = pass.actuators;
  return true;
}

}  // namespace robosync::vm
