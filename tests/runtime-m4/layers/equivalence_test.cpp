// No program can tell whether a step evaluates all rules of the affected behaviours or only those
// that it concerns, nor whether the turn of a behaviour with a single concerned rule takes the fast path,
// nor whether anybody listens to the trace: random programs with random readings, run each way.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "tests/runtime-m4/layers/draw.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/support/drawn.hpp"

using namespace robosync;
using test::Draw;
using test::Rig;

namespace {

enum class Way : std::uint8_t { usual, evaluates_all, unheard };

// The trace, what was done to the pins, and the number of conditions that were evaluated.
struct Outcome {
  std::vector<std::string> lines;
  std::vector<std::pair<std::uint16_t, std::uint32_t>> writes;
  std::uint32_t evaluations;
};
constexpr unsigned kFeeds = 60;
constexpr unsigned kUnheard = 50;  // of these, when nobody listens

// A reading of one of the image's channels: anywhere in its range, or at a rule's threshold.
vm::Value reading(const vm::Image& image, std::size_t channel, Draw& draw) {
  const vm::Channel& config = image.channels[channel];
  if (!draw.one_in(3) && !image.constants.empty()) {
    const vm::Value near =
        image.constants[draw.below(static_cast<unsigned>(image.constants.size()))];
    return std::clamp(near, config.min, config.max);
  }
  const auto span = static_cast<unsigned>(config.max - config.min);
  return config.min + static_cast<vm::Value>(draw.below(span + 1));
}

// Nothing if the image is larger than a robot may be.
std::optional<Outcome> run(const std::vector<std::byte>& bytes, unsigned seed, Way way) {
  const auto rig = std::make_unique<Rig>();
  const std::uint32_t before = test::evaluations();
  rig->concerns_all = way == Way::evaluates_all;
  rig->listen(way != Way::unheard);
  if (!rig->activate(bytes).ok()) return std::nullopt;
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  Draw draw(seed);
  std::uint64_t now = draw.below(3);
  for (unsigned i = 0; i < kFeeds; ++i) {
    rig->run(now);
    if (i == kUnheard) rig->listen(true);
    const unsigned channel = draw.below(static_cast<unsigned>(image.channels.size()));
    const vm::Value value = reading(image, channel, draw);
    REQUIRE(rig->feed_raw(static_cast<std::uint8_t>(channel), value) == link::FeedError::none);
    // One tick may have several steps; and now and then sensors fall silent.
    now += draw.one_in(20) ? 310 : draw.one_in(3) ? 0 : draw.one_in(3) ? 1 : draw.below(60);
  }
  rig->run(now + 500);
  return Outcome{rig->lines, rig->board.writes, test::evaluations() - before};
}

// Where the traces diverge, and the lines before that.
std::string parting(const Outcome& few, const Outcome& every) {
  const auto [here, there] =
      std::mismatch(few.lines.begin(), few.lines.end(), every.lines.begin(), every.lines.end());
  std::string text;
  for (auto line = here - std::min<std::ptrdiff_t>(here - few.lines.begin(), 12); line != here;
       ++line)
    text += *line + "\n";
  text += "few: " + (here == few.lines.end() ? "the end" : *here) + "\n";
  return text + "all: " + (there == every.lines.end() ? "the end" : *there);
}

// The drawn robot with servos for arms, whose pins show what is done to them.
std::string robot_with_servos() {
  std::string robot = robosync::testing::drawn_robot();
  const std::string virtual_arm = R"("type": "VIRTUAL", "device": "joint")";
  for (const char* servo : {R"("type": "PWM", "device": "servo", "pin": "10")",
                            R"("type": "PWM", "device": "servo", "pin": "11")"}) {
    const std::size_t at = robot.find(virtual_arm);
    REQUIRE(at != std::string::npos);
    robot.replace(at, virtual_arm.size(), servo);
  }
  return robot;
}

// Calls compare(usual, other, what) for the outcomes of each drawn program both ways; `what` says which program it is.
template <class Compare>
void each_drawn(const std::string& robot, Way other, Compare compare) {
  unsigned seed = 0;
  for (const std::string& rsl : robosync::testing::drawn_programs()) {
    const compiler::Result result = compiler::compile({"drawn.rsl", rsl}, {"robot.json", robot});
    if (result.image.empty()) continue;
    const auto usual = run(result.image, ++seed, Way::usual);
    const auto different = run(result.image, seed, other);
    if (usual && different)
      compare(*usual, *different, "seed " + std::to_string(seed) + "\n" + rsl + "\n");
  }
}

}  // namespace

TEST_CASE("no program can tell whether all rules are evaluated or only those concerned") {
  std::uint64_t concerned = 0;
  std::uint64_t all = 0;
  unsigned compared = 0;
  unsigned tripped = 0;  // by a sensor that was silent, or too warm
  const auto compare = [&](const Outcome& few, const Outcome& every, const std::string& what) {
    if (few.lines != every.lines) {
      INFO(what << parting(few, every));
      FAIL("the traces differ");
    }
    ++compared;
    tripped += std::ranges::count_if(few.lines, [](const std::string& line) {
                 return line.find(" trip ") != std::string::npos;
               }) > 0;
    concerned += few.evaluations;
    all += every.evaluations;
  };
  each_drawn(robosync::testing::drawn_robot(), Way::evaluates_all, compare);
  CHECK(compared > 200);
  CHECK(tripped > 50);
  CHECK(concerned > 0);
  CHECK(concerned * 3 < all * 2);  // the index pays off
}

// Without a listener, commands are sent before other things are done that follow from a reading.
TEST_CASE("no program can tell whether anybody listens to the trace") {
  unsigned moved = 0;
  std::size_t heard = 0;
  const auto compare = [&](const Outcome& usual, const Outcome& unheard, const std::string& what) {
    INFO(what);
    REQUIRE(unheard.writes == usual.writes);
    REQUIRE(unheard.lines.size() <= usual.lines.size());
    REQUIRE(std::equal(unheard.lines.rbegin(), unheard.lines.rend(), usual.lines.rbegin()));
    moved += usual.writes.empty() ? 0 : 1;
    heard += unheard.lines.size();
  };
  each_drawn(robot_with_servos(), Way::unheard, compare);
  CHECK(moved > 100);
  CHECK(heard > 10'000);
}
