// What the verifier says about blocks, waits, locals, timers and SETs.
#include <catch2/catch.hpp>

#include "tests/vm/response_checks.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using namespace robosync::vm::test::response;
using namespace robosync::vm::test::companion;

TEST_CASE("an IF, with and without ELSE, empty or not") {
  accepted({unless(0), kEnd});
  accepted({unless(1), kCommand, kEnd});
  accepted({unless(2), kCommand, jump(1), kCommand, kEnd});
  accepted({unless(2), kCommand, jump(0), kEnd});
  accepted(
      {encode_wide(Op::unless_known, kWatch, 4), unless(2), kCommand, jump(1), kCommand, kEnd});
  accepted({unless(3), unless(2), kCommand, kCommand, kCommand, kEnd});
}

TEST_CASE("jumps stay in the object, and do not cross blocks") {
  refused(Refusal::bad_jump, 0, {unless(1), kEnd});  // behind the end
  refused(Refusal::bad_jump, 0, {unless(0xFFFF), kEnd});
  refused(Refusal::bad_jump, 0, {jump(0), kEnd});  // ends no block
  refused(Refusal::bad_jump, 1,
          {unless(3), jump(0), kCommand, kCommand, kEnd});  // not its last word
  refused(Refusal::bad_jump, 1, {unless(2), unless(2), kCommand, kCommand, kEnd});
  refused(Refusal::bad_jump, 2,
          {unless(4), unless(1), jump(3), kCommand, kCommand, kCommand, kEnd});
  refused(Refusal::bad_jump, 1, {unless(1), jump(1), kEnd});  // ELSE behind the end
}

TEST_CASE("loops begin and end in the same block") {
  refused(Refusal::bad_jump, 0, {again(1), kEnd});
  refused(Refusal::bad_jump, 0, {forever(1), kEnd});
  refused(Refusal::bad_jump, 3, {times(kThree), unless(2), kCommand, again(3), kEnd});
  refused(Refusal::bad_jump, 2, {unless(1), times(kThree), again(1), kEnd});
  refused(Refusal::bad_jump, 2, {times(kThree), kCommand, kEnd});  // no end
  // Out of the loop, by IF and by ELSE.
  refused(Refusal::bad_jump, 3, {times(kThree), unless(2), kCommand, again(3), kCommand, kEnd});
  refused(Refusal::bad_jump, 4,
          {times(kThree), unless(2), kCommand, jump(1), again(4), kCommand, kEnd});
}

TEST_CASE("a loop goes back to its own first word") {
  accepted({times(kThree), kCommand, again(2), kEnd});
  for (const unsigned back : {0U, 1U, 3U, 4U, 0xFFFFU})
    refused(Refusal::bad_jump, 2, {times(kThree), kCommand, again(back), kEnd});
  // Each with the end of its kind.
  const Word around = encode_wide(Op::around, kWatch, 2);
  const Word until = encode_wide(Op::until, kWatch, 2);
  for (const Word end : {around, until, forever(2)})
    refused(Refusal::bad_jump, 2, {times(kThree), kWait, end, kEnd});
  for (const Word end : {again(2), until})
    refused(Refusal::bad_jump, 2, {encode(Op::loop), kWait, end, kEnd});
  for (const Word end : {again(2), around, forever(2)})
    refused(Refusal::bad_jump, 2, {encode(Op::poll), kWait, end, kEnd});
  refused(Refusal::bad_jump, 2, {times(kThree), kCommand, again(2, kLocal2), kEnd});
}

TEST_CASE("a constant loop runs a whole number of times, at least once") {
  for (const std::uint16_t constant : {kHalf, kZero, kLess, std::uint16_t{6}})
    refused(Refusal::bad_operand, 0, {times(constant), again(1), kEnd});
}

TEST_CASE("at most kMaxBlocks blocks are open at once; ELSEs in a row are one") {
  const auto nested = [](unsigned depth) {
    Code code;
    for (unsigned i = 0; i < depth; ++i)
      code.push_back(unless(depth - 1 - i));
    return code + Code{kEnd};
  };
  accepted(nested(kMaxBlocks));
  refused(Refusal::too_deep, kMaxBlocks, nested(kMaxBlocks + 1));
  // PICK ONE of 60
  Code code;
  for (unsigned i = 0; i < 60; ++i)
    code = code + Code{unless(2), kCommand, jump(3 * (59 - i))};
  accepted(code + Code{kEnd});
}

TEST_CASE("a loop without a constant waits in every round") {
  refused(Refusal::endless, 1, {encode(Op::loop), forever(1), kEnd});
  refused(Refusal::endless, 1, {encode(Op::loop), encode_wide(Op::around, kWatch, 1), kEnd});
  refused(Refusal::endless, 1, {encode(Op::times_v, kLocal, 1), again(1), kEnd});
  accepted({encode(Op::loop), kWait, forever(2), kEnd});
  accepted({encode(Op::loop), encode(Op::wait_done), encode_wide(Op::around, kWatch, 2), kEnd});
  accepted({encode(Op::times_v, kLocal, 1), kWait, again(2), kEnd});
  accepted(
      {encode(Op::loop), encode(Op::poll), encode_wide(Op::until, kWatch, 1), forever(3), kEnd});
  // A wait that may be left out is none.
  refused(Refusal::endless, 3, {encode(Op::loop), unless(1), kWait, forever(3), kEnd});
  refused(Refusal::endless, 5,
          {encode(Op::loop), unless(2), kWait, jump(1), kCommand, forever(5), kEnd});
  // One in a loop inside is one: every loop runs at least once.
  accepted({encode(Op::loop), times(kThree), kWait, again(2), forever(4), kEnd});
  refused(Refusal::endless, 5,
          {encode(Op::loop), unless(3), times(kThree), kWait, again(2), forever(5), kEnd});
  // The loop around waits; the one inside does not.
  refused(Refusal::endless, 3,
          {encode(Op::loop), kWait, encode(Op::loop), forever(1), forever(4), kEnd});
}

TEST_CASE("registers are not carried over blocks and waits") {
  const Word write = encode(Op::move, kRegister, 1);
  const Code read{encode(Op::arg, kTo, kRegister), encode(Op::cmd, left_arm, move_verb, kNoWord),
                  kEnd};
  const auto lost = [&](const Code& between) {
    ImageBuilder image = with_response(Code{write} + between + read);
    image.responses[0].actuators = image.behaviors[0].actuators = 0b001;
    check_refused(image, {Refusal::unset_cell, Section::code,
                          static_cast<std::uint16_t>(kFirst + 1 + between.size())});
  };
  lost({kWait});
  lost({encode(Op::wait_done)});
  lost({unless(0)});
  lost({unless(1), write});
  lost({unless(1), jump(0)});
  lost({times(kThree)});
  lost({encode(Op::loop), kWait});
  lost({encode(Op::poll)});
  lost({times(kThree), write, again(2)});
  // But into an IF, for nothing else leads there.
  ImageBuilder image = with_response(Code{write, unless(2)} + read);
  image.responses[0].actuators = image.behaviors[0].actuators = 0b001;
  check_accepted(image);
  // Its own cell may be looked at twice.
  accepted({encode(Op::lt_k, kRegister, 1, kThree), encode_wide(Op::unless_known, kRegister, 4),
            encode_wide(Op::unless, kRegister, 2), kCommand, jump(1), kCommand, kEnd});
}

TEST_CASE("locals are numbers, and watches truths, whatever was before") {
  accepted({encode(Op::add, kRegister, kLocal, kLocal2), kEnd});
  accepted({encode(Op::move, kLocal, 1), encode(Op::random, kLocal2, kLocal, 1), kWait,
            encode(Op::wait, kLocal), kEnd});
  accepted({encode(Op::not_, kRegister, kWatch), kEnd});
  refused(Refusal::not_a_truth, 0, {encode(Op::not_, kRegister, kLocal), kEnd});
  // A truth in a local is a number.
  refused(Refusal::not_a_truth, 1,
          {encode(Op::move, kLocal, kWatch), encode(Op::not_, kRegister, kLocal), kEnd});
  refused(Refusal::bad_operand, 0, {encode(Op::not_, kWatch, kWatch), kEnd});
}

TEST_CASE("only locals count, and keep a deadline") {
  for (const unsigned cell : {0U, 1U, kWatch, kRegister, 10U, 255U}) {
    refused(Refusal::bad_operand, 0, {times(kThree, cell), again(1, cell), kEnd});
    refused(Refusal::bad_operand, 0, {encode(Op::times_v, cell, 1), kWait, again(2, cell), kEnd});
    refused(Refusal::bad_operand, 0, {encode(Op::deadline, cell, 1), kEnd});
  }
}

TEST_CASE("inside a loop nothing else writes its count") {
  const Word writes[] = {encode(Op::move, kLocal, 1),
                         encode_wide(Op::load, kLocal, kMuch),
                         encode(Op::deadline, kLocal, 1),
                         encode(Op::not_, kLocal, kWatch),
                         times(kTwo),
                         encode(Op::times_v, kLocal, 1)};
  for (const Word write : writes) {
    refused(Refusal::shared_local, 1, {times(kThree), write, again(2), kEnd});
    refused(Refusal::shared_local, 2,
            {times(kThree), times(kThree, kLocal2), write, again(2, kLocal2), again(4), kEnd});
  }
  for (const Word write : {writes[0], writes[1], writes[2], writes[3]})
    accepted({write, times(kThree), again(1), write, times(kTwo), again(1), kEnd});
  accepted(
      {times(kThree), encode(Op::move, kLocal2, kLocal), again(2), kEnd});  // reading it is fine
}

TEST_CASE("a local belongs to one response of its behaviour") {
  ImageBuilder image = with_response({encode(Op::move, kLocal, 1), kEnd});
  const std::uint16_t other = image.response(0, {encode(Op::move, kLocal2, kLocal), kEnd});
  image.rules[0].kind = RuleKind::when_else;
  image.rules[0].else_response = other;
  check_accepted(image);
  image.code[image.responses[other].start] = encode(Op::move, kLocal, 1);
  check_refused(image, {Refusal::shared_local, Section::code, image.responses[other].start});
  // Two rules that run the same one.
  image.rules[0].else_response = 0;
  check_refused(image, {Refusal::shared_local, Section::code, kFirst});
  // In another behaviour the cell is another.
  image = with_response({encode(Op::move, kLocal, 1), kEnd});
  image.behaviors.push_back(image.behaviors[0]);
  image.behaviors[1].priority = 0;
  image.behaviors[1].first_rule = 2;
  image.rules.push_back(image.rules[0]);
  image.rules.push_back(image.rules[1]);
  check_accepted(image);
}

TEST_CASE("conditions write no locals") {
  ImageBuilder image = with_response({kEnd});
  image.code[0] = encode(Op::add, kLocal, 1, 1);
  check_refused(image, {Refusal::bad_operand, Section::code, 0});
}

TEST_CASE("only variables can be set, no sensors and no bands") {
  for (const Op op : {Op::set, Op::shift}) {
    accepted({encode(op, 0, 1), kEnd});
    for (const unsigned cell : {1U, 2U, kLocal, kWatch, kRegister, 10U, 255U})
      refused(Refusal::bad_operand, 0, {encode(op, cell, 1), kEnd});
    refused(Refusal::unset_cell, 0, {encode(op, 0, kRegister), kEnd});
  }
}

TEST_CASE("only the first kMaxWritable inputs can be set") {
  ImageBuilder image = with_response({encode(Op::set, kMaxWritable - 1, 0), kEnd});
  image.inputs.assign(kMaxWritable + 1, input_of(visitors));
  image.inputs[1] = touch_level;
  image.behaviors[0].input_count = kMaxWritable + 1;
  image.behaviors[0].cells = kMaxWritable + 10;
  image.code[0] = image.code[2] = encode(Op::lt_k, kMaxWritable + 4, 1, kThree);
  image.code[1] = image.code[3] = encode(Op::ret, kMaxWritable + 4);
  check_accepted(image);
  image.code[kFirst] = encode(Op::set, kMaxWritable, 0);
  check_refused(image, {Refusal::bad_operand, Section::code, kFirst});
}

TEST_CASE("texts are in the string pool; LOG and ALERT take up parameters") {
  const ImageBuilder image = with_response({kEnd});
  const auto last = static_cast<unsigned>(image.strings.size() - 1);
  for (const Op op : {Op::log, Op::alert}) {
    accepted({encode_wide(op, 0, last), kEnd});
    refused(Refusal::bad_operand, 0, {encode_wide(op, 0, last + 1), kEnd});
  }
  const Word param = encode(Op::arg, kTo, 0);
  for (const Op op : {Op::log, Op::alert})
    accepted({param, encode(Op::arg, 7, 0), encode_wide(op, 0, 0), kEnd});
  refused(Refusal::unused_param, 1, {param, kWait, kCommand, kEnd});
  refused(Refusal::unused_param, 1, {param, unless(1), kCommand, kEnd});
  refused(Refusal::unused_param, 2, {unless(1), param, kCommand, kEnd});
  refused(Refusal::unused_param, 2, {times(kThree), param, again(2), kCommand, kEnd});
}

TEST_CASE("each time word has a timer of its kind, and of its own") {
  const auto with_timers = [](Word first, Word second) {
    ImageBuilder image = with_response({kEnd});
    image.timer(TimerKind::held, 1 * kScale);
    image.timer(TimerKind::rose, 0);
    image.rules[1].condition_start = image.object(
        {encode(Op::lt_k, kRegister, 1, kThree), first, second, encode(Op::ret, kRegister)});
    image.rules[1].condition_length = 4;
    return image;
  };
  const Word held = encode(Op::held, kRegister, kRegister, 0);
  const Word rose = encode(Op::rose, kRegister, kRegister, 1);
  constexpr std::uint16_t kCondition = kFirst + 1;
  check_accepted(with_timers(held, rose));
  const auto refused_timer = [&](Refusal refusal, unsigned word, Word first, Word second) {
    check_refused(with_timers(first, second),
                  {refusal, Section::code, static_cast<std::uint16_t>(kCondition + word)});
  };
  refused_timer(Refusal::bad_operand, 2, held, encode(Op::rose, kRegister, kRegister, 2));
  refused_timer(Refusal::wrong_timer, 1, encode(Op::rose, kRegister, kRegister, 0), rose);
  refused_timer(Refusal::wrong_timer, 1, encode(Op::latch, kRegister, kRegister, 0), rose);
  refused_timer(Refusal::shared_timer, 2, held, held);
  refused_timer(Refusal::shared_timer, 2, rose, held);  // they are taken in rising order
  // Two rules with the same condition.
  ImageBuilder image = with_timers(held, rose);
  image.rules[0].condition_start = image.rules[1].condition_start;
  image.rules[0].condition_length = 4;
  check_refused(image, {Refusal::shared_timer, Section::code, kCondition + 1});
}

TEST_CASE("time words keep to truths and numbers") {
  const auto condition = [](Word word) {
    ImageBuilder image = with_response({kEnd});
    image.timer(timer_kind_of(opcode_of(word)), 0, opcode_of(word) == Op::counted ? 2 : 0);
    image.rules[1].condition_start =
        image.object({encode(Op::lt_k, kRegister, 1, kThree), word, encode(Op::ret, kRegister)});
    image.rules[1].condition_length = 3;
    return image;
  };
  const auto refused_word = [&](Refusal refusal, Word word) {
    check_refused(condition(word), {refusal, Section::code, kFirst + 2});
  };
  for (const Op op : {Op::held, Op::counted, Op::sequence, Op::latch, Op::rose}) {
    check_accepted(condition(encode(op, kRegister, kWatch, 0)));
    refused_word(Refusal::not_a_truth, encode(op, kRegister, 1, 0));
    refused_word(Refusal::unset_cell, encode(op, kRegister, kRegister + 1, 0));
    refused_word(Refusal::bad_operand, encode(op, kWatch, kWatch, 0));
  }
  check_accepted(condition(encode(Op::changed, kRegister, 1, 0)));
  for (const Op op : {Op::sequence, Op::latch}) {  // A is read, too
    refused_word(Refusal::unset_cell, encode(op, kRegister + 1, kRegister, 0));
    refused_word(Refusal::not_a_truth, encode(op, kLocal, kRegister, 0));
  }
}

TEST_CASE("an EVERY rule's code gives a number, any other condition a truth") {
  ImageBuilder image = with_response({kEnd});
  image.rules[0].kind = RuleKind::every;
  check_refused(image, {Refusal::wrong_context, Section::code, 1});
  image.rules[0].condition_start = image.object({encode(Op::ret_number, 1)});
  image.rules[0].condition_length = 1;
  check_accepted(image);
  image.rules[0].kind = RuleKind::while_;
  check_refused(image, {Refusal::wrong_context, Section::code, image.rules[0].condition_start});
}

TEST_CASE("a SAFETY body only stops, sets and tells") {
  const auto body = [](const Code& code) {
    ImageBuilder image = make();
    Response& response = image.responses[stop];
    response.start = static_cast<std::uint16_t>(image.code.size());
    response.length = static_cast<std::uint16_t>(code.size());
    response.actuators = image.behaviors[0].actuators = 0;
    image.code.insert(image.code.end(), code.begin(), code.end());
    return image;
  };
  const auto first = static_cast<std::uint16_t>(make().code.size());
  check_accepted(body({encode(Op::set, 1, 0), kEnd}));
  for (const Word word :
       {kCommand, kWait, unless(0), encode(Op::loop), encode(Op::poll), encode(Op::wait_done)})
    check_refused(body({word, kEnd}), {Refusal::wrong_context, Section::code, first});
  check_refused(body({encode(Op::cmd_end, left_arm, move_verb, slowly)}),
                {Refusal::wrong_context, Section::code, first});
  for (const unsigned target : {3U, kGroupBit + 1U, 254U})
    check_refused(body({encode(Op::halt, target), kEnd}),
                  {Refusal::bad_operand, Section::code, first});
  ImageBuilder image = body({encode(Op::halt, speaker), kEnd});
  check_refused(image, {Refusal::mask_differs, Section::responses, stop});
  image.responses[stop].actuators = image.behaviors[0].actuators = 0b100;
  check_accepted(image);
}
