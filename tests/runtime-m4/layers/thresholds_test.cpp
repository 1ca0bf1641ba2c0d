// Readings that make no difference to rules are latched and traced, and no rule is evaluated for them.
#include "runtime-m4/layers/thresholds.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "runtime-m4/sim/arena.hpp"
#include "tests/runtime-m4/layers/draw.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Draw;
using test::Rig;

namespace {

constexpr const char* kRobot = R"({
  "sensors": [
    {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
    {"name": "far", "type": "VIRTUAL", "channels": {"Y": {"range": [0, 100]}}}
  ],
  "actuators": [{"name": "a", "type": "VIRTUAL"}, {"name": "b", "type": "VIRTUAL"}]
})";
constexpr unsigned kNear = 0;  // the channel near X; far Y is the other
constexpr vm::Value kUnit = vm::kScale;

// The thresholds of a program.
class Told {
public:
  explicit Told(const std::string& rsl) : bytes_(test::compile(rsl, kRobot)) {
    REQUIRE(vm::view_image(bytes_, image_));
    memory_.lay_out(policy::needs_of(image_, memory_.board()));
    thresholds_.start(image_, memory_);
  }
  bool separate(vm::Value from, vm::Value to, unsigned channel = kNear) const {
    return thresholds_.separate(channel, from, to);
  }
  // Are two readings told apart that no constant of the tests' rules separates?
  bool tells_all_apart(unsigned channel = kNear) const {
    return separate(70 * kUnit, 71 * kUnit, channel);
  }

private:
  std::vector<std::byte> bytes_;
  vm::Image image_;
  sim::Arena arena_;
  layers::Memory memory_{arena_.bytes(), arena_.board()};
  layers::Thresholds thresholds_;
};

std::string when(const std::string& condition, const std::string& body = "LOG \"it\"") {
  return "WHEN " + condition + "\nDO\n" + body + "\nEND\n";
}

}  // namespace

TEST_CASE("a reading makes a difference if it reaches, leaves or passes the constant") {
  for (const char* const relation : {"<", "<=", ">", ">=", "=", "<>"}) {
    INFO(relation);
    const Told program(when(std::string("near X ") + relation + " 50"));
    constexpr vm::Value kAt = 50 * kUnit;
    for (const vm::Value from : {kAt - 1, kAt, kAt + 1})
      for (const vm::Value to : {kAt - 1, kAt, kAt + 1})
        if (from != to) CHECK(program.separate(from, to));
    CHECK(program.separate(0, 100 * kUnit));
    CHECK_FALSE(program.separate(0, kAt - 1));
    CHECK_FALSE(program.separate(kAt - 1, 0));
    CHECK_FALSE(program.separate(kAt + 1, 100 * kUnit));
    CHECK_FALSE(program.separate(100 * kUnit, kAt + 1));
  }
}

TEST_CASE("unknown makes a difference to every number") {
  const Told program(when("near X > 50"));
  CHECK(program.separate(vm::kUnknown, 0));
  CHECK(program.separate(0, vm::kUnknown));
  CHECK(program.separate(vm::kUnknown, 100 * kUnit));
}

TEST_CASE("the constants of all behaviours count, and those of SAFETY do not") {
  const Told program("SAFETY s\n" + when("near X > 90", "STOP a") + "BEHAVIOR one PRIORITY 2\n" +
                     when("near X > 50") + when("near X < 20") + "END\nBEHAVIOR two PRIORITY 1\n" +
                     when("near X > 30 AND far Y > 30 OR near X = 50") + "END\n");
  for (const vm::Value constant : {20, 30, 50}) {
    INFO(constant);
    CHECK(program.separate(constant * kUnit - 1, constant * kUnit + 1));
    CHECK_FALSE(program.separate(constant * kUnit + 1, (constant + 10) * kUnit - 1));
  }
  CHECK_FALSE(program.separate(89 * kUnit, 91 * kUnit));
  CHECK(program.separate(29 * kUnit, 31 * kUnit, 1));
  CHECK_FALSE(program.separate(49 * kUnit, 51 * kUnit, 1));
}

TEST_CASE("of many constants, each counts") {
  std::string rsl;
  for (int constant = 1; constant < 60; ++constant)
    rsl += when("near X > " + std::to_string(constant * 37 % 61));
  const Told program(rsl);
  for (vm::Value constant = 1; constant < 61; ++constant) {
    INFO(constant);
    const bool there = constant != 60 * 37 % 61;
    CHECK(program.separate(constant * kUnit - 1, constant * kUnit + 1) == there);
    CHECK_FALSE(program.separate(constant * kUnit + 1, constant * kUnit + 999));
  }
}

TEST_CASE("a channel with another use is told apart always") {
  for (const char* const condition :
       {"near X * near X > 50", "near X > far Y", "near X CHANGES", "near X CHANGES BY 5",
        "MAX(near X, 3) > 50", "near X > 50 AND RANDOM(0, 1) > 0.5",
        "near X > 50 AND 3 / far Y > 1", "near X > 50 2 TIMES WITHIN 1s",
        "near X > 50 THEN near X < 10 WITHIN 1s"}) {
    INFO(condition);
    CHECK(Told(when(condition)).tells_all_apart());
  }
  CHECK(Told(when("near X > 50", "WAIT UNTIL near X < 5")).tells_all_apart());
  CHECK(Told(when("near X > 50", "WAIT UNTIL far Y < 5")).tells_all_apart());
  CHECK(Told("EVERY (near X * 1s)\nDO\nLOG \"x\"\nEND\n").tells_all_apart());
  CHECK(Told(when("far Y > 50 AND RANDOM(0, 1) > 0.5", "LOG near X")).tells_all_apart());
  CHECK(Told("WHILE near X > 50\nDO FOLLOW a TO (near X * 1%)\nEND\n").tells_all_apart());
  // … in one rule of several, wherever it stands.
  CHECK(Told(when("near X > 50") + when("near X * far Y > 50")).tells_all_apart());
  CHECK(Told(when("near X * far Y > 50") + when("near X > 50")).tells_all_apart());
}

TEST_CASE(
    "what only looks at comparisons, or at the channel when it runs, tells nothing else apart") {
  for (const char* const condition :
       {"near X > 50", "NOT (near X > 50)", "near X > 50 AND far Y > 3",
        "near X IS BETWEEN 20 AND 50", "near X > 50 FOR 1s", "near X > 50 MARGIN 5",
        "near X > 50 COOLDOWN 1s", "near X > 50 AND far Y * far Y > 3"}) {
    INFO(condition);
    CHECK_FALSE(Told(when(condition)).tells_all_apart());
  }
  CHECK_FALSE(Told(when("far Y > 50", "LOG near X, near X * 2")).tells_all_apart());
  CHECK_FALSE(Told(when("far Y > 50", "IF near X > 71\nDO LOG \"x\"\nEND")).tells_all_apart());
  CHECK_FALSE(Told(when("near X > 50", "WAIT 1s\nLOG RANDOM(1, 6)")).tells_all_apart());
  CHECK_FALSE(Told("WHILE near X > 50\nDO MOVE a\nEND\n").tells_all_apart());
  CHECK_FALSE(Told("EVERY 1s\nDO LOG near X\nEND\n").tells_all_apart());
  CHECK_FALSE(Told("AT START\nDO LOG near X\nEND\n").tells_all_apart());
  // The other channel's use does not count.
  CHECK(Told(when("near X > 50") + when("far Y * far Y > 2")).tells_all_apart(1));
  CHECK_FALSE(Told(when("near X > 50") + when("far Y * far Y > 2")).tells_all_apart());
}

namespace {

// A running program, and how many conditions it evaluates.
struct CountingRig {
  explicit CountingRig(const std::string& rsl) {
    REQUIRE(rig.activate(test::compile(rsl, kRobot)).ok());
    after_ms(1);
  }
  std::uint32_t after_ms(unsigned ms) {
    now += ms;
    rig.run(now);
    return test::evaluations() - std::exchange(seen, test::evaluations());
  }
  // … in the millisecond after a reading.
  std::uint32_t after(int value, unsigned channel = kNear) {
    REQUIRE(rig.feed(static_cast<std::uint8_t>(channel), value) == link::FeedError::none);
    return after_ms(1);
  }
  Rig rig;
  std::uint32_t seen = 0;
  std::uint64_t now = 0;
};

}  // namespace

TEST_CASE(
    "a reading on the same side of the constant is latched and traced, and nothing is evaluated") {
  CountingRig counted(when("near X > 50", "LOG near X"));
  CHECK(counted.after(10) == 1);  // the first: it was unknown
  counted.rig.lines.clear();
  CHECK(counted.after(20) == 0);
  CHECK(counted.after(49) == 0);
  CHECK(RuntimePeer::value(counted.rig.runtime, kNear) == 49 * kUnit);
  CHECK(counted.after(60) == 1);
  CHECK(counted.after(90) == 0);
  CHECK(counted.after(50) == 1);
  CHECK(counted.after(50) == 0);  // it is not published
  CHECK(counted.after(51) == 1);
  CHECK(counted.rig.only("input fire log") ==
        "2 #2 input X 20\n"
        "3 #3 input X 49\n"
        "4 #4 input X 60\n"
        "4 #4 fire r0 DO\n"
        "4 #4 log \"{}\" 60\n"
        "5 #5 input X 90\n"
        "6 #6 input X 50\n"
        "8 #7 input X 51\n"
        "8 #7 fire r0 DO\n"
        "8 #7 log \"{}\" 51\n");
}

TEST_CASE("a channel that grows stale, and its next reading, make a difference") {
  const std::string robot = R"({"sensors": [{"name": "near", "type": "VIRTUAL",
    "channels": {"X": {"range": [0, 100], "stale_after": "50ms"}}}]})";
  Rig rig;
  REQUIRE(rig.activate(
                 test::compile("WHEN near X > 50\nDO LOG \"high\"\nELSE LOG \"low\"\nEND\n", robot))
              .ok());
  auto evaluated_by = [&, seen = test::evaluations()](std::uint64_t ms) mutable {
    rig.run(ms);
    return test::evaluations() - std::exchange(seen, test::evaluations());
  };
  evaluated_by(1);
  REQUIRE(rig.feed(0, 10) == link::FeedError::none);
  CHECK(evaluated_by(10) == 1);
  REQUIRE(rig.feed(0, 20) == link::FeedError::none);
  CHECK(evaluated_by(20) == 0);
  CHECK(evaluated_by(100) == 1);  // stale
  REQUIRE(rig.feed(0, 20) == link::FeedError::none);
  CHECK(evaluated_by(110) == 1);
  CHECK(rig.only("stale fire") == "1 #1 fire r0 ELSE\n61 #3 stale X\n");
}

TEST_CASE("while a rule has an event, every reading of its behaviour makes a difference") {
  CountingRig counted("BEHAVIOR one PRIORITY 2\n" + when("near X > 50") + when("3 / far Y > 1") +
                      "END\nBEHAVIOR two PRIORITY 1\n" + when("near X > 60") + "END\n");
  counted.after(10);
  counted.after(2, 1);
  CHECK(counted.after(11) == 0);
  counted.rig.lines.clear();
  // It divides by zero, which is reported in each step that changes an input of the behaviour.
  counted.after(0, 1);
  CHECK(counted.after(12) == 3);
  CHECK(counted.after(13) == 3);
  counted.after(2, 1);
  CHECK(counted.after(14) == 0);
  CHECK(counted.rig.only("zero_divide") ==
        "4 #4 zero_divide r1\n5 #5 zero_divide r1\n6 #6 zero_divide r1\n");
}

TEST_CASE("a response that polls looks again at each reading of its behaviour") {
  CountingRig counted(when("near X > 50", "WAIT UNTIL 3 / far Y > 1 WITHIN 10s"));
  counted.after(0, 1);
  counted.after(60);
  counted.rig.lines.clear();
  counted.after(61);
  counted.after(62);
  CHECK(counted.rig.only("zero_divide") == "3 #4 zero_divide r0\n4 #5 zero_divide r0\n");
}

TEST_CASE("what is due goes on in the step of a reading that makes no difference") {
  const auto trace_of = [](const std::string& rsl) {
    test::Robot robot(rsl, kRobot);
    robot.feed(100, "X", 60);
    robot.feed(200, "X", 61);
    robot.run(300);
    return robot.only("fire go_on");
  };
  CHECK(trace_of(when("near X > 50", "WAIT 100ms\nLOG \"on\"")) ==
        "100 #1 fire r0 DO\n200 #2 go_on r0\n");
  CHECK(trace_of(when("near X > 50 FOR 100ms")) == "200 #2 fire r0 DO\n");
}

// --- no program can tell ---

namespace {

const char* const kConstants[] = {"20", "40", "50", "50.001", "60"};

std::string drawn_comparison(Draw& draw) {
  const std::string channel = draw.one_in(2) ? "near X" : "far Y";
  if (draw.one_in(8)) return channel + " IS BETWEEN 20 AND " + draw.of({"40", "50"});
  return channel + draw.of({" < ", " <= ", " > ", " >= ", " = ", " <> "}) + draw.of(kConstants);
}

std::string drawn_condition(Draw& draw) {
  std::string condition = "(" + drawn_comparison(draw) + ")";
  if (draw.one_in(4)) condition = "NOT " + condition;
  if (draw.one_in(2))
    condition = "(" + condition + draw.of({" AND (", " OR ("}) + drawn_comparison(draw) + "))";
  if (draw.one_in(5)) condition += draw.of({" FOR 7ms", " FOR 0ms", " 2 TIMES WITHIN 30ms"});
  if (draw.one_in(30))
    condition = "(" + condition + ")" +
                draw.of({" OR far Y CHANGES BY 3", " AND RANDOM(0, 1) > 0.5", " AND near X < far Y",
                         " OR near X + 5 > 55", " OR 3 / far Y > 1"});
  return condition;
}

std::string drawn_body(Draw& draw) {
  if (draw.one_in(20))
    return draw.of({"WAIT UNTIL near X > 55 WITHIN 20ms\nLOG \"waited\"",
                    "WAIT UNTIL far Y > 50 FOR 3ms WITHIN 20ms", "WAIT 5ms\nLOG near X"});
  return draw.of({"LOG near X", "LOG \"it\"", "MOVE a OVER 9ms", "MOVE b OVER 4ms",
                  "MOVE a TO 50% OVER 3ms\nMOVE b OVER 8ms", "IF far Y > 50\nDO LOG \"far\"\nEND",
                  "MOVE a OVER 2ms\nWAIT 3ms\nMOVE b OVER 3ms"});
}

std::string drawn_rule(Draw& draw) {
  const std::string body = "\nDO\n" + drawn_body(draw) + "\n";
  if (draw.one_in(8)) return "EVERY " + draw.of({"7ms", "11ms TO 13ms"}) + body + "END\n";
  const std::string condition = drawn_condition(draw);
  if (draw.one_in(4)) return "WHILE " + condition + body + "END\n";
  const std::string margin = draw.one_in(5) ? "\nMARGIN 3" : "";
  const std::string modifier =
      draw.one_in(4) ? draw.of({"\nCOOLDOWN 6ms", "\nWAITING 9ms", "\nRESTARTING"}) : "";
  if (draw.one_in(4))
    return "WHEN " + condition + margin + body + "ELSE\n" + drawn_body(draw) + "\nEND\n";
  return "WHEN " + condition + margin + modifier + body + "END\n";
}

std::string drawn_program(Draw& draw) {
  std::string rsl;
  for (unsigned b = 0; b < 3; ++b) {
    rsl += "BEHAVIOR b" + std::to_string(b) + " PRIORITY " + std::to_string(9 - b) + "\n";
    for (unsigned rules = 1 + draw.below(3); rules > 0; --rules)
      rsl += drawn_rule(draw);
    rsl += "END\n";
  }
  return rsl;
}

// Feeds like the link's thread: below the whole program, which has acted when the call returns.
struct Feeder {
  explicit Feeder(Rig& feeds) : rig(feeds) {
    kernel::ThreadSpec spec;
    spec.entry = [](void* self) { static_cast<Feeder*>(self)->run(); };
    spec.argument = this;
    REQUIRE(rig.kernel.add(thread, spec));
  }
  void run() {
    while (rig.kernel.wait(1) != 0) {
      error = rig.runtime.feed(next).error;
      seen = RuntimePeer::value(rig.runtime, static_cast<std::uint8_t>(next.channel));
    }
  }
  void feed(const link::Feed& reading) {
    next = reading;
    rig.kernel.signal(thread, 1);
  }

  Rig& rig;
  kernel::Thread thread;
  link::Feed next{};
  link::FeedError error = link::FeedError::none;
  vm::Value seen = vm::kUnknown;  // of the channel, in the last step
};

enum class Way : std::uint8_t { saving, saving_fed_by_thread, saving_nothing };

struct Compared {
  std::vector<std::string> lines;
  std::uint32_t evaluations = 0;
};

Compared run(const std::vector<std::byte>& bytes, unsigned seed, Way way) {
  const auto rig = std::make_unique<Rig>();
  const std::uint32_t before = test::evaluations();
  if (way == Way::saving_nothing) RuntimePeer::save_no_work(rig->runtime);
  REQUIRE(rig->activate(bytes).ok());
  Feeder feeder(*rig);
  Draw draw(seed);
  std::uint64_t now = 0;
  for (unsigned i = 0; i < 80; ++i) {
    rig->run(now);
    static constexpr vm::Value kNearThose[] = {20'000, 40'000, 50'000, 50'001, 60'000, 70'000};
    const vm::Value value = kNearThose[draw.below(6)] + static_cast<vm::Value>(draw.below(5)) - 2;
    const auto channel = static_cast<std::uint8_t>(draw.below(2));
    // Most readings are on the same side of all constants.
    const vm::Value reading =
        draw.one_in(3) ? value : 70'000 + static_cast<vm::Value>(draw.below(9000));
    if (channel >= rig->runtime.image().channels.size()) continue;
    if (way == Way::saving_fed_by_thread) {
      feeder.feed({.channel = channel, .at_us = 0, .value = reading});
    } else {
      REQUIRE(rig->feed_raw(channel, reading) == link::FeedError::none);
    }
    now += draw.one_in(20) ? 40 : draw.below(4);
  }
  rig->run(now + 100);
  return {rig->lines, test::evaluations() - before};
}

}  // namespace

TEST_CASE("no program can tell that rules are not evaluated for readings that make no difference") {
  Draw draw(3);
  std::uint64_t saving = 0;
  std::uint64_t without = 0;
  unsigned programs = 0;
  for (unsigned round = 0; round < 360; ++round) {
    const std::string rsl = drawn_program(draw);
    const compiler::Result result = compiler::compile({"drawn.rsl", rsl}, {"robot.json", kRobot});
    if (result.image.empty()) continue;
    const Compared some = run(result.image, round, Way::saving);
    const Compared all = run(result.image, round, Way::saving_nothing);
    const Compared fed = run(result.image, round, Way::saving_fed_by_thread);
    INFO(rsl);
    REQUIRE(some.lines == all.lines);
    REQUIRE(some.lines == fed.lines);
    saving += some.evaluations;
    without += all.evaluations;
    ++programs;
  }
  CHECK(programs > 150);
  CHECK(saving * 4 < without * 3);
}

TEST_CASE("a thread that feeds a reading for now finds it in the step when the call returns") {
  Rig rig;
  REQUIRE(rig.activate(test::compile(when("near X > 50") + when("far Y > 50"), kRobot)).ok());
  Feeder feeder(rig);
  const auto seen_after = [&](const link::Feed& reading) {
    feeder.feed(reading);
    rig.run(rig.kernel.now() / 1000 + 1);
    return feeder.seen;
  };
  CHECK(seen_after({.channel = kNear, .at_us = 0, .value = 60'000}) == 60'000);
  CHECK(seen_after({.channel = kNear, .at_us = 0, .value = 200'000}) == 100'000);  // its range
  CHECK(seen_after({.channel = kNear, .at_us = 0, .value = vm::kUnknown}) == 100'000);
  CHECK(seen_after({.channel = 1, .at_us = 900'000, .value = 70'000}) == vm::kUnknown);
  // Another one waits in the queue, for later.
  CHECK(seen_after({.channel = kNear, .at_us = 0, .value = 40'000}) == 40'000);
  rig.run(901);
  CHECK(RuntimePeer::value(rig.runtime, 1) == 70'000);
  CHECK(feeder.error == link::FeedError::none);
  seen_after({.channel = 2, .at_us = 0, .value = 1});
  CHECK(feeder.error == link::FeedError::no_channel);
  CHECK(rig.only("fire") == "0 #1 fire r0 DO\n900 #4 fire r1 DO\n");
}
