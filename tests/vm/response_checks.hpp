// A response in a small image, to be accepted or refused at one of its words.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"

namespace robosync::vm::test::response {

using namespace companion;
using Op = Opcode;
using Code = std::vector<Word>;

// The frame: r0 visitors, r1 LEVEL, r2 nearness | locals r3, r4 | watch r5 | registers r6 … r9.
inline constexpr unsigned kLocal = 3;
inline constexpr unsigned kLocal2 = 4;
inline constexpr unsigned kWatch = 5;
inline constexpr unsigned kRegister = 6;
inline constexpr std::uint16_t kThree = 0;  // constants
inline constexpr std::uint16_t kTwo = 1;
inline constexpr std::uint16_t kHalf = 2;
inline constexpr std::uint16_t kZero = 3;
inline constexpr std::uint16_t kMuch = 4;
inline constexpr std::uint16_t kLess = 5;

inline const Word kCommand = encode(Op::cmd, left_arm, move_verb, slowly);
inline const Word kEnd = encode(Op::end);
inline const Word kWait = encode(Op::wait, 1);
inline const Word kUnless = encode_wide(Op::unless, kWatch, 0);

inline Word unless(unsigned ahead) {
  return encode_wide(Op::unless, kWatch, ahead);
}
inline Word jump(unsigned ahead) {
  return encode_wide(Op::jump, 0, ahead);
}
inline Word times(unsigned constant, unsigned local = kLocal) {
  return encode_wide(Op::times, local, constant);
}
inline Word again(unsigned back, unsigned local = kLocal) {
  return encode_wide(Op::again, local, back);
}
inline Word forever(unsigned back) {
  return encode_wide(Op::around_always, 0, back);
}

// A behaviour with a WHEN and a watch rule. Its response stands at the end of the code.
inline ImageBuilder with_response(const Code& code) {
  ImageBuilder image;
  add_robot(image);
  add_memory(image);
  image.constants = {3 * kScale, 2 * kScale, 500, 0, kValueMax / kScale * kScale, -3 * kScale};
  image.inputs = {input_of(visitors), touch_level, input_of(nearness)};
  const auto truth = {encode(Op::lt_k, kRegister, 1, kThree), encode(Op::ret, kRegister)};
  image.rule(0, kNoIndex, truth);
  image.rule_of(RuleKind::watch, kNoIndex, truth);
  const bool commands = std::find(code.begin(), code.end(), kCommand) != code.end();
  const std::uint32_t mask = commands ? 0b001 : 0;
  image.responses.push_back({static_cast<std::uint16_t>(image.code.size()),
                             static_cast<std::uint16_t>(code.size()), mask});
  image.code.insert(image.code.end(), code.begin(), code.end());
  image.behaviors.push_back({1, kNoIndex, mask, 0, 3, 2, 0, 2, 10});
  return image;
}

inline constexpr std::uint16_t kFirst = 4;  // word of the response

inline void accepted(const Code& code) {
  check_accepted(with_response(code));
}
inline void refused(Refusal refusal, unsigned word, const Code& code) {
  check_refused(with_response(code),
                {refusal, Section::code, static_cast<std::uint16_t>(kFirst + word)});
}

inline std::uint32_t cost(const Code& code) {
  return std::accumulate(code.begin(), code.end(), 0U, [](std::uint32_t sum, Word word) {
    return sum + kOpcodes[static_cast<std::size_t>(opcode_of(word))].cost;
  });
}
// The costliest run of the response.
inline std::uint32_t found_cost(const Code& code) {
  const Bytes bytes = with_response(code).build();
  Image image;
  const Verdict verdict = verify(bytes, {}, image);
  INFO(describe(verdict.refusal) << " at " << verdict.index);
  REQUIRE(verdict.ok());
  const std::uint32_t conditions =
      2 * cost({encode(Op::lt_k, kRegister, 1, kThree), encode(Op::ret, kRegister)});
  return image.header->step_cost - conditions;
}

inline Code operator+(Code left, const Code& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}
inline Code repeat(unsigned times, Word word) {
  return Code(times, word);
}

}  // namespace robosync::vm::test::response
