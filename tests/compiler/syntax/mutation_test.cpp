// One slip of the hand shall give one message. Good programs get one word changed, thousands of
// times; none may crash, and of those that are wrong then, most must give exactly one error.
#include <map>

#include <catch2/catch.hpp>

#include "tests/compiler/parsed.hpp"
#include "tests/compiler/syntax/mutations.hpp"

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

}  // namespace

TEST_CASE("one changed word gives one message", "[mutation]") {
  constexpr int rounds = 90;  // of each mutation, for each program
  constexpr double bar = 0.95;
  std::mt19937 random(20230601);
  std::map<std::string, Tally> tallies;
  Tally total;
  for (const auto& path : files_in("programs", ".rsl")) {
    const std::string program = robosync::testing::read_file(path);
    for (const Mutation mutation : every_mutation) {
      for (int round = 0; round < rounds; ++round) {
        const std::string changed = mutate(program, mutation, random);
        const Parsed parsed = parse_text(changed);
        const std::size_t errors = parsed.diagnostics.errors();
        count(tallies[name_of(mutation)], errors);
        count(total, errors);
        if (errors > 1 && std::getenv("ROBOSYNC_SHOW_CASCADES") != nullptr) {
          WARN(path.filename() << ", " << name_of(mutation) << ":\n" << messages(parsed));
        }
      }
    }
  }
  for (const auto& [name, tally] : tallies) {
    WARN(name << ": " << tally.exactly_one << " of " << tally.wrong << " wrong programs ("
              << tally.share() * 100 << " %) give exactly one error");
  }
  WARN("all: " << total.programs << " programs, " << total.wrong << " wrong, " << total.exactly_one
               << " with exactly one error (" << total.share() * 100 << " %)");
  CHECK(total.programs >= 3000);
  CHECK(total.wrong >= 1000);
  CHECK(total.share() >= bar);
}
