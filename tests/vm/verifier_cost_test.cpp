// What the verifier finds a step to cost and to put out, worked out by hand.
#include <catch2/catch.hpp>

#include "tests/vm/response_checks.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using namespace robosync::vm::test::response;
using namespace robosync::vm::test::companion;

TEST_CASE("the costlier way through an IF counts") {
  const Code dear = repeat(3, kCommand);
  CHECK(found_cost(Code{unless(3)} + dear + Code{kEnd}) == cost(Code{kUnless, kEnd} + dear));
  CHECK(found_cost(Code{unless(2), kCommand, jump(3)} + dear + Code{kEnd}) ==
        cost(Code{kUnless, kEnd} + dear));
  CHECK(found_cost(Code{unless(4)} + dear + Code{jump(1), kCommand, kEnd}) ==
        cost(Code{kUnless, jump(0), kEnd} + dear));
}

TEST_CASE("a loop with a constant counts as often as it runs") {
  const Code body{kCommand, again(0)};
  CHECK(found_cost({times(kThree), kCommand, again(2), kEnd}) ==
        cost({times(0), kEnd}) + 3 * cost(body));
  CHECK(found_cost(
            {times(kThree), times(kTwo, kLocal2), kCommand, again(2, kLocal2), again(4), kEnd}) ==
        cost({times(0), kEnd}) + 3 * (cost({times(0), again(0)}) + 2 * cost(body)));
  // With a wait that may be left out as well: it may be left out each time.
  CHECK(found_cost({times(kThree), unless(1), kWait, again(3), kEnd}) ==
        cost({times(0), kEnd}) + 3 * cost({kUnless, kWait, again(0)}));
}

TEST_CASE("a wait begins a new run, and the costliest run counts") {
  const Code few = repeat(2, kCommand);
  const Code many = repeat(9, kCommand);
  CHECK(found_cost(few + Code{kWait} + many + Code{kEnd}) == cost(many + Code{kEnd}));
  CHECK(found_cost(many + Code{kWait} + few + Code{kEnd}) == cost(many + Code{kWait}));
  CHECK(found_cost(few + Code{encode(Op::poll)} + many + Code{encode_wide(Op::until, kWatch, 10)} +
                   few + Code{kEnd}) == cost(many + Code{encode(Op::until)} + few + Code{kEnd}));
  // In an IF: the way around it does not wait.
  CHECK(found_cost(many + Code{unless(1), kWait} + few + Code{kEnd}) ==
        cost(many + Code{kUnless} + few + Code{kEnd}));
}

TEST_CASE("a run goes around a loop from the last wait to the first") {
  const Code lead = repeat(2, kCommand);
  const Code tail = repeat(9, kCommand);
  CHECK(found_cost(Code{encode(Op::loop)} + lead + Code{kWait, kWait} + tail +
                   Code{forever(14), kEnd}) == cost(tail + Code{forever(0)} + lead + Code{kWait}));
  CHECK(found_cost(Code{times(kThree)} + lead + Code{kWait} + tail + Code{again(13)} + tail +
                   Code{kEnd}) == cost(tail + Code{again(0)} + tail + Code{kEnd}));
  CHECK(found_cost(tail + tail + Code{encode(Op::loop)} + lead + Code{kWait, forever(4), kEnd}) ==
        cost(tail + tail + Code{encode(Op::loop)} + lead + Code{kWait}));
}

TEST_CASE("what is put out counts in the same way") {
  constexpr unsigned kRounds = kMaxResponseOutput / 2 - 1;
  const Code full = repeat(kMaxResponseOutput, kCommand);
  accepted(full + Code{kWait} + full + Code{encode(Op::wait_done)} + full + Code{kEnd});
  refused(Refusal::too_much_output, kMaxResponseOutput, full + Code{kCommand, kEnd});
  accepted(Code{unless(65)} + full + Code{jump(64)} + full + Code{kEnd});
  refused(Refusal::too_much_output, 65, Code{unless(64)} + full + Code{kCommand, kCommand, kEnd});
  // 3 * 21 = 63
  accepted(Code{times(kThree)} + repeat(21, kCommand) + Code{again(22), kCommand, kEnd});
  refused(Refusal::too_much_output, 23,
          Code{times(kThree)} + repeat(22, kCommand) + Code{again(23), kEnd});
  // Around a loop that waits: 31 + 33 fit, 32 + 33 do not.
  const auto around = [](unsigned lead, unsigned tail) {
    return Code{encode(Op::loop)} + repeat(lead, kCommand) + Code{kWait} + repeat(tail, kCommand) +
           Code{forever(lead + tail + 2), kEnd};
  };
  accepted(around(kRounds, 33));
  refused(Refusal::too_much_output, 1 + 32 + 1 + 33, around(32, 33));
}

TEST_CASE("costs that no number can hold are refused") {
  // 2,147,483 rounds of 2,147,483 rounds of …
  const unsigned second = kLocal2;
  refused(Refusal::too_costly, 4,
          {times(kMuch), times(kMuch, second), encode(Op::mul, kRegister, 1, 1), again(2, second),
           again(4), kEnd});
  ImageBuilder image = with_response({times(kMuch), again(1), kEnd});
  Limits limits;
  check_refused(image, {Refusal::too_costly, Section::header, 0}, limits);
  limits.step_cost = UINT32_MAX;
  check_accepted(image, limits);
}
