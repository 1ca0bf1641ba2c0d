// The rules that a step concerns: the index from inputs to rules, and what steps evaluate.
#include <memory>
#include <set>

#include <catch2/catch.hpp>

#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/sim/arena.hpp"
#include "tests/runtime-m4/layers/draw.hpp"
#include "tests/runtime-m4/layers/spread.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "vm/interpreter.hpp"
#include "vm/opcode.hpp"

using namespace robosync;
using test::Draw;
using test::Rig;
using test::Spread;

namespace {

// --- the index ---

constexpr unsigned kInputsOfAll = policy::kMaxChannels + policy::kMaxVariables;

// A behaviour with random conditions: straight-line code over its inputs and three registers.
struct DrawnConditions {
  static constexpr unsigned kInputs = 6;
  static constexpr unsigned kRegisters = 3;
  static constexpr unsigned kRules = 12;

  explicit DrawnConditions(Draw& draw) {
    for (unsigned i = 0; i < kInputs; ++i)
      inputs.push_back(static_cast<std::uint8_t>(draw.below(kInputsOfAll)));
    behavior.input_count = kInputs;
    behavior.rule_count = kRules;
    behavior.cells = kInputs + kRegisters;
    for (vm::Rule& rule : rules) {
      rule.condition_start = static_cast<std::uint16_t>(code.size());
      const unsigned words = draw.below(4);
      for (unsigned w = 0; w < words; ++w)
        code.push_back(word(draw));
      code.push_back(vm::encode(vm::Opcode::ret_number, kInputs + draw.below(kRegisters)));
      rule.condition_length = static_cast<std::uint16_t>(words + 1);
      rule.then_response = rule.else_response = vm::kNoIndex;
    }
    image.header = &header;
    image.channels = channels;
    image.variables = variables;
    image.behaviors = {&behavior, 1};
    image.rules = rules;
    image.inputs = inputs;
    image.code = code;
  }

  static vm::Word word(Draw& draw) {
    using vm::Opcode;
    constexpr Opcode kWithConstant[] = {Opcode::lt_k, Opcode::eq_k, Opcode::min_k};
    constexpr Opcode kOfTwo[] = {Opcode::add, Opcode::sub, Opcode::lt, Opcode::eq};
    const unsigned to = kInputs + draw.below(kRegisters);
    const unsigned from = draw.below(kInputs + kRegisters);
    // The constant's index is also a valid cell number.
    if (draw.one_in(2)) return vm::encode(kWithConstant[draw.below(3)], to, from, draw.below(6));
    return vm::encode(kOfTwo[draw.below(4)], to, from, draw.below(kInputs + kRegisters));
  }

  vm::Value evaluate(unsigned rule, std::vector<vm::Value> frame) const {
    vm::Machine machine;
    machine.frame = frame.data();
    machine.constants = constants.data();
    return vm::evaluate(machine, &code[rules[rule].condition_start]);
  }

  vm::ImageHeader header{};
  std::array<vm::Channel, policy::kMaxChannels> channels{};
  std::array<vm::Variable, policy::kMaxVariables> variables{};
  std::vector<vm::Value> constants = {0, 1, 2, 3, 1000, 5000};
  std::vector<std::uint8_t> inputs;
  std::vector<vm::Word> code;
  std::array<vm::Rule, kRules> rules{};
  vm::Behavior behavior{};
  vm::Image image;
};

// A program with its own memory.
class Loaded {
public:
  void load(const vm::Image& image) {
    memory_.lay_out(policy::needs_of(image, memory_.board()));
    program_.load(image, memory_);
  }
  const layers::LoadedProgram& operator*() const { return program_; }
  const layers::LoadedProgram* operator->() const { return &program_; }

private:
  sim::Arena arena_;
  layers::Memory memory_{arena_.bytes(), arena_.board()};
  layers::LoadedProgram program_;
};

std::set<unsigned> readers_of(const layers::LoadedProgram& program, unsigned input) {
  std::vector<layers::RuleSet::Word> words(
      policy::set_words(static_cast<std::uint32_t>(program.image.rules.size())));
  layers::RuleSet readers;
  readers.start(words);
  program.add_readers_of(input, readers);
  std::set<unsigned> rules;
  readers.each([&](unsigned rule) { rules.insert(rule); });
  return rules;
}

}  // namespace

TEST_CASE("the index has every rule whose result an input can change, and names what it reads") {
  Draw draw(4);
  Loaded program;
  unsigned seen = 0;
  for (unsigned round = 0; round < 400; ++round) {
    const DrawnConditions drawn(draw);
    program.load(drawn.image);
    for (unsigned rule = 0; rule < DrawnConditions::kRules; ++rule) {
      // The inputs that the code names, according to the table from which the documentation is generated.
      std::set<unsigned> named;
      for (const vm::Word word : drawn.image.code.subspan(drawn.rules[rule].condition_start,
                                                          drawn.rules[rule].condition_length)) {
        const auto& operands = vm::kOpcodes[word & 0xFF].operands;
        for (unsigned i = 0; i < operands.size(); ++i)
          if (const unsigned cell = word >> (8 + 8 * i) & 0xFF;
              operands[i] == vm::Operand::read && cell < DrawnConditions::kInputs)
            named.insert(drawn.inputs[cell]);
      }
      for (unsigned input = 0; input < kInputsOfAll; ++input)
        REQUIRE(readers_of(*program.operator->(), input).contains(rule) == named.contains(input));
      // The inputs that a run reads.
      std::vector<vm::Value> frame(DrawnConditions::kInputs + DrawnConditions::kRegisters);
      for (vm::Value& cell : frame)
        cell = static_cast<vm::Value>(draw.below(6));
      const vm::Value before = drawn.evaluate(rule, frame);
      const unsigned cell = draw.below(DrawnConditions::kInputs);
      frame[cell] = static_cast<vm::Value>(draw.below(6000));
      if (drawn.evaluate(rule, frame) == before) continue;
      ++seen;
      REQUIRE(readers_of(*program.operator->(), drawn.inputs[cell]).contains(rule));
    }
  }
  CHECK(seen > 100);
}

TEST_CASE("SAFETY rules are in no index: they are evaluated in any case") {
  const auto bytes = test::compile(
      "SAFETY s\nWHEN near X > 90 DO\nSTOP a\nEND\nWHEN near X > 10 DO\nMOVE a\nEND\n",
      test::kPlainRobot);
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  Loaded program;
  program.load(image);
  CHECK(readers_of(*program, 0) == std::set<unsigned>{1});
}

// --- evaluations ---

TEST_CASE("a reading costs the evaluation of the rules that read it, however many there are") {
  for (const unsigned rules : {4U, 8U, 16U, 32U}) {
    const Spread spread{.rules = rules, .behaviors = 4, .channels = rules};
    Rig rig;
    REQUIRE(rig.activate(test::compile(spread.rsl(), spread.json())).ok());
    for (unsigned c = 0; c < spread.channels; ++c)
      REQUIRE(rig.feed(static_cast<std::uint8_t>(c), 0) == link::FeedError::none);
    rig.run(10);
    for (unsigned r = 0; r < rules; ++r) {
      const std::uint32_t before = test::evaluations();
      rig.lines.clear();
      const auto channel = static_cast<std::uint8_t>(spread.channel_of(r));
      REQUIRE(rig.feed(channel, spread.value_of(r)) == link::FeedError::none);
      rig.run(20 + r);
      CHECK(test::evaluations() - before == 1);
      const std::string fire = " fire r" + std::to_string(r) + " DO\n";
      CHECK(rig.only("fire").find(fire) != std::string::npos);
    }
  }
}

TEST_CASE("a rule that waits for its time costs the others nothing") {
  Rig rig;
  REQUIRE(rig.activate(test::compile("WHEN near X > 10 FOR 100ms DO\nLOG \"long\"\nEND\n"
                                     "WHEN far Y > 10 DO\nLOG \"y\"\nEND\n",
                                     test::kPlainRobot))
              .ok());
  rig.run(1);
  REQUIRE(rig.feed(0, 20) == link::FeedError::none);
  rig.run(10);
  const std::uint32_t before = test::evaluations();
  for (int i = 0; i < 10; ++i) {
    REQUIRE(rig.feed(1, 9 + i % 2) == link::FeedError::none);  // 10 is the constant
    rig.run(11 + static_cast<std::uint64_t>(i));
  }
  CHECK(test::evaluations() - before == 10);
  rig.run(200);
  CHECK(test::evaluations() - before == 11);  // when its time has come
  CHECK(rig.only("fire") == "101 #12 fire r0 DO\n");
}
