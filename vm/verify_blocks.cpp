#include "vm/verify_blocks.hpp"

#include <algorithm>

namespace robosync::vm {
namespace {

// How far the word jumps, ahead or back.
std::size_t distance_of(Word word, Traits traits) {
  return traits.operand(2) == Operand::ahead8 ? operand_c(word) : operand_wide(word);
}

}  // namespace

// A loop must be closed before the block around it ends.
Refusal Blocks::arrive(std::size_t at) {
  for (; ends_at(at); --depth_) {
    if (top().is_loop()) return Refusal::bad_jump;
    owned_ = top().owned;
    spent_.cost = std::max(spent_.cost, top().cost);
    spent_.output = std::max<std::uint32_t>(spent_.output, top().output);
  }
  return Refusal::none;
}

Refusal Blocks::flow(std::size_t at, Word word, Traits traits) {
  const std::size_t next = at + 1;
  const std::size_t distance = distance_of(word, traits);
  const Flow flow = traits.flow();
  if (may_pause(flow) && !disown()) return Refusal::lost_variable;
  if (always_pauses(flow)) wait();
  switch (flow) {
    case Flow::if_begin:
      return open(Flow::if_else, next, next + distance);
    case Flow::if_else:
      return begin_else(next, next + distance);
    case Flow::count_begin:
    case Flow::loop_begin:
    case Flow::poll_begin:
      return open(end_of(flow), next, limit());
    case Flow::count_end:
    case Flow::loop_end:
    case Flow::poll_end:
      return close_loop(next - distance, word, flow);
    case Flow::next:
    case Flow::end:
    case Flow::pause:
      break;
  }
  return Refusal::none;
}

bool Blocks::is_counter(std::uint8_t cell) const {
  for (unsigned i = 0; i < depth_; ++i)
    if (open_[i].closed_by == Flow::count_end && operand_a(opener(open_[i])) == cell) return true;
  return false;
}

std::uint32_t Blocks::worst() const {
  return std::max(worst_, spent_.cost);
}

Refusal Blocks::open(Flow closed_by, std::size_t start, std::size_t end) {
  if (end > limit()) return Refusal::bad_jump;
  if (depth_ == open_.size()) return Refusal::too_deep;
  open_[depth_++] = {spent_.cost,
                     {owned_},
                     static_cast<std::uint16_t>(start),
                     static_cast<std::uint16_t>(end),
                     static_cast<std::uint8_t>(spent_.output),
                     0,
                     Pauses::unknown,
                     closed_by};
  return Refusal::none;
}

// Stores in a forward block the cost and output at a jump to its end.
void Blocks::take_worse(Block& block) const {
  block.cost = std::max(block.cost, spent_.cost);
  block.output = static_cast<std::uint8_t>(std::max<std::uint32_t>(block.output, spent_.output));
}

// ELSE: the following code is reached from the begin of the block that ends here. If the enclosing
// block also ends at the target, both share that end: so a chain of ELSEs is no deeper than one ELSE.
Refusal Blocks::begin_else(std::size_t next, std::size_t target) {
  if (depth_ == 0 || top().is_loop() || top().end != next) return Refusal::bad_jump;
  const Spent before{top().cost, top().output};
  owned_ = top().owned;
  --depth_;
  Refusal refusal = Refusal::none;
  if (depth_ > 0 && !top().is_loop() && top().end == target)
    take_worse(top());
  else
    refusal = open(Flow::if_else, next, target);
  spent_ = before;
  return refusal;
}

Refusal Blocks::close_loop(std::size_t target, Word word, Flow end) {
  if (depth_ == 0 || top().closed_by != end || top().start != target) return Refusal::bad_jump;
  const Block& loop = top();
  if (end == Flow::count_end && operand_a(opener(loop)) != operand_a(word))
    return Refusal::bad_jump;
  --depth_;
  if (end == Flow::poll_end) return Refusal::none;  // a run ends both at its begin and at its end
  return repeat(loop);
}

// At the end of a loop: accounts for its further rounds.
Refusal Blocks::repeat(const Block& loop) {
  if (loop.pauses == Pauses::always) {  // a run can go from the last wait around to the first one
    worst_ = std::max(worst_, spent_.cost + loop.lead_cost);
    return good_or(Refusal::too_much_output,
                   spent_.output + loop.lead_output <= kMaxResponseOutput);
  }
  const Word begin = opener(loop);
  if (kTraits[begin & 0xFF].operand(1) != Operand::count16) return Refusal::endless;
  // One round has been counted already.
  const auto more = static_cast<std::uint32_t>(image_.constants[operand_wide(begin)] / kScale - 1);
  const std::uint64_t cost = std::uint64_t{more} * (spent_.cost - loop.cost);
  const std::uint64_t output = std::uint64_t{more} * (spent_.output - loop.output);
  if (output > kMaxResponseOutput) return Refusal::too_much_output;
  if (cost > kMaxCost) return Refusal::too_costly;
  return spend(static_cast<std::uint32_t>(cost), static_cast<std::uint32_t>(output));
}

// At a wait: the next step reads the inputs anew, so the response owns none. False if a loop around it
// must not wait.
bool Blocks::disown() {
  for (unsigned i = 0; i < depth_; ++i) {
    if (open_[i].pauses == Pauses::never) return false;
    if (open_[i].pauses != Pauses::always) open_[i].owned = 0;
  }
  owned_ = 0;
  return true;
}

bool Blocks::change(std::uint8_t input) {
  const std::uint32_t bit = bit_of(input);
  if ((owned_ & bit) == 0) return false;
  for (unsigned i = 0; i < depth_; ++i)
    if (open_[i].is_loop() && open_[i].pauses == Pauses::unknown && (open_[i].owned & bit) != 0)
      open_[i].pauses = Pauses::never;
  return true;
}

// A run ends here. The loops around it, out to the first IF, wait in every round.
void Blocks::wait() {
  unsigned block = depth_;
  for (; block > 0 && open_[block - 1].is_loop(); --block) {
    Block& loop = open_[block - 1];
    if (loop.pauses == Pauses::always) continue;
    loop.pauses = Pauses::always;
    loop.lead_cost = spent_.cost - loop.cost;
    loop.lead_output = static_cast<std::uint8_t>(spent_.output - loop.output);
  }
  for (; block > 0; --block)  // a round of a loop further out may skip the wait
    if (open_[block - 1].is_loop()) return;
  worst_ = std::max(worst_, spent_.cost);
  spent_ = {};
}

}  // namespace robosync::vm
