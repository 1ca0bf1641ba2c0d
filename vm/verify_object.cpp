// Verifier, part: the instructions of one code object.
//
// One loop over the words. What an opcode's operands are comes from opcodes.def, packed into one
// word for each opcode (Traits) at compile time. How blocks nest is verify_blocks.cpp's matter.
#include "vm/verify_object.hpp"

#include <algorithm>
#include <bit>

#include "vm/verify_blocks.hpp"

namespace robosync::vm {
namespace {

// An opcode's line of opcodes.def: three operand kinds, contexts, cost.
using Traits = std::uint32_t;
constexpr unsigned kKindBits = 5;
constexpr unsigned kContextShift = 3 * kKindBits;
constexpr unsigned kContextBits = 3;
constexpr unsigned kCostShift = kContextShift + kContextBits;
constexpr Traits kNoOpcode = 0;  // no opcode is without a context

constexpr Operand kind_of(Traits traits, unsigned place) {
  return static_cast<Operand>(traits >> place * kKindBits & low_bits(kKindBits));
}

constexpr std::array<Traits, kOpcodes.size()> kTraits = [] {
  std::array<Traits, kOpcodes.size()> traits{};
  for (std::size_t i = 0; i < traits.size(); ++i) {
    const OpcodeInfo& info = kOpcodes[i];
    for (unsigned place = 0; place < info.operands.size(); ++place)
      traits[i] |= static_cast<Traits>(info.operands[place]) << place * kKindBits;
    traits[i] |= static_cast<Traits>(info.contexts) << kContextShift | Traits{info.cost}
                                                                           << kCostShift;
  }
  return traits;
}();
static_assert(std::all_of(kOpcodes.begin(), kOpcodes.end(), [](const OpcodeInfo& info) {
  return info.cost < 1 << (32 - kCostShift);
}));

// The time words stand in the order of the kinds of timers.
static_assert(static_cast<int>(Opcode::changed) - static_cast<int>(Opcode::held) ==
              static_cast<int>(TimerKind::changed) - static_cast<int>(TimerKind::held));

constexpr Context context_of(ObjectKind kind) {
  if (kind == ObjectKind::response) return Context::response;
  return kind == ObjectKind::safety ? Context::safety : Context::condition;
}

// A constructor, as an aggregate would be filled with zeros first, the places of blocks as well.
struct Pass {
  Pass(Verification& all, const Behavior& of, Cells& frame, ObjectKind what, std::size_t last)
      : verification(all),
        image(all.image),
        behavior(of),
        cells(frame),
        kind(what),
        blocks(all.image, last) {}

  Verification& verification;
  const Image& image;
  const Behavior& behavior;
  Cells& cells;
  ObjectKind kind;
  Blocks blocks;
  std::uint32_t params = 0;  // given to the command to come
  std::uint32_t actuators = 0;
};

Refusal check_read(const Pass& pass, std::uint8_t cell, bool truth) {
  if (!pass.cells.in_frame(cell)) return Refusal::bad_operand;
  if (!pass.cells.is_set(cell)) return Refusal::unset_cell;
  return good_or(Refusal::not_a_truth, !truth || pass.cells.is_truth(cell));
}

// A local belongs to one response: others may run while it waits.
Refusal check_local(const Pass& pass, std::uint8_t cell) {
  if (context_of(pass.kind) == Context::condition) return Refusal::bad_operand;
  return good_or(Refusal::shared_local,
                 !pass.cells.is_taken(cell) && !pass.blocks.is_counter(cell));
}

// A register takes anything, a variable that the response owns only numbers.
Refusal check_write(Pass& pass, std::uint8_t cell, bool truth) {
  if (pass.cells.is_local(cell)) return check_local(pass, cell);
  return good_or(Refusal::bad_operand,
                 pass.cells.is_register(cell) ||
                     (!truth && pass.cells.is_input(cell) && pass.blocks.change(cell)));
}

// A variable that is not the result of a CHECK, among the inputs that have a bit of their own.
bool is_writable(const Pass& pass, std::uint8_t cell) {
  if (cell >= kMaxWritable || !pass.cells.is_input(cell)) return false;
  const std::size_t input = pass.image.inputs[pass.behavior.first_input + std::size_t{cell}];
  const std::size_t channels = pass.image.channels.size();
  return input >= channels && pass.image.variables[input - channels].kind != VariableKind::band;
}

// Timers are taken in rising order, so that none is taken twice.
Refusal check_timer(const Pass& pass, Opcode opcode, std::uint8_t index) {
  if (index >= pass.image.timers.size()) return Refusal::bad_operand;
  if (index < pass.verification.next_timer) return Refusal::shared_timer;
  pass.verification.next_timer = index + 1U;
  const auto kind = static_cast<unsigned>(pass.image.timers[index].kind);
  return good_or(Refusal::wrong_timer,
                 static_cast<unsigned>(Opcode::held) + kind == static_cast<unsigned>(opcode));
}

// What stands in B and C together.
bool is_wide_good(const Pass& pass, Operand kind, Word word) {
  const std::size_t index = operand_wide(word);
  if (kind == Operand::string) return index < pass.image.strings.size();
  if (kind != Operand::const16) return true;  // a distance: verify_blocks.cpp
  if (index >= pass.image.constants.size()) return false;
  const Value constant = pass.image.constants[index];
  return opcode_of(word) != Opcode::times || (constant > 0 && constant % kScale == 0);
}

bool is_const8_good(const Pass& pass, Opcode opcode, std::uint8_t index) {
  if (index >= pass.image.constants.size()) return false;
  const bool divides = opcode == Opcode::div_k || opcode == Opcode::mod_k;
  return !divides || pass.image.constants[index] > 0;
}

// An operand that is only looked at. Targets, verbs and words are looked at together (command).
Refusal check_operand(const Pass& pass, Operand kind, Opcode opcode, std::uint8_t byte) {
  switch (kind) {
    case Operand::none:
      return good_or(Refusal::bad_operand, byte == 0);
    case Operand::read:
    case Operand::read_truth:
      return check_read(pass, byte, kind == Operand::read_truth);
    case Operand::const8:
      return good_or(Refusal::bad_operand, is_const8_good(pass, opcode, byte));
    case Operand::timer:
      return check_timer(pass, opcode, byte);
    default:
      return Refusal::none;
  }
}

// Is what `move` or `load` writes a truth value?
bool gives_truth(const Pass& pass, Word word) {
  if (opcode_of(word) == Opcode::move) return pass.cells.is_truth(operand_b(word));
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

// What stands in A, once B and C are known to be good; then what the instruction does to it.
Refusal perform(Pass& pass, Operand kind, Word word) {
  const std::uint8_t a = operand_a(word);
  const Opcode opcode = opcode_of(word);
  Refusal refusal = Refusal::none;
  bool truth = kind != Operand::write && kind != Operand::local;
  switch (kind) {
    case Operand::update_truth:
      refusal = check_read(pass, a, true);
      break;
    case Operand::write_same:
      truth = gives_truth(pass, word);
      break;
    case Operand::write:
    case Operand::write_truth:
      break;
    case Operand::local:
      if (!pass.cells.is_local(a)) return Refusal::bad_operand;
      if (opcode == Opcode::again) return Refusal::none;  // the cell of its loop: verify_blocks.cpp
      break;
    case Operand::variable:
      pass.blocks.own(a);
      return good_or(Refusal::bad_operand, is_writable(pass, a));
    case Operand::param:
      pass.params |= std::uint32_t{1} << (a & 31U);
      return good_or(Refusal::bad_operand, a < static_cast<std::uint8_t>(Param::count_));
    case Operand::target:
      return opcode == Opcode::halt ? halt(pass, a) : command(pass, word);
    default:
      if (opcode == Opcode::log) pass.params = 0;
      return check_operand(pass, kind, opcode, a);
  }
  if (refusal == Refusal::none) refusal = check_write(pass, a, truth);
  pass.cells.set(a, truth);
  return refusal;
}

Refusal check_operands(Pass& pass, Traits traits, Word word) {
  const Operand kind_b = kind_of(traits, 1);
  Refusal refusal = Refusal::none;
  if (is_wide(kind_b)) {
    refusal = good_or(Refusal::bad_operand, is_wide_good(pass, kind_b, word));
  } else {
    refusal = check_operand(pass, kind_b, opcode_of(word), operand_b(word));
    if (refusal == Refusal::none)
      refusal = check_operand(pass, kind_of(traits, 2), opcode_of(word), operand_c(word));
  }
  return refusal != Refusal::none ? refusal : perform(pass, kind_of(traits, 0), word);
}

// Words it puts out.
unsigned output_of(Traits traits) {
  const Operand kind = kind_of(traits, 0);
  if (kind == Operand::param) return 2;
  return kind == Operand::target || kind_of(traits, 1) == Operand::string ? 1 : 0;
}

// Blocks and waits: neither parameters nor registers are carried over, but for what was known
// before an IF inside of it.
Refusal flow(Pass& pass, std::size_t at, Word word) {
  const Opcode opcode = opcode_of(word);
  if (opcode < Opcode::jump || opcode > Opcode::until) return Refusal::none;
  if (pass.params != 0) return Refusal::unused_param;
  if (!is_unless(opcode)) pass.cells.forget_registers();
  return pass.blocks.flow(at, word);
}

constexpr bool is_flow(const OpcodeInfo& info) {
  return info.name == "wait" || info.name == "wait_done" || info.name == "poll" ||
         info.operands[1] == Operand::ahead || info.operands[1] == Operand::back ||
         info.operands[2] == Operand::ahead8 || info.name == "times" || info.name == "times_v" ||
         info.name == "loop";
}
static_assert([] {
  for (std::size_t i = 0; i < kOpcodes.size(); ++i) {
    const auto opcode = static_cast<Opcode>(i);
    if (is_flow(kOpcodes[i]) != (opcode >= Opcode::jump && opcode <= Opcode::until)) return false;
  }
  return true;
}());

// Is this the place for an instruction with `traits`? Objects end with the terminator of their
// kind, and only there.
Refusal check_place(const Pass& pass, Traits traits, Opcode opcode, bool last) {
  if (traits == kNoOpcode) return Refusal::bad_opcode;
  const auto context = static_cast<Traits>(context_of(pass.kind));
  const bool ends = is_terminator(opcode);
  if ((traits >> kContextShift & context) == 0 || (ends && !last)) return Refusal::wrong_context;
  if (last && !ends) return Refusal::no_end;
  const bool other_end = (opcode == Opcode::ret && pass.kind != ObjectKind::condition) ||
                         (opcode == Opcode::ret_number && pass.kind != ObjectKind::period);
  return good_or(Refusal::wrong_context, !other_end);
}

Refusal check_instruction(Pass& pass, std::size_t at, Word word, bool last) {
  const auto number = static_cast<std::size_t>(opcode_of(word));
  const Traits traits = number < kTraits.size() ? kTraits[number] : kNoOpcode;
  bool merged = false;
  Refusal refusal = check_place(pass, traits, opcode_of(word), last);
  if (refusal == Refusal::none) refusal = pass.blocks.arrive(at, merged);
  if (merged) {
    pass.cells.forget_registers();
    if (pass.params != 0) refusal = Refusal::unused_param;
  }
  if (refusal == Refusal::none) refusal = check_operands(pass, traits, word);
  if (refusal == Refusal::none)
    refusal = pass.blocks.spend(traits >> kCostShift, output_of(traits));
  if (refusal == Refusal::none) refusal = flow(pass, at, word);
  const bool uses_none =
      last || opcode_of(word) == Opcode::alert || opcode_of(word) == Opcode::halt;
  if (refusal == Refusal::none && uses_none && pass.params != 0) refusal = Refusal::unused_param;
  return refusal;
}

}  // namespace

bool check_object(Verification& verification, const Behavior& behavior, Cells& cells,
                  ObjectKind kind, CodeRange range, ObjectFacts& facts) {
  const std::size_t last = range.start + range.length - 1U;
  verification.words += range.length;
  if (verification.words > verification.limits.step_cost)
    return verification.refuse(Refusal::too_costly, Section::code, range.start);
  Pass pass(verification, behavior, cells, kind, last);
  cells.begin_object();
  for (std::size_t at = range.start; at <= last; ++at) {
    const Refusal refusal = check_instruction(pass, at, pass.image.code[at], at == last);
    if (refusal != Refusal::none) return verification.refuse(refusal, Section::code, at);
  }
  facts = {pass.blocks.dearest(), pass.actuators};
  return true;
}

}  // namespace robosync::vm
