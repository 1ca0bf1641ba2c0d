// See walk.hpp.
#include "analysis/walk.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"
#include "vm/opcode.hpp"

namespace robosync::analysis {
namespace {

using vm::Flow, vm::Operand;

Flow flow_of(vm::Word word) {
  return vm::info_of(vm::opcode_of(word)).flow;
}

}  // namespace

bool writes(vm::Word word) {
  return vm::is_written(vm::info_of(vm::opcode_of(word)).operands[0]);
}

std::uint32_t least_wait_ms(vm::Word word, std::span<const Interval> cells) {
  if (vm::info_of(vm::opcode_of(word)).operands[0] != Operand::read) return policy::kLeastPauseMs;
  return policy::period_ms(cells[vm::operand_a(word)].low);
}

Walk::Walk(const vm::Image& image, const vm::Behavior& behavior, std::span<const vm::Word> code,
           const Ranges& inputs)
    : image_(image),
      code_(code),
      numbers_(image.inputs.subspan(behavior.first_input, behavior.input_count)),
      inputs_(inputs) {
  latch(false);
}

bool Walk::next() {
  if (++at_ >= code_.size()) return false;
  Coming& coming = coming_to(at_);
  if (at_ == 0 || coming.at != at_) return true;
  if (reached_) coming.state.join(now_);
  now_ = coming.state;
  coming.at = 0;
  reached_ = true;
  return true;
}

// What may hold in the other state may hold here as well.
void Walk::State::join(const State& other) {
  std::ranges::transform(cells, other.cells, cells.begin(), hull);
  waited_ms = std::min(waited_ms, other.waited_ms);
}

// The entry for this place, or a free one.
Walk::Coming& Walk::coming_to(std::size_t at) {
  for (Coming& coming : coming_)
    if (coming.at == at) return coming;
  for (Coming& coming : coming_)
    if (coming.at == 0) return coming;
  return coming_.back();  // never: the image is verified
}

void Walk::run() {
  const vm::OpcodeInfo& info = vm::info_of(vm::opcode_of(word()));
  const std::uint8_t a = vm::operand_a(word());
  if (info.effect == vm::Effect::set) {
    // Setting something unknown does nothing.
    const Interval value = now_.cells[vm::operand_b(word())];
    now_.cells[a] = value.may_be_unknown() ? hull(now_.cells[a], known(value)) : value;
  } else if (vm::always_pauses(info.flow)) {
    now_.waited_ms += least_wait_ms(word(), now_.cells);
  } else if (writes(word())) {
    now_.cells[a] = result_of(image_, word(), now_.cells);
  }
  if (vm::may_pause(info.flow)) latch(false);
  if (info.flow == Flow::if_begin || info.flow == Flow::if_else)
    jump(info.operands[2] == Operand::ahead8 ? vm::operand_c(word()) : vm::operand_wide(word()));
  if (info.flow == Flow::if_else) reached_ = false;
  if (vm::begins_loop(info.flow)) begin_loop();
}

// The inputs are read again.
void Walk::latch(bool also_as_it_was) {
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    now_.cells[i] =
        also_as_it_was ? hull(now_.cells[i], inputs_[numbers_[i]]) : inputs_[numbers_[i]];
}

void Walk::jump(std::size_t words_ahead) {
  const std::size_t target = at_ + 1 + words_ahead;
  Coming& coming = coming_to(target);
  if (coming.at == target) return coming.state.join(now_);
  coming = {target, now_};
}

// Cells that are written anywhere in the loop are unknown when a round begins.
void Walk::begin_loop() {
  latch(true);
  unsigned depth = 1;
  for (std::size_t i = at_ + 1; i < code_.size() && depth > 0; ++i) {
    const Flow flow = flow_of(code_[i]);
    if (vm::begins_loop(flow)) ++depth;
    if (vm::ends_loop(flow)) --depth;
    if (writes(code_[i])) now_.cells[vm::operand_a(code_[i])] = {};
  }
}

}  // namespace robosync::analysis
