// One slip of the hand shall give one message. Good programs, and the robot.json of good robots, get one word changed,
// thousands of times; none may crash, and of those that are wrong then, most must give exactly one error.
#include <functional>
#include <map>

#include <catch2/catch.hpp>

#include "compiler/diagnostics/render.hpp"
#include "tests/compiler/parsed.hpp"
#include "tests/compiler/syntax/examples.hpp"
#include "tests/compiler/syntax/mutations.hpp"
#include "tests/support/share.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

struct Tally {
  std::size_t programs = 0, wrong = 0, exactly_one = 0;
  double share() const {
    return wrong == 0 ? 0.0 : static_cast<double>(exactly_one) / static_cast<double>(wrong);
  }
};

void count(Tally& tally, std::size_t errors) {
  ++tally.programs;
  if (errors > 0) ++tally.wrong;
  if (errors == 1) ++tally.exactly_one;
}

const bool kShow = std::getenv("ROBOSYNC_SHOW_CASCADES") != nullptr;
constexpr double kBar = 0.95;

class Tallies {
public:
  void add(Mutation mutation, std::size_t errors) {
    count(of_[name_of(mutation)], errors);
    count(all_, errors);
  }

  void check(std::size_t least_wrong) const {
    for (const auto& [name, tally] : of_) {
      WARN(name << ": " << tally.exactly_one << " of " << tally.wrong << " wrong programs ("
                << tally.share() * 100 << " %) give exactly one error");
    }
    WARN("all: " << all_.programs << " programs, " << all_.wrong << " wrong, " << all_.exactly_one
                 << " with exactly one error (" << all_.share() * 100 << " %)");
    CHECK(all_.wrong >= robosync::test::share_of(least_wrong));
    if (robosync::test::whole()) CHECK(all_.share() >= kBar);
  }

private:
  std::map<std::string, Tally> of_;
  Tally all_;
};

}  // namespace

TEST_CASE("one changed word gives one message of the parser", "[mutation]") {
  const int rounds = robosync::test::share_of(90);  // of each mutation, for each program
  std::mt19937 random(20230601);
  Tallies tallies;
  for (const auto& path : files_in("programs", ".rsl")) {
    const std::string program = robosync::testing::read_file(path);
    for (const Mutation mutation : every_mutation) {
      for (int round = 0; round < rounds; ++round) {
        const Parsed parsed = parse_text(mutate(program, mutation, random));
        tallies.add(mutation, parsed.diagnostics.errors());
        if (parsed.diagnostics.errors() > 1 && kShow)
          WARN(path.filename() << ", " << name_of(mutation) << ":\n" << messages(parsed));
      }
    }
  }
  tallies.check(1000);
}

namespace {

using Compile = std::function<Result(const Example&, Mutation, std::mt19937&)>;

// How often does the whole compiler say exactly one thing?
void measure(const Compile& changed) {
  const int rounds = robosync::test::share_of(20);  // of each mutation, for each example
  std::mt19937 random(20230601);
  Tallies tallies;
  for (const Example& example : examples()) {
    for (const Mutation mutation : every_mutation) {
      for (int round = 0; round < rounds; ++round) {
        const Result result = changed(example, mutation, random);
        tallies.add(mutation, result.diagnostics.errors());
        if (result.diagnostics.errors() > 1 && kShow)
          WARN(example.name << ", " << name_of(mutation) << ":\n"
                            << render_human(result.diagnostics, result.sources, false));
      }
    }
  }
  tallies.check(1000);
}

}  // namespace

TEST_CASE("one changed word of an example gives one error", "[mutation]") {
  measure([](const Example& example, Mutation mutation, std::mt19937& random) {
    return compiled(mutate(example.program, mutation, random), example.robot);
  });
}

TEST_CASE("one changed word of an example's robot.json gives one error", "[mutation]") {
  measure([](const Example& example, Mutation mutation, std::mt19937& random) {
    return compiled(example.program, mutate_json(example.robot, mutation, random));
  });
}
