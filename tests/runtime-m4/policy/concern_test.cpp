// The inputs that code reads or sets, operand by operand.
#include "runtime-m4/policy/concern.hpp"

#include <array>
#include <set>

#include <catch2/catch.hpp>

using namespace robosync;
using vm::Opcode;

namespace {

constexpr std::uint8_t kInputs = 3;  // cells 0, 1, 2 are inputs 10, 11, 12; cell 3 is a register

struct Code {
  explicit Code(const std::vector<vm::Word>& words) : code(words) {
    behavior.input_count = kInputs;
    image.inputs = inputs;
    image.code = code;
  }
  std::multiset<unsigned> read(std::uint16_t start, std::uint16_t length) const {
    std::multiset<unsigned> found;
    policy::each_input(image, behavior, start, length,
                       [&](unsigned input) { found.insert(input); });
    return found;
  }
  std::vector<vm::Word> code;
  std::array<std::uint8_t, kInputs> inputs{10, 11, 12};
  vm::Behavior behavior{};
  vm::Image image;
};

}  // namespace

TEST_CASE("cells that are read or set count, numbers that are no cells do not") {
  const Code code({vm::encode(Opcode::add, 3, 0, 1),     // a register of two inputs
                   vm::encode(Opcode::gt_k, 3, 2, 1),    // 1 is a constant
                   vm::encode(Opcode::and_, 3, 3, 0),    // a register and a truth
                   vm::encode(Opcode::set, 1, 3),        // a variable is set
                   vm::encode(Opcode::cmd, 0, 1, 2),     // an actuator, a verb, a word
                   vm::encode(Opcode::held, 3, 2, 0)});  // 0 is a timer
  CHECK(code.read(0, 1) == std::multiset<unsigned>{10, 11});
  CHECK(code.read(1, 1) == std::multiset<unsigned>{12});
  CHECK(code.read(2, 1) == std::multiset<unsigned>{10});
  CHECK(code.read(3, 1) == std::multiset<unsigned>{11});
  CHECK(code.read(4, 1).empty());
  CHECK(code.read(5, 1) == std::multiset<unsigned>{12});
  CHECK(code.read(0, 6).size() == 6);
}

TEST_CASE("a rule has the inputs of its condition and of both responses") {
  Code code({vm::encode(Opcode::gt_k, 3, 0, 0), vm::encode(Opcode::ret, 3),
             vm::encode(Opcode::log, 1), vm::encode(Opcode::set, 1, 3),
             vm::encode(Opcode::arg, 0, 2)});
  std::array<vm::Response, 2> responses{};
  responses[0].start = 3;
  responses[0].length = 1;
  responses[1].start = 4;
  responses[1].length = 1;
  code.image.responses = responses;
  vm::Rule rule{};
  rule.condition_length = 2;
  rule.then_response = 0;
  rule.else_response = 1;
  std::set<unsigned> all;
  std::set<unsigned> condition;
  policy::each_input_of_rule(code.image, code.behavior, rule,
                             [&](unsigned input) { all.insert(input); });
  policy::each_input_of_condition(code.image, code.behavior, rule,
                                  [&](unsigned input) { condition.insert(input); });
  CHECK(all == std::set<unsigned>{10, 11, 12});
  CHECK(condition == std::set<unsigned>{10});
  rule.else_response = vm::kNoIndex;
  all.clear();
  policy::each_input_of_rule(code.image, code.behavior, rule,
                             [&](unsigned input) { all.insert(input); });
  CHECK(all == std::set<unsigned>{10, 11});
}
