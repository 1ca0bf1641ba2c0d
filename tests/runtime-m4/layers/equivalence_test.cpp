// No program can tell whether a step evaluates all rules of the behaviours it stirs or only those
// it concerns: drawn programs with drawn readings, run both ways.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/layers/draw.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Draw;
using test::Rig;

namespace {

const char* const kDeclarations = R"(
REMEMBER n = 0
STATE mood: calm, mad, glad
FEELING joy FROM 0% TO 100% START 80% FADES TO 10% OVER 1s
CHECK space OF near X
  close BELOW 30
  middle BELOW 60
  wide OTHERWISE
  MARGIN 5
END
CHECK loudness OF far Y
  quiet BELOW 40%
  loud OTHERWISE
  SMOOTH OVER 30ms
END
)";

class Generator {
public:
  explicit Generator(unsigned seed) : draw_(seed) {}

  std::string program() {
    std::string text = kDeclarations;
    const unsigned behaviors = 2 + draw_.below(3);
    for (unsigned b = 0; b < behaviors; ++b) {
      text += "BEHAVIOR b" + std::to_string(b) + " PRIORITY " + std::to_string(50 - b) + "\n";
      for (unsigned r = 0, rules = 2 + draw_.below(4); r < rules; ++r)
        text += rule();
      text += "END\n";
    }
    // Both channels, and the signal, are there in any case.
    return text + "WHEN near X > 95 OR far Y > 95% DO\nSIGNAL knock\nEND\n";
  }

private:
  std::string rule() {
    switch (draw_.below(8)) {
      case 0:
        return "WHILE " + condition() + " DO\n" + body() + "WAIT " + time() + "\nEND\n";
      case 1:
        return "EVERY " + draw_.of({"30ms", "70ms", "70ms TO 200ms"}) + " DO\n" + body() + "END\n";
      case 2:
        return "AT START DO\n" + body() + "END\n";
      case 3:
        return "WHILE " + timed() + " DO\n" + body() + "WAIT " + time() + "\nEND\n";
      default:
        return "WHEN " + timed() + modifiers() + " DO\n" + body() +
               (draw_.one_in(3) ? "ELSE\n" + body() : "") + "END\n";
    }
  }
  std::string modifiers() {
    std::string text = draw_.one_in(4) ? " COOLDOWN " + time() : "";
    if (draw_.one_in(4)) text += " WAITING " + time();
    if (draw_.one_in(5)) text += " RESTARTING";
    return text;
  }
  std::string time() { return draw_.of({"1ms", "2ms", "5ms", "20ms", "100ms"}); }

  std::string timed() {
    const std::string c = condition();
    switch (draw_.below(9)) {
      case 0:
        return "(" + c + ") FOR " + time();
      case 1:
        return "(" + c + ") " + std::to_string(1 + draw_.below(3)) + " TIMES WITHIN " + time();
      case 2:
        return "(" + c + ") THEN (" + condition() + ") WITHIN " + time();
      case 3:
        return draw_.of({"space BECOMES close", "mood BECOMES mad", "loudness BECOMES loud"});
      case 4:
        return draw_.of({"n CHANGES", "near X CHANGES BY 20", "knock"});
      case 5:
        return "near X > 50 MARGIN 10";
      default:
        return c;
    }
  }
  std::string condition() {
    const std::string simple = comparison();
    switch (draw_.below(5)) {
      case 0:
        return simple + " AND " + comparison();
      case 1:
        return simple + " OR " + comparison();
      case 2:
        return "NOT (" + simple + ")";
      default:
        return simple;
    }
  }
  std::string comparison() {
    return draw_.of({"near X > 20", "near X < 50", "near X / n > 8", "far Y > 30%", "far Y < 60%",
                     "joy > 40%", "joy < 20%", "mood IS mad", "mood IS NOT calm", "space IS wide",
                     "loudness IS loud", "n MOD 2 = 0", "n > 3"});
  }

  std::string body() {
    std::string text;
    for (unsigned i = 0, count = 1 + draw_.below(3); i < count; ++i)
      text += statement() + "\n";
    return text;
  }
  std::string statement() {
    switch (draw_.below(8)) {
      case 0:
        return "WAIT " + time();
      case 1:
        return "WAIT UNTIL " + comparison() + " WITHIN " + time();
      case 2:
        return "WAIT UNTIL (near X > 20 FOR " + time() + ") WITHIN 100ms";
      case 3:
        return "THEN";
      default:
        return draw_.of({"MOVE a FOR 5ms", "MOVE b FOR 40ms", "MOVE bc FOR 10ms", "MOVE d FOR 0ms",
                         "SET n TO n + 1", "SET n TO RANDOM(0, 5)", "SET mood TO mad",
                         "SET mood TO calm", "SIGNAL knock", "RAISE joy BY 30%", "LOG \"n\", n"});
    }
  }

  Draw draw_;
};

// The trace, and how many conditions were evaluated.
struct Outcome {
  std::vector<std::string> lines;
  std::uint32_t evaluations;
};

Outcome run(const std::vector<std::byte>& bytes, unsigned seed, bool all) {
  const auto rig = std::make_unique<Rig>();
  const std::uint32_t before = test::evaluations();
  rig->concerns_all = all;
  REQUIRE(rig->activate(bytes).ok());
  Draw draw(seed);
  std::uint64_t now = draw.below(3);
  for (unsigned i = 0; i < 60; ++i) {
    rig->run(now);
    const auto channel = static_cast<std::uint8_t>(draw.below(2));
    // Now and then a sensor fails: its channel goes stale later. One tick may have several steps.
    const int value = static_cast<int>(draw.below(101));
    REQUIRE(rig->feed(channel, value) == link::FeedError::none);
    now += draw.one_in(3) ? 0 : draw.one_in(3) ? 1 : draw.below(60);
  }
  rig->run(now + 500);
  return {rig->lines, test::evaluations() - before};
}

const char* const kForgetful = R"({
  "sensors": [
    {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100], "stale_after": "50ms"}}},
    {"name": "far", "type": "VIRTUAL", "channels": {"Y": {"unit": "%", "range": [0, 100]}}}
  ],
  "actuators": [
    {"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"},
    {"name": "b", "type": "VIRTUAL", "device": "virtual_actuator"},
    {"name": "c", "type": "VIRTUAL", "device": "virtual_actuator"},
    {"name": "d", "type": "VIRTUAL", "device": "virtual_actuator"}
  ],
  "groups": {"bc": ["b", "c"]}
})";

}  // namespace

TEST_CASE("no program can tell whether all rules are evaluated or only those concerned") {
  std::uint64_t concerned = 0;
  std::uint64_t all = 0;
  for (unsigned seed = 0; seed < 250; ++seed) {
    const std::string rsl = Generator(seed).program();
    const std::vector<std::byte> bytes = test::compile(rsl, kForgetful);
    const Outcome few = run(bytes, seed, false);
    const Outcome every = run(bytes, seed, true);
    if (few.lines != every.lines) {
      const auto [here, there] =
          std::mismatch(few.lines.begin(), few.lines.end(), every.lines.begin(), every.lines.end());
      INFO("seed " << seed << "\n" << rsl);
      std::string before;
      for (auto line = here - std::min<std::ptrdiff_t>(here - few.lines.begin(), 12); line != here;
           ++line)
        before += *line + "\n";
      INFO("so far:\n" << before);
      INFO("few: " << (here == few.lines.end() ? "the end" : *here));
      INFO("all: " << (there == every.lines.end() ? "the end" : *there));
      FAIL("the traces differ");
    }
    concerned += few.evaluations;
    all += every.evaluations;
  }
  CHECK(concerned > 0);
  CHECK(concerned * 3 < all * 2);  // and it is worth it
}
