// Variables that a response owns: what the verifier lets it change in place, and for how long.
#include <catch2/catch.hpp>

#include "tests/vm/response_checks.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using namespace robosync::vm::test::response;
using namespace robosync::vm::test::companion;

namespace {

// The variable and the reading of the response's frame (response_checks.hpp).
constexpr unsigned kVariable = 0;
constexpr unsigned kReading = 1;

const Word kSet = encode(Op::set, kVariable, kReading);
const Word kChange = encode(Op::add, kVariable, kVariable, kReading);

void lost(unsigned word, const Code& code) {
  refused(Refusal::bad_operand, word, code);
}

}  // namespace

TEST_CASE("what was set or shifted may be changed in place") {
  accepted({kSet, kChange, kEnd});
  accepted({encode(Op::shift, kVariable, kReading), kChange, kChange, kEnd});
  accepted({kSet, encode(Op::move, kVariable, kReading), kEnd});
  accepted({kSet, encode_wide(Op::load, kVariable, kThree), kEnd});
  lost(0, {kChange, kEnd});
  lost(0, {kChange, kSet, kEnd});
  lost(0, {encode(Op::move, kVariable, kReading), kEnd});
}

TEST_CASE("nothing but what was set is owned") {
  lost(1, {kSet, encode(Op::add, kReading, kVariable, kReading), kEnd});
  lost(1, {kSet, encode(Op::add, kWatch, kVariable, kReading), kEnd});
  lost(1, {kSet, encode(Op::add, 32, kVariable, kReading), kEnd});  // no bit of its own
}

TEST_CASE("what is owned takes numbers, by arithmetic") {
  lost(1, {kSet, encode(Op::lt, kVariable, kVariable, kReading), kEnd});
  lost(1, {kSet, encode(Op::move, kVariable, kWatch), kEnd});
  lost(1, {kSet, encode_wide(Op::load, kVariable, kZero), kEnd});
  lost(1, {kSet, encode(Op::deadline, kVariable, kReading), kEnd});
  lost(1, {kSet, times(kThree, kVariable), again(1, kVariable), kEnd});
}

TEST_CASE("a pause takes away what is owned") {
  const Word until = encode_wide(Op::until, kWatch, 2);
  lost(2, {kSet, kWait, kChange, kEnd});
  lost(2, {kSet, encode(Op::wait_done), kChange, kEnd});
  lost(2, {kSet, encode(Op::poll), kChange, until, kEnd});
  lost(3, {encode(Op::poll), kSet, until, kChange, kEnd});
  accepted({kSet, kWait, kSet, kChange, kEnd});
  // Another response begins with nothing.
  ImageBuilder image = with_response({kSet, kChange, kEnd});
  const std::uint16_t other = image.response(0, {kChange, kEnd});
  image.rules[0].kind = RuleKind::when_else;
  image.rules[0].else_response = other;
  check_refused(image, {Refusal::bad_operand, Section::code, image.responses[other].start});
}

TEST_CASE("a block ends with what it began with") {
  accepted({kSet, unless(1), kChange, kChange, kEnd});
  accepted({unless(2), kSet, kChange, kEnd});
  lost(2, {unless(1), kSet, kChange, kEnd});
  lost(3, {unless(2), kSet, jump(1), kChange, kEnd});        // in the ELSE
  lost(4, {unless(2), kSet, jump(1), kSet, kChange, kEnd});  // not even when set on both ways
  accepted({kSet, unless(2), kChange, jump(1), kChange, kChange, kEnd});
  // An ELSE that ends with the one around it.
  accepted({kSet, unless(5), kCommand, unless(2), kChange, jump(1), kChange, kChange, kEnd});
  lost(7, {unless(2), kSet, jump(4), unless(2), kSet, jump(1), kSet, kChange, kEnd});
}

TEST_CASE("a pause on one way takes it away on both") {
  lost(3, {kSet, unless(1), kWait, kChange, kEnd});
  lost(4, {kSet, unless(2), kWait, kSet, kChange, kEnd});
  lost(5, {kSet, unless(2), kWait, jump(1), kCommand, kChange, kEnd});
  lost(5, {kSet, unless(2), kCommand, jump(1), kWait, kChange, kEnd});
  lost(5, {kSet, unless(3), unless(1), kWait, kCommand, kChange, kEnd});
}

TEST_CASE("a loop carries in what is owned, and changes it if it does not pause") {
  accepted({kSet, times(kThree), kChange, again(2), kChange, kEnd});
  accepted({kSet, times(kThree), times(kTwo, kLocal2), kChange, again(2, kLocal2), again(4), kEnd});
  accepted({times(kThree), kSet, again(2), kChange, kEnd});  // it runs at least once
  lost(1, {times(kThree), kChange, kSet, again(3), kEnd});   // the first round has nothing
  const auto refused_at = [](unsigned word, const Code& code) {
    refused(Refusal::lost_variable, word, code);
  };
  for (const Word pause : {kWait, encode(Op::wait_done), encode(Op::poll)})
    refused_at(3, {kSet, times(kThree), kChange, pause, again(3), kEnd});
  refused_at(4, {kSet, times(kThree), kChange, unless(1), kWait, again(4), kEnd});
  // Changed, or paused, in a loop inside.
  refused_at(5, {kSet, times(kThree), times(kTwo, kLocal2), kChange, again(2, kLocal2), kWait,
                 again(5), kEnd});
  refused_at(4, {kSet, times(kThree), kChange, times(kTwo, kLocal2), kWait, again(2, kLocal2),
                 again(5), kEnd});
}

TEST_CASE("a loop that only begins with it, or changes it only once it has set it, may pause") {
  accepted({kSet, times(kThree), kWait, again(2), kEnd});
  accepted({kSet, kChange, times(kThree), kWait, again(2), kEnd});
  accepted({times(kThree), kSet, kChange, kWait, again(4), kEnd});
  accepted({kSet, times(kThree), kWait, kSet, kChange, again(4), kEnd});
  lost(3, {kSet, times(kThree), kWait, kChange, again(3), kEnd});
  lost(4, {kSet, times(kThree), kWait, again(2), kChange, kEnd});
  // The loop inside pauses before it changes anything; the one around it has paused.
  lost(5, {kSet, times(kThree), unless(1), kWait, kCommand, kChange, again(5), kEnd});
  accepted({encode(Op::loop), kWait, kSet, times(kThree), kChange, again(2), forever(6), kEnd});
}
