// Modules of one's own: rsc new --module, rsc module check, and robots whose modules break their word.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/rsc/process.hpp"

using Catch::Contains;
using robosync::test::Folder;
using robosync::test::Outcome;
using robosync::test::rsc;

namespace {

std::string hostile(const std::string& how) {
  return HOSTILE_MODULES "/" + how + ".so";
}

// A robot with that module and one of the firmware's, which both feel the pad; `firm`: its parameter.
std::string robot_with(const Folder& folder, const std::string& path,
                       const std::string& firm = "1") {
  folder.write("robot.json", R"({
    "sensors": [{"name": "pad", "type": "VIRTUAL", "channels": {"FORCE": {"range": [0, 20]}}}],
    "actuators": [{"name": "voice", "type": "VIRTUAL", "device": "speaker"},
                  {"name": "face", "type": "VIRTUAL", "device": "face"}],
    "algorithms": [{"name": "own", "path": ")" +
                                 path + R"(", "input": "pad", "config": {"firm": )" + firm + R"(}},
                   {"name": "skin", "module": "touch_levels", "input": "pad"}]})");
  folder.write("push.json", R"({"duration": "1s", "stimuli": [
    {"at": "0ms", "sensor": "pad", "value": 0}, {"at": "500ms", "sensor": "pad", "value": 9}]})");
  return folder.write("robot.rsl", R"(
WHEN own FIRM IS yes
DO SHOW face happy
END
WHEN skin LEVEL IS firm
DO SAY "skin"
END
TEST "both"
  AT 0s pad FORCE = 0
  AT 100ms pad FORCE = 9
  EXPECT SHOW face happy WITHIN 100ms
  EXPECT SAY "skin" WITHIN 100ms
END
)");
}

Outcome run(const Folder& folder, const std::string& program) {
  return rsc({"run", program, "--scenario", folder.path("push.json")});
}

}  // namespace

TEST_CASE("a module in a file is an algorithm like any other") {
  const Folder folder;
  const std::string program = robot_with(folder, hostile("well"));
  const Outcome ran = run(folder, program);
  CHECK_THAT(ran.err,
             !Contains("module") && !Contains("rsc:"));  // ASan has something to say of fibers
  CHECK(ran.exit == 0);
  CHECK_THAT(ran.out, Contains("face SHOW happy") && Contains("SAY skin"));
  CHECK(run(folder, program).out == ran.out);
  CHECK(rsc({"test", program}).exit == 0);
  const Outcome timed = rsc({"check", "--timing", program});
  CHECK(timed.exit == 0);
  const Outcome dumped = rsc({"dump", program});
  CHECK_THAT(dumped.out, Contains("own: hostile of channel 0 on, every 20 ms"));
}

TEST_CASE("what a module in a file made is replayed without it") {
  const Folder folder;
  const std::string program = robot_with(folder, hostile("well"));
  const Outcome ran = rsc({"run", program, "--scenario", folder.path("push.json"), "--record",
                           folder.path("push.jsonl")});
  REQUIRE(ran.exit == 0);
  const Outcome again = rsc({"replay", folder.path("push.jsonl")});
  CAPTURE(again.out, again.err);
  CHECK(again.exit == 0);
  CHECK(rsc({"replay", folder.path("push.jsonl"), "--program", program}).exit == 0);
}

TEST_CASE(
    "a module that breaks its word is stopped as on the board: the robot goes on, and rsc says "
    "so") {
  for (const std::string how : {"crashes", "hangs", "calls_the_system"}) {
    INFO(how);
    const Folder folder;
    const Outcome ran = run(folder, robot_with(folder, hostile(how)));
    CHECK(ran.exit == 1);
    CHECK_THAT(ran.err, Contains(hostile(how) + ": it "));
    CHECK_THAT(ran.out,
               Contains("algorithm own is stopped by a fault") && !Contains("face SHOW happy"));
    CHECK_THAT(ran.out, Contains("SAY skin"));
  }
  const Folder folder;
  const std::string program = robot_with(folder, hostile("crashes_when_firm"), "2");
  CHECK_THAT(rsc({"check", "--timing", program}).err, Contains("in cost()"));
  CHECK(rsc({"test", robot_with(folder, hostile("crashes"))}).exit == 1);
}

TEST_CASE("what a module leaves is cut off at its range") {
  const Folder folder;
  const Outcome ran = run(folder, robot_with(folder, hostile("out_of_range")));
  CHECK(ran.exit == 0);
}

TEST_CASE(
    "a file that is no module is an error in robot.json, one that is not there a warning, unless "
    "the program needs it") {
  const Folder folder;
  for (const std::string how : {"other_abi", "crashes_while_loaded", "too_large", "two_alike"}) {
    INFO(how);
    const Outcome checked = rsc({"check", robot_with(folder, hostile(how))});
    CHECK(checked.exit == 1);
    CHECK_THAT(checked.err + checked.out,
               Contains("error[E0210]: the module " + hostile(how) + " cannot be used: it"));
  }
  const std::string program = robot_with(folder, "modules/none.so");
  const Outcome needed = rsc({"check", program});
  CHECK(needed.exit == 1);
  CHECK_THAT(needed.err + needed.out, Contains("needs its module, the file "));
  folder.write("robot.rsl", "WHEN skin LEVEL IS firm\nDO SAY \"skin\"\nEND\n");
  const Outcome missing = rsc({"check", program});
  CHECK(missing.exit == 0);
  CHECK_THAT(missing.err + missing.out,
             Contains("warning[W0214]: there is no file " + folder.path("modules/none.so")));
}

TEST_CASE("a module that was not made yet is the one thing that is said, and how to make it") {
  const Folder folder;
  REQUIRE(rsc({"new", folder.path("fresh"), "--module"}).exit == 0);
  const Outcome checked = rsc({"check", folder.path("fresh/robot.rsl"), "--format", "json"});
  const auto said = nlohmann::json::parse(checked.out);
  INFO(checked.out);
  CHECK(said.at("errors") == 1);
  CHECK(said.at("warnings") == 0);
  CHECK_THAT(checked.out, Contains("needs its module, the file ") && Contains("fresh.so") &&
                              Contains("cmake --build build"));
}

TEST_CASE("a module that gives up is named, and what it made is not said to be too old") {
  const Folder folder;
  const Outcome ran = run(folder, robot_with(folder, hostile("gives_up")));
  INFO(ran.out << ran.err);
  CHECK(ran.exit == 1);
  CHECK_THAT(ran.err, Contains(hostile("gives_up") + ": it gave up"));
  const Outcome shown =
      rsc({"run", folder.path("robot.rsl"), "--scenario", folder.path("push.json"), "--all"});
  INFO(shown.out);
  CHECK_THAT(shown.out, !Contains("no reading for too long"));
}

TEST_CASE("rsc module check holds a module against its own declaration") {
  const auto check = [](const std::string& how) { return rsc({"module", "check", hostile(how)}); };
  const Outcome well = check("well");
  CHECK(well.exit == 0);
  CHECK_THAT(well.out, Contains("does what it declares") && Contains("not tested: its cost") &&
                           Contains("it calls itself `hostile`, but its file is `well`"));
  const std::pair<const char*, const char*> wrong[] = {
      {"beyond_state",
       "it touched memory beyond its state, in process() (every 5 ms, with firm 1)"},
      {"crashes_when_firm", "in cost() (every 5 ms, with firm 10)"},
      {"out_of_range", "MORE is 7, outside its range of 0 to 1"},
      {"untrue_mask", "FIRM changed, and process() did not report it"},
      {"reads_its_scratch", "gave other outputs when it was tried again"},
      {"other_abi", "it is made for another version"}};
  for (const auto& [how, what] : wrong) {
    INFO(how);
    const Outcome checked = check(how);
    CHECK(checked.exit == 1);
    CHECK_THAT(checked.out, Contains("FAILED  ") && Contains(what));
  }
  CHECK(rsc({"module", "chekc", hostile("well")}).exit == 2);
  CHECK(rsc({"module", "check", "none.c"}).exit == 3);
}

TEST_CASE(
    "a module in C is compiled so that it stops where C says nothing, and counted on the M4") {
  const Folder folder;
  REQUIRE(rsc({"new", folder.path("greedy"), "--module"}).exit == 0);
  const std::string source = folder.read("greedy/modules/greedy.c");
  const Outcome good = rsc({"module", "check", folder.path("greedy/modules/greedy.c")});
  INFO(good.out << good.err);
  CHECK(good.exit == 0);
  CHECK_THAT(good.out,
             Contains("it costs no more than it states: ") || Contains("not tested: its cost"));
  CHECK_THAT(good.out, !Contains("calls itself"));
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = source;
    REQUIRE(text.find(from) != std::string::npos);
    folder.write("greedy/modules/greedy.c", text.replace(text.find(from), from.size(), to));
    return rsc({"module", "check", folder.path("greedy/modules/greedy.c")});
  };
  const Outcome overflows = changed("(int64_t)level - self->mean", "level - self->mean");
  CHECK(overflows.exit == 1);
  CHECK_THAT(overflows.out,
             Contains("overflowed, or did something else that C does not define, in process()"));
  CHECK_THAT(changed("const int32_t level = block->inputs[0];",
                     "const int32_t level = *(volatile int32_t*)0;")
                 .out,
             Contains("it touched memory that is not its own, in process()"));
  CHECK_THAT(changed("return 80;", "return 8O;").err, Contains("does not compile"));
  if (good.out.find("not tested") != std::string::npos) return;
  const Outcome floats = changed("level / 64 - self->mean / 64", "(int32_t)((float)level / 64)");
  CHECK(floats.exit == 1);
  CHECK_THAT(floats.out, Contains("FAILED  it computes without floating point"));
  const Outcome lies = changed("return 80;", "return 8;");
  CHECK(lies.exit == 1);
  CHECK_THAT(lies.out, Contains("FAILED  it costs no more than it states") &&
                           Contains("and its cost() is 8"));
}

TEST_CASE(
    "rsc new --module makes a robot whose module compiles, works, and is called like its folder") {
  const Folder folder;
  const Outcome made = rsc({"new", folder.path("nods"), "--module"});
  REQUIRE(made.exit == 0);
  CHECK_THAT(made.out, Contains("rsc module check modules/nods.c"));
  const std::string place = folder.path("nods");
  const std::string build =
      "cd " + place + " && cc -shared -fPIC -O2 modules/nods.c -o modules/nods.so";
  REQUIRE(std::system(build.c_str()) == 0);
  CHECK(folder.read("nods/CMakeLists.txt").find("heartbeat") == std::string::npos);
  const Outcome checked = rsc({"check", place + "/robot.rsl", "--format", "json"});
  INFO(checked.out);
  CHECK(checked.exit == 0);
  CHECK(nlohmann::json::parse(checked.out).at("warnings") == 0);
  const Outcome ran = rsc({"run", place + "/robot.rsl", "--scenario", place + "/pulse.json"});
  CHECK(ran.exit == 0);
  CHECK_THAT(ran.out, Contains("face SHOW happy") && Contains("Sit down with me"));
  CHECK(rsc({"test", place + "/robot.rsl"}).exit == 0);
  CHECK(rsc({"new", place, "--module"}).exit == 3);  // it is there
  CHECK(rsc({"new", folder.path("No-name"), "--module"}).exit == 2);
  CHECK(rsc({"new", folder.path("both"), "--module", "--template", "quiz"}).exit == 2);
}
