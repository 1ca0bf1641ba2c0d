// The columns of opcodes.def: that they agree with each other, and that images stay readable.
#include "vm/opcode.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "vm/opcode_traits.hpp"

using namespace robosync::vm;

namespace {

bool has(const OpcodeInfo& info, std::initializer_list<Operand> kinds) {
  return std::ranges::any_of(info.operands, [&](Operand operand) {
    return std::ranges::find(kinds, operand) != kinds.end();
  });
}

}  // namespace

// A board refuses images of another set, so this changes only with what an image means.
TEST_CASE("the id of the opcode set is that of the images in the field") {
  CHECK(opcode_set_id() == 0x2774);
}

TEST_CASE("a column says what the others allow") {
  for (const OpcodeInfo& info : kOpcodes) {
    INFO(info.name);
    const Flow flow = info.flow;
    CHECK(has(info, {Operand::ahead, Operand::ahead8}) ==
          (flow == Flow::if_begin || flow == Flow::if_else));
    CHECK(has(info, {Operand::back}) == ends_loop(flow));
    CHECK(has(info, {Operand::param}) == (info.effect == Effect::param));
    CHECK(has(info, {Operand::target}) ==
          (info.effect == Effect::command || info.effect == Effect::halt));
    CHECK(has(info, {Operand::string}) ==
          (info.effect == Effect::log || info.effect == Effect::alert));
    CHECK(has(info, {Operand::variable}) == (info.effect == Effect::set));
    if (flow == Flow::count_begin || flow == Flow::count_end)
      CHECK(info.operands[0] == Operand::local);
    if (!is_straight(flow)) CHECK(info.contexts == Context::response);
    if (is_wide(info.operands[1])) CHECK(info.operands[2] == Operand::none);
  }
}

TEST_CASE("a condition ends with a truth, a period with a number") {
  for (const OpcodeInfo& info : kOpcodes)
    if (info.flow == Flow::end && info.contexts == Context::condition)
      CHECK((info.operands[0] == Operand::read_truth || info.operands[0] == Operand::read));
}

TEST_CASE("what is no opcode stands nowhere") {
  for (Word word = 0; word < 256; ++word)
    for (const Context context : {Context::condition, Context::response, Context::safety})
      if (word >= kOpcodes.size()) CHECK_FALSE(traits_of(word).stands_in(context));
}

TEST_CASE("time words and their timers find each other") {
  for (std::size_t i = 0; i < kTimeWords.size(); ++i) {
    const auto kind = static_cast<TimerKind>(i);
    CHECK(timer_kind_of(time_word_of(kind)) == kind);
    CHECK(info_of(time_word_of(kind)).operands[2] == Operand::timer);
  }
  CHECK(timer_kind_of(Opcode::add) == TimerKind::count_);
}
