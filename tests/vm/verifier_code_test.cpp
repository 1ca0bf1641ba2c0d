// Each check of the verifier that looks at code: one wrong object, refused at its wrong word.
#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using namespace robosync::vm::test::companion;
using Op = Opcode;
using Instructions = std::initializer_list<Word>;

namespace {

// One behaviour with two inputs (r0, r1) and registers r2 … r5; constants 3 (a number) and -0.001
// (which is also kTrue).
constexpr std::uint16_t kThreeConstant = 0;
constexpr std::uint16_t kTrueConstant = 1;
constexpr unsigned kItem = static_cast<unsigned>(Param::item);

ImageBuilder one_rule(std::uint32_t mask, Instructions response, Instructions condition) {
  ImageBuilder image;
  add_robot(image);
  image.constants = {3 * kScale, kTrue};
  image.inputs = {touch_level, distance};
  image.response(mask, response);
  image.rule(0, kNoIndex, condition);
  image.behaviors.push_back({1, kNoIndex, mask, 0, 2, 1, 0, 0, 6});
  return image;
}

const Instructions kTrivialResponse = {encode(Op::end)};
const Instructions kTrivialCondition = {encode(Op::lt_k, 2, 0, kThreeConstant), encode(Op::ret, 2)};

// The condition follows the trivial response, so it starts at word 1.
void condition_refused(Refusal refusal, std::uint16_t word, Instructions condition) {
  check_refused(one_rule(0, kTrivialResponse, condition),
                {refusal, Section::code, static_cast<std::uint16_t>(1 + word)});
}
void condition_accepted(Instructions condition) {
  check_accepted(one_rule(0, kTrivialResponse, condition));
}
void response_refused(Refusal refusal, std::uint16_t word, std::uint32_t mask,
                      Instructions response) {
  check_refused(one_rule(mask, response, kTrivialCondition), {refusal, Section::code, word});
}
void response_accepted(std::uint32_t mask, Instructions response) {
  check_accepted(one_rule(mask, response, kTrivialCondition));
}

}  // namespace

TEST_CASE("opcodes that are none are refused") {
  for (unsigned op = static_cast<unsigned>(Op::count_); op < 256; ++op)
    condition_refused(Refusal::bad_opcode, 0, {op, encode(Op::ret, 2)});
}

TEST_CASE("objects end with their terminator, and only there") {
  condition_refused(Refusal::no_end, 0, {encode(Op::lt_k, 2, 0, kThreeConstant)});
  condition_refused(
      Refusal::wrong_context, 1,
      {encode(Op::lt_k, 2, 0, kThreeConstant), encode(Op::ret, 2), encode(Op::ret, 2)});
  response_refused(Refusal::no_end, 0, 0b001, {encode(Op::cmd, left_arm, move_verb, slowly)});
  response_refused(Refusal::wrong_context, 0, 0, {encode(Op::end), encode(Op::end)});
  response_refused(Refusal::wrong_context, 0, 0b001,
                   {encode(Op::cmd_end, left_arm, move_verb, slowly), encode(Op::end)});
}

TEST_CASE("opcodes stand in their own context only") {
  for (const Word word :
       {encode(Op::arg, kTo, 0), encode_wide(Op::arg_k, kTo, kThreeConstant),
        encode(Op::cmd, left_arm, move_verb, slowly),
        encode(Op::cmd_end, left_arm, move_verb, slowly), encode(Op::end), encode(Op::loop),
        encode(Op::wait, 0), encode_wide(Op::log, 0, 0), encode(Op::halt, kAllActuators)}) {
    condition_refused(Refusal::wrong_context, 0, {word});
    condition_refused(Refusal::wrong_context, 0, {word, encode(Op::ret, 2)});
  }
  response_refused(Refusal::wrong_context, 1, 0,
                   {encode(Op::lt_k, 2, 0, kThreeConstant), encode(Op::ret, 2)});
  response_refused(
      Refusal::wrong_context, 1, 0,
      {encode(Op::lt_k, 2, 0, kThreeConstant), encode(Op::rose, 2, 2, 0), encode(Op::end)});
  response_refused(Refusal::wrong_context, 0, 0,
                   {encode(Op::halt, kAllActuators), encode(Op::end)});
}

TEST_CASE("operand bytes without a meaning are zero") {
  condition_refused(Refusal::bad_operand, 0, {encode(Op::move, 2, 0, 1), encode(Op::ret, 2)});
  condition_refused(Refusal::bad_operand, 1,
                    {encode(Op::lt_k, 2, 0, kThreeConstant), encode(Op::ret, 2, 1)});
  condition_refused(Refusal::bad_operand, 1,
                    {encode(Op::lt_k, 2, 0, kThreeConstant), encode(Op::ret, 2, 0, 1)});
  response_refused(Refusal::bad_operand, 0, 0, {encode(Op::end, 1)});
  response_refused(Refusal::bad_operand, 0, 0, {encode(Op::end, 0, 1)});
  response_refused(Refusal::bad_operand, 0, 0, {encode(Op::end, 0, 0, 1)});
  response_refused(Refusal::bad_operand, 0, 0, {encode(Op::arg, kTo, 0, 1), encode(Op::end)});
}

TEST_CASE("cells are written inside the registers only") {
  for (const unsigned cell : {0U, 1U, 6U, 255U})
    condition_refused(Refusal::bad_operand, 0,
                      {encode(Op::lt_k, cell, 0, kThreeConstant), encode(Op::ret, 2)});
  condition_accepted({encode(Op::lt_k, 5, 0, kThreeConstant), encode(Op::ret, 5)});
}

TEST_CASE("cells are read inside the frame only") {
  condition_refused(Refusal::bad_operand, 0, {encode(Op::lt, 2, 6, 0), encode(Op::ret, 2)});
  condition_refused(Refusal::bad_operand, 0, {encode(Op::lt, 2, 0, 255), encode(Op::ret, 2)});
  condition_refused(Refusal::bad_operand, 0, {encode(Op::ret, 6)});
  response_refused(Refusal::bad_operand, 0, 0, {encode(Op::arg, kTo, 6), encode(Op::end)});
}

TEST_CASE("a register is written before it is read, in the same object") {
  condition_refused(Refusal::unset_cell, 0, {encode(Op::lt, 2, 2, 0), encode(Op::ret, 2)});
  condition_refused(Refusal::unset_cell, 0, {encode(Op::lt, 2, 0, 5), encode(Op::ret, 2)});
  condition_refused(Refusal::unset_cell, 0, {encode(Op::ret, 3)});
  // The condition's r2 is not the response's.
  response_refused(Refusal::unset_cell, 0, 0b001,
                   {encode(Op::arg, kTo, 2), encode(Op::cmd_end, left_arm, move_verb, kNoWord)});
  response_accepted(0b001, {encode(Op::move, 2, 1), encode(Op::arg, kTo, 2),
                            encode(Op::cmd_end, left_arm, move_verb, kNoWord)});
}

TEST_CASE("a full frame of 255 cells can be used to its last cell") {
  ImageBuilder image = one_rule(0, kTrivialResponse,
                                {encode(Op::lt_k, 254, 253, kThreeConstant), encode(Op::ret, 254)});
  image.inputs.assign(254, touch_level);
  image.behaviors[0].input_count = 254;
  image.behaviors[0].cells = 255;
  check_accepted(image);
  image.behaviors[0].cells = 254;
  check_refused(image, {Refusal::bad_operand, Section::code, 1});
}

TEST_CASE("a number is not a truth value") {
  condition_refused(Refusal::not_a_truth, 0, {encode(Op::ret, 0)});  // an input
  condition_refused(Refusal::not_a_truth, 1, {encode(Op::add, 2, 0, 1), encode(Op::ret, 2)});
  condition_refused(Refusal::not_a_truth, 1,
                    {encode_wide(Op::load, 2, kThreeConstant), encode(Op::ret, 2)});
  condition_refused(Refusal::not_a_truth, 1, {encode(Op::move, 2, 0), encode(Op::ret, 2)});
  condition_refused(Refusal::not_a_truth, 0, {encode(Op::not_, 2, 0), encode(Op::ret, 2)});
  condition_refused(Refusal::not_a_truth, 1,
                    {encode(Op::eq, 2, 0, 1), encode(Op::and_, 2, 2, 1), encode(Op::ret, 2)});
  condition_refused(Refusal::not_a_truth, 1,
                    {encode(Op::eq, 2, 0, 1), encode(Op::or_, 2, 1, 2), encode(Op::ret, 2)});
  // A register that held a truth value is given a number.
  condition_refused(Refusal::not_a_truth, 2,
                    {encode(Op::eq, 2, 0, 1), encode(Op::neg, 2, 2), encode(Op::ret, 2)});
}

TEST_CASE("truth values come from comparisons, logic, and truth constants, and can be copied") {
  condition_accepted({encode_wide(Op::load, 2, kTrueConstant), encode(Op::ret, 2)});
  condition_accepted({encode(Op::eq, 2, 0, 1), encode(Op::move, 3, 2), encode(Op::ret, 3)});
  condition_accepted({encode(Op::ne, 2, 0, 1), encode(Op::not_, 3, 2), encode(Op::or_, 4, 3, 2),
                      encode(Op::and_, 4, 4, 3), encode(Op::ret, 4)});
  condition_accepted({encode(Op::eq, 2, 0, 1), encode(Op::eq_k, 3, 2, kTrueConstant),
                      encode(Op::ret, 3)});  // a truth value compared
}

TEST_CASE("constants are those of the image") {
  condition_refused(Refusal::bad_operand, 0, {encode(Op::lt_k, 2, 0, 2), encode(Op::ret, 2)});
  condition_refused(Refusal::bad_operand, 0, {encode_wide(Op::load, 2, 2), encode(Op::ret, 2)});
  condition_refused(Refusal::bad_operand, 0,
                    {encode_wide(Op::load, 2, 0xFFFF), encode(Op::ret, 2)});
  response_refused(Refusal::bad_operand, 0, 0, {encode_wide(Op::arg_k, kTo, 2), encode(Op::end)});
}

TEST_CASE("commands name an actuator or group, a verb and a word that exist") {
  const Instructions good = {encode(Op::cmd_end, arms, move_verb, kNoWord)};
  response_accepted(0b011, good);
  response_refused(Refusal::bad_operand, 0, 0b001, {encode(Op::cmd_end, 3, move_verb, slowly)});
  response_refused(Refusal::bad_operand, 0, 0b001,
                   {encode(Op::cmd_end, kGroupBit + 1, move_verb, slowly)});
  response_refused(Refusal::bad_operand, 0, 0b001, {encode(Op::cmd_end, left_arm, 2, slowly)});
  response_refused(Refusal::bad_operand, 0, 0b001, {encode(Op::cmd_end, left_arm, move_verb, 4)});
}

TEST_CASE("every member of the target knows the verb") {
  response_refused(Refusal::wrong_verb, 0, 0b001,
                   {encode(Op::cmd_end, left_arm, play_verb, greeting)});
  ImageBuilder image =
      one_rule(0b011, {encode(Op::cmd_end, arms, move_verb, slowly)}, kTrivialCondition);
  check_accepted(image);
  image.actuators[right_arm].verbs = 0;
  check_refused(image, {Refusal::wrong_verb, Section::code, 0});
}

TEST_CASE("the verb takes the parameters given to it") {
  response_refused(Refusal::bad_operand, 0, 0b001, {encode(Op::arg, 8, 0), encode(Op::end)});
  response_refused(Refusal::wrong_verb, 1, 0b001,
                   {encode(Op::arg, kItem, 0), encode(Op::cmd_end, left_arm, move_verb, slowly)});
  response_refused(Refusal::wrong_verb, 1, 0b001,
                   {encode_wide(Op::arg_k, kItem, kThreeConstant),
                    encode(Op::cmd_end, left_arm, move_verb, kNoWord)});
  // The word gives a parameter, too.
  response_refused(Refusal::wrong_verb, 0, 0b001,
                   {encode(Op::cmd_end, left_arm, move_verb, greeting)});
  // Parameters are used up by the command before.
  response_accepted(0b101,
                    {encode(Op::arg, kTo, 0), encode(Op::cmd, left_arm, move_verb, slowly),
                     encode(Op::arg, kItem, 1), encode(Op::cmd_end, speaker, play_verb, kNoWord)});
}

TEST_CASE("no parameter is left over at the end") {
  response_refused(Refusal::unused_param, 1, 0, {encode(Op::arg, kTo, 0), encode(Op::end)});
  response_refused(Refusal::unused_param, 2, 0b001,
                   {encode(Op::cmd, left_arm, move_verb, slowly),
                    encode_wide(Op::arg_k, kTo, kThreeConstant), encode(Op::end)});
}

TEST_CASE("a response puts out at most kMaxResponseOutput words") {
  const auto with_output = [](unsigned commands, bool with_param) {
    ImageBuilder image = one_rule(0b001, kTrivialResponse, kTrivialCondition);
    std::vector<Word> words(commands, encode(Op::cmd, left_arm, move_verb, slowly));
    if (with_param) words.insert(words.begin(), encode(Op::arg, kTo, 0));
    words.push_back(encode(Op::end));
    image.responses[0] = {static_cast<std::uint16_t>(image.code.size()),
                          static_cast<std::uint16_t>(words.size()), 0b001};
    image.code.insert(image.code.end(), words.begin(), words.end());
    return image;
  };
  const auto word = [](unsigned place) { return static_cast<std::uint16_t>(3 + place); };
  check_accepted(with_output(kMaxResponseOutput, false));
  check_refused(with_output(kMaxResponseOutput + 1, false),
                {Refusal::too_much_output, Section::code, word(kMaxResponseOutput)});
  check_accepted(with_output(kMaxResponseOutput - 2, true));  // a parameter takes two words
  check_refused(with_output(kMaxResponseOutput - 1, true),
                {Refusal::too_much_output, Section::code, word(kMaxResponseOutput - 1)});
}

TEST_CASE("the actuators a response commands are those it declares") {
  const Instructions code = {encode(Op::cmd, speaker, play_verb, greeting),
                             encode(Op::cmd_end, arms, move_verb, slowly)};
  response_accepted(0b111, code);
  for (const std::uint32_t mask : {0b011U, 0b110U, 0b1111U, 0U})
    check_refused(one_rule(mask, code, kTrivialCondition),
                  {Refusal::mask_differs, Section::responses, 0});
}

TEST_CASE("a response shared by behaviours is checked in the frame of each") {
  // Reads r1 and writes r3; the second behaviour's frame is made too small, and differently laid
  // out.
  ImageBuilder image = one_rule(0b001,
                                {encode(Op::move, 3, 1), encode(Op::arg, kTo, 3),
                                 encode(Op::cmd_end, left_arm, move_verb, kNoWord)},
                                kTrivialCondition);
  image.rules.push_back(image.rules[0]);
  image.behaviors.push_back({0, kNoIndex, 0b001, 0, 2, 1, 1, 0, 6});
  check_accepted(image);
  Behavior& second = image.behaviors[1];
  second.cells = 3;
  check_refused(image, {Refusal::bad_operand, Section::code, 0});
  second.cells = 6;
  second.input_count = 1;
  check_refused(image, {Refusal::unset_cell, Section::code, 0});
  image.inputs = {touch_level, distance, touch_force, touch_force};
  image.rules[1].condition_start =
      image.object({encode(Op::lt_k, 4, 0, kThreeConstant), encode(Op::ret, 4)});
  second.input_count = 4;
  check_refused(image, {Refusal::bad_operand, Section::code, 0});
}

TEST_CASE("the costlier response of a rule counts, and every condition") {
  const auto cost = [](Op op) { return kOpcodes[static_cast<std::size_t>(op)].cost; };
  ImageBuilder image =
      one_rule(0b001, {encode(Op::cmd_end, left_arm, move_verb, slowly)}, kTrivialCondition);
  const std::uint16_t cheap = image.response(0, {encode(Op::end)});
  image.rules[0].kind = RuleKind::when_else;
  image.rules[0].else_response = cheap;
  Bytes bytes = image.build();
  Image view;
  REQUIRE(verify(bytes, {}, view).ok());
  CHECK(step_cost(view) == cost(Op::lt_k) + cost(Op::ret) + cost(Op::cmd_end));

  std::swap(image.rules[0].then_response, image.rules[0].else_response);
  image.rules.push_back(image.rules[0]);
  image.behaviors[0].rule_count = 2;
  bytes = image.build();
  REQUIRE(verify(bytes, {}, view).ok());
  CHECK(step_cost(view) == 2U * (cost(Op::lt_k) + cost(Op::ret) + cost(Op::cmd_end)));
}

TEST_CASE("sharing cannot make verification longer than the board allows") {
  // 250 rules that share one response of 3,001 words: 750,000 words to look at, if nobody counts.
  ImageBuilder image = one_rule(0, kTrivialResponse, kTrivialCondition);
  std::vector<Word> words(3000, encode(Op::wait_done));  // a step costs next to nothing
  words.push_back(encode(Op::end));
  image.responses[0] = {static_cast<std::uint16_t>(image.code.size()), 3001, 0};
  image.code.insert(image.code.end(), words.begin(), words.end());
  image.rules.assign(250, image.rules[0]);
  image.behaviors[0].rule_count = 250;
  Limits limits;
  limits.step_cost = 250 * (3001 + 2);
  check_accepted(image, limits);
  --limits.step_cost;  // noticed at the last condition
  check_refused(image, {Refusal::too_costly, Section::code, 1}, limits);
}

TEST_CASE("step_cost() does not look at what the header says, and finds nothing in bad code") {
  ImageBuilder image = one_rule(0, kTrivialResponse, kTrivialCondition);
  const auto cost = [](Op op) { return kOpcodes[static_cast<std::size_t>(op)].cost; };
  const auto cost_of = [](const ImageBuilder& builder) {
    const Bytes bytes = builder.build();
    Image view;
    REQUIRE(view_image(bytes, view));
    return step_cost(view);
  };
  image.patch_header = [](ImageHeader& h) { h.step_cost = 1; };
  CHECK(cost_of(image) == cost(Op::lt_k) + cost(Op::ret) + cost(Op::end));
  image.code[0] = static_cast<Word>(Op::count_);
  CHECK(cost_of(image) == 0);
  image.code[0] = encode(Op::end);
  image.rules[0].then_response = 1;  // what follows the last response is none
  image.inputs = {0, 0, 1, 0, 0, 0, 0, 0};
  CHECK(cost_of(image) == 0);
}
