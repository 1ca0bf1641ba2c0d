// Random programs: what is accepted can be verified, and does what the program says.
#include <algorithm>

#include <catch2/catch.hpp>

#include "compiler/optimize/room.hpp"
#include "tests/compiler/codegen/expected.hpp"
#include "tests/compiler/codegen/generator.hpp"
#include "tests/support/share.hpp"
#include "vm/verifier.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

// Numbers near each other, so that comparisons go both ways; sometimes nothing is known.
vm::Value some_reading(std::mt19937& random) {
  const auto drawn = std::uniform_int_distribution<int>(-6, 14)(random);
  return drawn == 14 ? vm::kUnknown : drawn * 500;
}

// A robot keeps readings in the channel's range: the key is 0 or 1.
void some_readings(std::uint32_t seed, World& world) {
  std::mt19937 random(seed);
  for (vm::Value& channel : world.channels)
    channel = some_reading(random);
  vm::Value& key = world.channels.back();
  if (key != vm::kUnknown) key = std::clamp(key, 0, vm::kScale);
}

World some_world(std::uint32_t seed) {
  World world;
  some_readings(seed, world);
  for (const ir::Variable& variable : Generator::variables())
    world.variables.push_back(variable.initial);
  return world;
}

}  // namespace

TEST_CASE("a random program is refused as too large, or can be verified") {
  const bool optimize = GENERATE(false, true);
  constexpr std::uint32_t kPrograms = 4000;
  const auto programs = robosync::test::share_of<std::uint32_t>(kPrograms);
  unsigned accepted = 0;
  for (std::uint32_t seed = 0; seed < programs; ++seed) {
    INFO("seed " << seed);
    Taste taste;
    taste.depth = 2 + seed % 6;
    const Built built =
        build(Generator(seed, taste).program(), {.source_lines = false, .optimize = optimize});
    for (const Diagnostic& diagnostic : built.diagnostics.all()) {
      INFO(diagnostic.message);
      REQUIRE(diagnostic.code == Code::E0407);
    }
    REQUIRE(built.bytes.empty() == (built.diagnostics.errors() > 0));
    if (built.bytes.empty()) continue;
    vm::Image image;
    const vm::Verdict verdict = vm::verify(built.bytes, vm::Limits{}, image);
    INFO(vm::describe(verdict.refusal) << " " << verdict.index);
    REQUIRE(verdict.ok());
    ++accepted;
  }
  CHECK(accepted > programs / 2);
  if (programs == kPrograms)
    CHECK(accepted < programs);  // a share of them may have none that is too large
}

TEST_CASE("a random response does what its program says, whatever happens while it waits") {
  const bool optimize = GENERATE(false, true);
  const auto responses = robosync::test::share_of<std::uint32_t>(6000);
  constexpr unsigned kPauses = 20;
  constexpr Taste kTaste{.surprise = false, .time_words = false, .depth = 4};
  std::size_t done = 0;
  for (std::uint32_t seed = 0; seed < responses; ++seed) {
    const ir::Block block = Generator(seed, kTaste).response();
    const Built built = build(program_of({at_start(block)}, Generator::variables()),
                              {.source_lines = false, .optimize = optimize});
    if (built.bytes.empty()) continue;
    INFO("seed " << seed << ", optimised " << optimize);
    const auto weather = [seed](World& world) { some_readings(seed ^ world.now, world); };
    World world = some_world(seed), expected_world = world;
    const oracle::Chance chance(seed, 0);
    const Effects expected =
        expected_effects(block, Generator::variables(), expected_world, kPauses, chance, weather);
    Runner runner(built.image, 0);
    runner.machine.random = chance.state();
    REQUIRE(runner.respond(0, world, kPauses, weather) == expected);
    REQUIRE(world.variables == expected_world.variables);
    REQUIRE(world.now == expected_world.now);
    done += expected.size();
  }
  CHECK(done > responses);
}

// The conditions of one behaviour in one program, in step after step.
class Conditions {
public:
  Conditions(const ir::Behavior& behavior, const vm::Image& image, std::size_t number)
      : behavior_(behavior), image_(image), runner_(image, number), number_(number) {}

  // What the reference interpreter says, in the order of the rules; of EVERY, the period.
  std::vector<vm::Value> expected(const World& world) {
    const oracle::Snapshot snapshot = snapshot_of(world);
    const oracle::Sight sight{snapshot};
    std::vector<vm::Value> values;
    ++step_;
    for (const ir::Rule& rule : behavior_.rules) {
      if (rule.kind == vm::RuleKind::start) continue;
      evaluator_.remember(rule.condition, sight, {step_, world.now});
      const bool is_period = rule.kind == vm::RuleKind::every;
      values.push_back(is_period ? oracle::value_of(evaluator_.number(rule.condition, sight))
                                 : oracle::value_of(evaluator_.truth(rule.condition, sight)));
    }
    return values;
  }

  // What the code gives. Of a rule that only asks whether its condition is true, optimised code may
  // say of an unknown that it is false.
  std::vector<vm::Value> actual(const World& world, const std::vector<vm::Value>& expected) {
    std::vector<vm::Value> values;
    const vm::Behavior& behavior = image_.behaviors[number_];
    for (std::size_t r = 0; r < behavior.rule_count; ++r) {
      const vm::Rule& rule = image_.rules[behavior.first_rule + r];
      if (rule.kind == vm::RuleKind::watch) break;
      if (rule.kind == vm::RuleKind::start) continue;
      const vm::Value value = runner_.condition(r, world);
      const bool only_true = rule.kind == vm::RuleKind::when || rule.kind == vm::RuleKind::while_;
      const bool as_good = only_true && value != vm::kTrue && expected[values.size()] != vm::kTrue;
      values.push_back(as_good ? expected[values.size()] : value);
    }
    return values;
  }

private:
  const ir::Behavior& behavior_;
  const vm::Image& image_;
  Runner runner_;
  std::size_t number_;
  oracle::Evaluator evaluator_;
  std::int64_t step_ = 0;
};

TEST_CASE("random conditions are what they say, optimised or not, in every step") {
  const bool optimize = GENERATE(false, true);
  const auto programs = robosync::test::share_of<std::uint32_t>(1500);
  constexpr std::uint32_t kSteps = 12;
  std::size_t truths = 0;
  for (std::uint32_t seed = 0; seed < programs; ++seed) {
    const ir::Program program = Generator(seed, {.chance = false, .time_words = true}).program();
    const Built built = build(program, {.source_lines = false, .optimize = optimize});
    if (built.bytes.empty()) continue;
    const std::size_t safety = program.safety.empty() ? 0 : 1;
    for (std::size_t b = 0; b < program.behaviors.size(); ++b) {
      Conditions conditions(program.behaviors[b], built.image, b + safety);
      World world = some_world(seed);
      for (std::uint32_t step = 0; step < kSteps; ++step) {
        world.now += step * 200;
        some_readings(seed ^ world.now, world);
        const std::vector<vm::Value> expected = conditions.expected(world);
        const std::vector<vm::Value> actual = conditions.actual(world, expected);
        if (actual != expected) {
          INFO("seed " << seed << ", step " << step << "\n" << listing(built.image));
          REQUIRE(actual == expected);
        }
        truths += static_cast<std::size_t>(std::count(expected.begin(), expected.end(), vm::kTrue));
      }
    }
  }
  CHECK(truths > programs);
}

TEST_CASE("what fits as it is written fits optimised, in no more cells than the optimiser counts") {
  const auto programs = robosync::test::share_of<std::uint32_t>(1500);
  for (std::uint32_t seed = 0; seed < programs; ++seed) {
    const ir::Program program = Generator(seed, {.chance = false, .time_words = true}).program();
    const Built plain = build(program, {.source_lines = false});
    if (plain.bytes.empty()) continue;
    const Built optimized = build(program, {.source_lines = false, .optimize = true});
    INFO(seed);
    REQUIRE(!optimized.bytes.empty());
    // A number that is worked out once has to be kept, and one that a variable always is may have to be
    // loaded, which can cost a little where it is not used.
    CHECK(optimized.image.header->step_cost * 0.97 <= plain.image.header->step_cost);
    const Room room = room_in(program);
    const std::size_t safety = program.safety.empty() ? 0 : 1;
    for (std::size_t b = 0; b < program.behaviors.size(); ++b) {
      const std::size_t most = cells_at_most(program.behaviors[b].rules);
      CHECK(plain.image.behaviors[b + safety].cells <= most);
      CHECK(optimized.image.behaviors[b + safety].cells <= most + room.locals[b]);
    }
  }
}
