// Random programs: what is accepted can be verified, and does what the program says.
#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/compiler/codegen/generator.hpp"
#include "tests/compiler/codegen/model.hpp"
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
  for (const ProgramVariable& variable : Generator::variables())
    world.variables.push_back(variable.initial);
  return world;
}

}  // namespace

TEST_CASE("a random program is refused as too large, or can be verified") {
  const bool optimize = GENERATE(false, true);
  const auto programs = robosync::test::share_of<std::uint32_t>(4000);
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
    INFO(vm::describe(verdict.refusal) << " " << verdict.index << "\n" << listing(built.image));
    REQUIRE(verdict.ok());
    ++accepted;
  }
  CHECK(accepted > programs / 2);
  CHECK(accepted < programs);
}

TEST_CASE("a random response does what its program says, whatever happens while it waits") {
  const bool optimize = GENERATE(false, true);
  const auto responses = robosync::test::share_of<std::uint32_t>(6000);
  constexpr unsigned kPauses = 20;
  constexpr Taste kTaste{.chance = false, .time_words = false, .depth = 4};
  std::size_t done = 0;
  for (std::uint32_t seed = 0; seed < responses; ++seed) {
    const ProgramBlock block = Generator(seed, kTaste).response();
    const Built built = build(program_of({at_start(block)}, Generator::variables()),
                              {.source_lines = false, .optimize = optimize});
    if (built.bytes.empty()) continue;
    INFO("seed " << seed << ", optimised " << optimize << "\n" << listing(built.image));
    const auto weather = [seed](World& world) { some_readings(seed ^ world.now, world); };
    World world = some_world(seed), expected_world = world;
    const Deeds expected =
        expected_deeds(block, Generator::variables(), expected_world, kPauses, weather);
    REQUIRE(Runner(built.image, 0).respond(0, world, kPauses, weather) == expected);
    REQUIRE(world.variables == expected_world.variables);
    REQUIRE(world.now == expected_world.now);
    done += expected.size();
  }
  CHECK(done > responses);
}

// Of a rule that only asks whether its condition is true, unknown is as good as false.
TEST_CASE("conditions are the same, optimised or not, in every step") {
  const auto programs = robosync::test::share_of<std::uint32_t>(1500);
  constexpr std::uint32_t kSteps = 12;
  std::size_t truths = 0;
  for (std::uint32_t seed = 0; seed < programs; ++seed) {
    const Program program = Generator(seed, {.chance = false, .time_words = true}).program();
    const Built plain = build(program, {.source_lines = false});
    const Built optimized = build(program, {.source_lines = false, .optimize = true});
    if (plain.bytes.empty()) continue;
    REQUIRE(!optimized.bytes.empty());
    for (std::size_t b = 0; b < plain.image.behaviors.size(); ++b) {
      Runner one(plain.image, b), other(optimized.image, b);
      World world = some_world(seed);
      for (std::uint32_t step = 0; step < kSteps; ++step) {
        world.now += step * 200;
        some_readings(seed ^ world.now, world);
        for (std::size_t r = 0; r < plain.image.behaviors[b].rule_count; ++r) {
          const vm::Rule& rule = plain.image.rules[plain.image.behaviors[b].first_rule + r];
          if (rule.kind == vm::RuleKind::watch) break;
          if (rule.kind == vm::RuleKind::start) continue;
          const bool only_true =
              rule.kind == vm::RuleKind::when || rule.kind == vm::RuleKind::while_;
          const vm::Value before = one.condition(r, world), after = other.condition(r, world);
          INFO("seed " << seed << " rule " << r << " step " << step << " " << before << " " << after
                       << "\n"
                       << listing(optimized.image));
          REQUIRE((only_true ? (before == vm::kTrue) == (after == vm::kTrue) : before == after));
          if (before == vm::kTrue) ++truths;
        }
      }
    }
  }
  CHECK(truths > programs);
}
