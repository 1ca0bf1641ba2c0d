#include "vm/verify_blocks.hpp"

#include <algorithm>

namespace robosync::vm {
namespace {

// Nothing may cost more, so that sums of a few costs fit 32 bits.
constexpr std::uint32_t kMaxCost = 1U << 29;

// The cell in which a loop counts that begins with `word`; kNotCounted if it does not count.
constexpr unsigned kNotCounted = kMaxCells + 1;
unsigned counter_of(Word word) {
  const bool counts = opcode_of(word) == Opcode::times || opcode_of(word) == Opcode::times_v;
  return counts ? operand_a(word) : kNotCounted;
}

// How far `unless` and its like jump.
std::size_t skipped(Word word) {
  const bool wide = opcode_of(word) <= Opcode::unless_known;
  return wide ? operand_wide(word) : operand_c(word);
}

bool pauses(Opcode opcode) {
  return opcode >= Opcode::wait && opcode <= Opcode::until;
}

}  // namespace

// A loop must have been closed before the block around it ends.
Refusal Blocks::arrive(std::size_t at, bool& changed) {
  for (; depth_ > 0 && top().end <= at; --depth_) {
    if (top().kind != Kind::forward) return Refusal::bad_jump;
    owned_ = top().owned;
    spent_.cost = std::max(spent_.cost, top().cost);
    spent_.output = std::max<std::uint32_t>(spent_.output, top().output);
    changed = true;
  }
  return Refusal::none;
}

Refusal Blocks::spend(std::uint32_t cost, std::uint32_t output) {
  spent_.cost += cost;
  spent_.output += output;
  if (spent_.output > kMaxResponseOutput) return Refusal::too_much_output;
  return spent_.cost > kMaxCost ? Refusal::too_costly : Refusal::none;
}

Refusal Blocks::flow(std::size_t at, Word word) {
  const std::size_t next = at + 1;
  const std::size_t distance = operand_wide(word);
  const Opcode opcode = opcode_of(word);
  if (is_unless(opcode)) return open(Kind::forward, next, next + skipped(word));
  if (pauses(opcode) && !disown()) return Refusal::lost_variable;
  switch (opcode) {
    case Opcode::jump:
      return jump(next, next + distance);
    case Opcode::times:
    case Opcode::times_v:
    case Opcode::loop:
      return open(Kind::loop, next, limit());
    case Opcode::again:
    case Opcode::around:
    case Opcode::around_always:
    case Opcode::until:
      return close_loop(next - distance, word);
    case Opcode::poll:
      wait();
      return open(Kind::loop, next, limit());
    case Opcode::wait:
    case Opcode::wait_done:
      wait();
      return Refusal::none;
    default:
      return Refusal::none;
  }
}

bool Blocks::is_counter(std::uint8_t cell) const {
  for (unsigned i = 0; i < depth_; ++i)
    if (open_[i].kind != Kind::forward && counter_of(opener(open_[i])) == cell) return true;
  return false;
}

std::uint32_t Blocks::dearest() const {
  return std::max(dearest_, spent_.cost);
}

Refusal Blocks::open(Kind kind, std::size_t start, std::size_t end) {
  if (end > limit()) return Refusal::bad_jump;
  if (depth_ == open_.size()) return Refusal::too_deep;
  open_[depth_++] = {spent_.cost,
                     {owned_},
                     static_cast<std::uint16_t>(start),
                     static_cast<std::uint16_t>(end),
                     static_cast<std::uint8_t>(spent_.output),
                     0,
                     kind};
  return Refusal::none;
}

// Remembers in a forward block what has been spent at a jump to its end.
void Blocks::take_dearer(Block& block) const {
  block.cost = std::max(block.cost, spent_.cost);
  block.output = static_cast<std::uint8_t>(std::max<std::uint32_t>(block.output, spent_.output));
}

// ELSE: what follows is reached from where the block that ends here began. Where the block around
// it ends at the target, too, that is the same end: so a chain of ELSEs is no deeper than one.
Refusal Blocks::jump(std::size_t next, std::size_t target) {
  if (depth_ == 0 || top().kind != Kind::forward || top().end != next) return Refusal::bad_jump;
  const Spent before{top().cost, top().output};
  owned_ = top().owned;
  --depth_;
  Refusal refusal = Refusal::none;
  if (depth_ > 0 && top().kind == Kind::forward && top().end == target)
    take_dearer(top());
  else
    refusal = open(Kind::forward, next, target);
  spent_ = before;
  return refusal;
}

Refusal Blocks::close_loop(std::size_t target, Word word) {
  if (depth_ == 0 || top().kind == Kind::forward || top().start != target) return Refusal::bad_jump;
  const Block& loop = top();
  --depth_;
  const Word begin = opener(loop);
  const Opcode end = opcode_of(word);
  if (end == Opcode::again)
    return counter_of(begin) == operand_a(word) ? repeat(loop) : Refusal::bad_jump;
  if (opcode_of(begin) == (end == Opcode::until ? Opcode::poll : Opcode::loop))
    return end == Opcode::until ? Refusal::none : repeat(loop);  // a run ends at `poll` and `until`
  return Refusal::bad_jump;
}

// Takes into account that the loop, whose end is reached, runs more than once.
Refusal Blocks::repeat(const Block& loop) {
  if (loop.kind ==
      Kind::waiting_loop) {  // a run can come from the last wait around to the first one
    dearest_ = std::max(dearest_, spent_.cost + loop.lead_cost);
    return good_or(Refusal::too_much_output,
                   spent_.output + loop.lead_output <= kMaxResponseOutput);
  }
  const Word begin = opener(loop);
  if (opcode_of(begin) != Opcode::times) return Refusal::endless;
  // One round is in what was spent already.
  const auto more = static_cast<std::uint32_t>(image_.constants[operand_wide(begin)] / kScale - 1);
  const std::uint64_t cost = std::uint64_t{more} * (spent_.cost - loop.cost);
  const std::uint64_t output = std::uint64_t{more} * (spent_.output - loop.output);
  if (output > kMaxResponseOutput) return Refusal::too_much_output;
  if (cost > kMaxCost) return Refusal::too_costly;
  return spend(static_cast<std::uint32_t>(cost), static_cast<std::uint32_t>(output));
}

// The inputs are read anew in the next step.
bool Blocks::disown() {
  for (unsigned i = 0; i < depth_; ++i) {
    if (open_[i].kind == Kind::keeping_loop) return false;
    if (open_[i].kind != Kind::waiting_loop) open_[i].owned = 0;
  }
  owned_ = 0;
  return true;
}

bool Blocks::change(std::uint8_t input) {
  const std::uint32_t bit = bit_of(input);
  if ((owned_ & bit) == 0) return false;
  for (unsigned i = 0; i < depth_; ++i)
    if (open_[i].kind == Kind::loop && (open_[i].owned & bit) != 0)
      open_[i].kind = Kind::keeping_loop;
  return true;
}

// The run ends here. Loops around it, up to the first IF, wait in every round.
void Blocks::wait() {
  unsigned block = depth_;
  for (; block > 0 && open_[block - 1].kind != Kind::forward; --block) {
    Block& loop = open_[block - 1];
    if (loop.kind == Kind::waiting_loop) continue;
    loop.kind = Kind::waiting_loop;
    loop.lead_cost = spent_.cost - loop.cost;
    loop.lead_output = static_cast<std::uint8_t>(spent_.output - loop.output);
  }
  for (; block > 0; --block)  // one further out: the wait may be left out in a round of it
    if (open_[block - 1].kind != Kind::forward) return;
  dearest_ = std::max(dearest_, spent_.cost);
  spent_ = {};
}

}  // namespace robosync::vm
