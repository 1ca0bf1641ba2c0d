// What removing each check of the verifier in turn (scripts/mutate) has shown to be missed by the
// other tests: sums that must not wrap, loops too deep, an ELSE out of a loop, and the edges of
// sections.
#include <catch2/catch.hpp>

#include "tests/vm/response_checks.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using namespace robosync::vm::test::response;

namespace {

const Word kAdd = encode(Op::add, kRegister, 1, 1);
constexpr Limits any_cost() {
  Limits limits;
  limits.step_cost = UINT32_MAX;
  return limits;
}

// Refused at this word of the response as more than can be counted, whatever the board allows.
void check_too_costly(const ImageBuilder& image, std::size_t word) {
  check_refused(image.build(),
                {Refusal::too_costly, Section::code, static_cast<std::uint16_t>(kFirst + word)},
                any_cost());
}

}  // namespace

TEST_CASE("the cost of a loop around a loop does not wrap") {
  const Code code =
      Code{times(kMuch), times(kMuch, kLocal2)} + Code{kAdd, again(2, kLocal2), again(4), kEnd};
  ImageBuilder image = with_response(code);
  // More rounds than 2^32 counts of cost have room for: what is left of the product is anything.
  for (Value rounds = 1000; rounds < 1100; ++rounds) {
    image.constants[kLess] = rounds * kScale;
    image.code[kFirst] = times(kLess);
    check_too_costly(image, 4);
  }
}

TEST_CASE("the cost of loops one after the other does not wrap") {
  const Code loop = Code{times(kMuch)} + repeat(8, kAdd) + Code{again(9)};
  Code code;
  for (int i = 0; i < 12; ++i)
    code = code + loop;
  check_too_costly(with_response(code + Code{kEnd}), 2 * loop.size() - 1);
}

TEST_CASE("loops of every kind are too deep at the seventeenth") {
  for (const Word begin : {encode(Op::loop), encode(Op::poll), times(kTwo)}) {
    if (opcode_of(begin) == Op::times) {
      refused(Refusal::too_deep, kMaxBlocks,
              repeat(kMaxBlocks, encode(Op::loop)) + Code{begin, kEnd});
      continue;
    }
    refused(Refusal::too_deep, kMaxBlocks, repeat(kMaxBlocks + 1, begin) + Code{kEnd});
  }
}

TEST_CASE("an ELSE does not begin in a loop that is open") {
  refused(Refusal::bad_jump, 2, {unless(2), encode(Op::loop), jump(0), kEnd});
  refused(Refusal::bad_jump, 1, {encode(Op::loop), jump(0), kEnd});
}

TEST_CASE("parameters are not carried over a halt") {
  check_refused(
      [](ImageBuilder& image) {
        const Response& stop_response = image.responses[stop];
        // arg, halt, log in the place of halt, halt, load
        image.code[stop_response.start] = encode(Op::arg, kTo, 0);
        image.code[stop_response.start + 2] = encode_wide(Op::log, 0, 0);
      },
      {Refusal::unused_param, Section::code, 1});
}

// What stands before the rules are the timers: the place where the kind of a rule before the first
// one would be is part of a duration.
TEST_CASE("the first rule is no RESUME, whatever stands before it") {
  check_refused(
      [](ImageBuilder& image) {
        std::swap(image.rules[pinch], image.rules[pinch_resume]);
        image.timers.back().duration = static_cast<Value>(RuleKind::safety) << 16;
      },
      {Refusal::bad_value, Section::rules, 0});
}

TEST_CASE("what is shorter than a header is not looked at") {
  const Bytes bytes = companion::make().build();
  Image image;
  CHECK_FALSE(view_image(std::span(bytes).first(sizeof(ImageHeader) - 4), image));
  CHECK(image.header == nullptr);
}
