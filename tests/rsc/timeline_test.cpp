// rsc run --html: what stands in the page for a run; how a browser shows it is tests/timeline's part.
#include <filesystem>
#include <regex>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/rsc/device.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Folder;
using test::Outcome;

namespace {

constexpr const char* kShownProgram = R"(STATE mood: calm, cross
CHECK feel OF touch LEVEL
  light BELOW 4
  firm OTHERWISE
END
SAFETY guard
  WHEN touch LEVEL > 8
  DO STOP arm
  RESUME WHEN touch LEVEL < 1
END
BEHAVIOR strong PRIORITY 80
  WHEN touch LEVEL > 2 DO
    MOVE arm SLOWLY TO 90deg
    LOG "</script><b>strong</b>"
  END
END
BEHAVIOR weak PRIORITY 20
  WHEN near DISTANCE < 50cm DO
    MOVE arm TO 10deg
    SET mood TO cross
  END
END
)";

constexpr const char* kShownRobot = R"({
  "sensors": [
    {"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}},
    {"name": "near", "type": "VIRTUAL", "channels": {"DISTANCE": {"unit": "cm", "range": [2, 400]}}}],
  "actuators": [{"name": "arm", "type": "PWM", "pin": 10, "device": "servo",
                 "range": ["0deg", "120deg"], "speeds": {"SLOWLY": "90deg/s"}}]})";

constexpr const char* kShownVisit = R"({"duration": "10s", "stimuli": [
  {"at": "0s", "sensor": "near", "value": "100cm"}, {"at": "0s", "sensor": "touch", "value": 0},
  {"at": "1s", "sensor": "touch", "value": 3}, {"at": "1.5s", "sensor": "near", "value": "40cm"},
  {"at": "4s", "sensor": "touch", "value": 9}, {"at": "6s", "sensor": "touch", "value": 0}]})";

// What the page shows.
json run_in(const std::string& page) {
  const std::string begin = R"(<script type="application/json" id="run">)";
  const std::size_t at = page.find(begin) + begin.size();
  return json::parse(page.substr(at, page.find("</script>", at) - at));
}

json run_of_page(const Folder& folder, const std::string& program) {
  REQUIRE(test::rsc({"run", program, "--html", folder.path("run.html")}).exit == 0);
  return run_in(folder.read("run.html"));
}

class Page : public Folder {
public:
  Page() : program(write("robot.rsl", kShownProgram)) {
    write("robot.json", kShownRobot);
    scenario = write("visit.json", kShownVisit);
    const Outcome outcome = run(path("run.html"));
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit == 0);
    text = read("run.html");
    run_of = run_in(text);
  }
  [[nodiscard]] Outcome run(const std::string& html) const {
    return test::rsc({"run", program, "--scenario", scenario, "--html", html});
  }
  [[nodiscard]] const json& signal(const std::string& name) const {
    for (const json& one : run_of.at("signals"))
      if (one.at("name") == name) return one;
    FAIL("no signal " << name);
    return run_of;
  }

  std::string program, scenario, text;
  json run_of;
};

}  // namespace

TEST_CASE("a bar is a command, from when it reaches its actuator until it is done or halted") {
  const Page page;
  const json& arm = page.run_of.at("actuators").at(0);
  REQUIRE(arm.at("bars").size() == 1);
  const json& bar = arm.at("bars").at(0);
  CHECK(bar.at("text") == "MOVE SLOWLY TO 90deg");
  CHECK(bar.at("from") == 1'000'000);
  CHECK(bar.at("to") == 2'000'000);     // 90deg at 90deg/s
  CHECK(bar.at("until") == 4'000'000);  // it stays there, until it is halted
  CHECK(page.run_of.at("behaviors").at(bar.at("behavior").get<std::size_t>()) == "strong");
  CHECK(page.run_of.at("rules").at(bar.at("rule").get<std::size_t>()).at("line") == 12);
  CHECK(arm.at("halts") == json::parse("[[4000000, 6000000]]"));
}

TEST_CASE("a power and a picture last until the next command; with FOR, and at 0, they do not") {
  const Folder folder;
  folder.write("robot.json", R"({"actuators": [
    {"name": "wheel", "type": "PWM", "pin": 10, "device": "pwm"},
    {"name": "face", "type": "VIRTUAL", "device": "face"}]})");
  const std::string program = folder.write("robot.rsl",
                                           "AT START DO\n  RUN wheel TO 50%\n  SHOW face happy\n"
                                           "  WAIT 6s\n  RUN wheel TO 0%\n  WAIT 1s\n"
                                           "  RUN wheel TO 20% FOR 1s\nEND\n");
  const json run = run_of_page(folder, program);
  const json& bars = run.at("actuators").at(0).at("bars");
  REQUIRE(bars.size() == 3);
  CHECK(bars.at(0).at("to") == 0);
  CHECK(bars.at(0).at("until") == 6'000'000);
  CHECK_FALSE(bars.at(1).contains("until"));
  CHECK_FALSE(bars.at(2).contains("until"));
  CHECK(run.at("actuators").at(1).at("bars").at(0).at("until") == run.at("end_us"));
}

TEST_CASE("a command for lights has the picture that they show; a face without hardware has none") {
  const Folder folder;
  folder.write("robot.json", R"({"board": "microbit-v2", "actuators": [
    {"name": "face", "device": "lights"}, {"name": "voice", "device": "beeper"},
    {"name": "display", "type": "VIRTUAL", "device": "face"}],
    "pictures": {"robot": ["#...#", "#####", "#.#.#", "#####", ".#.#."]}})");
  const std::string program = folder.write("robot.rsl",
                                           "AT START DO\n  SHOW face smile\n  PLAY voice hello\n"
                                           "  SHOW display happy\n  WAIT 1s\n  BLINK face\n"
                                           "  WAIT 1s\n  SHOW face cross FOR 1s\n  THEN\n"
                                           "  SHOW face 0\n  WAIT 1s\n  SHOW face robot\nEND\n");
  const json run = run_of_page(folder, program);
  const json& face = run.at("actuators").at(0).at("bars");
  REQUIRE(face.size() == 5);
  CHECK(run.at("pictures").at(face.at(0).at("picture").get<std::size_t>()) ==
        json::parse(R"([".....", ".#.#.", ".....", "#...#", ".###."])"));
  CHECK(face.at(0).at("text") == "SHOW smile");
  CHECK_FALSE(face.at(1).contains("picture"));
  CHECK(run.at("pictures").at(face.at(2).at("picture").get<std::size_t>()) ==
        json::parse(R"(["#...#", ".#.#.", "..#..", ".#.#.", "#...#"])"));
  CHECK(run.at("pictures").at(face.at(3).at("picture").get<std::size_t>()) ==
        json::parse(R"([".###.", ".#.#.", ".#.#.", ".#.#.", ".###."])"));
  CHECK(face.at(3).at("text") == "SHOW TO 0");
  CHECK(face.at(3).contains("until"));  // not a power of 0
  CHECK(run.at("pictures").at(face.at(4).at("picture").get<std::size_t>()) ==
        json::parse(R"(["#...#", "#####", "#.#.#", "#####", ".#.#."])"));
  CHECK_FALSE(run.at("actuators").at(1).at("bars").at(0).contains("picture"));
  CHECK_FALSE(run.at("actuators").at(2).at("bars").at(0).contains("picture"));
}

TEST_CASE("a strip of lights shows colours, not pictures") {
  const Folder folder;
  folder.write("robot.json", R"({"board": "microbit-v2", "actuators": [
    {"name": "eyes", "pin": 0, "device": "ws2812_strip", "lights": 8}]})");
  const std::string program =
      folder.write("robot.rsl", "AT START DO\n  LIGHT eyes red\n  WAIT 1s\nEND\n");
  const json bars = run_of_page(folder, program).at("actuators").at(0).at("bars");
  REQUIRE(bars.size() == 1);
  CHECK(bars.at(0).at("text") == "LIGHT red");
  CHECK_FALSE(bars.at(0).contains("picture"));
}

TEST_CASE("the way of a drive is its bar, which ends with the power of its motors") {
  const Folder folder;
  folder.write("robot.json", R"({"actuators": [
    {"name": "base", "type": "PWM", "device": "differential_drive", "left": [3, 4], "right": [5, 6],
     "speed": "40cm/s", "track": "12cm"}]})");
  const std::string program = folder.write(
      "robot.rsl",
      "AT START DO\n  DRIVE base FORWARD 20cm AT 10cm/s\n  TURN base LEFT 90deg\n  WAIT 1s\nEND\n");
  const json run = run_of_page(folder, program);
  REQUIRE(run.at("actuators").size() == 1);
  const json& base = run.at("actuators").at(0);
  CHECK(base.at("name") == "base");
  const json& bars = base.at("bars");
  REQUIRE(bars.size() == 2);
  CHECK(bars.at(0).at("text") == "DRIVE FORWARD BY 20cm AT 10cm/s");
  CHECK(bars.at(0).at("to") == 2'000'000);
  CHECK_FALSE(bars.at(0).contains("until"));
  CHECK(bars.at(1).at("text") == "TURN LEFT BY 90deg");
  CHECK(bars.at(1).at("from") == 2'000'000);
  CHECK(bars.at(1).at("to") == 2'472'000);  // in the tick after its end
}

TEST_CASE("who was denied is told by whom, and what SAFETY did from when to when") {
  const Page page;
  REQUIRE(page.run_of.at("denied").size() == 1);
  const json& denied = page.run_of.at("denied").at(0);
  CHECK(denied.at("at") == 1'500'000);
  CHECK(page.run_of.at("behaviors").at(denied.at("behavior").get<std::size_t>()) == "weak");
  CHECK_THAT(denied.at("text").get<std::string>(), Contains("strong has an actuator it needs"));
  REQUIRE(page.run_of.at("safety").size() == 1);
  CHECK(page.run_of.at("safety").at(0).at("from") == 4'000'000);
  CHECK(page.run_of.at("safety").at(0).at("to") == 6'000'000);
  const auto rule = page.run_of.at("safety").at(0).at("rule").get<std::size_t>();
  CHECK(page.run_of.at("rules").at(rule).at("name") == "line 6 (guard)");
}

TEST_CASE("a sensor has its points, its unit, and what rules and bands compare it with") {
  const Page page;
  const json& near = page.signal("near DISTANCE");
  CHECK(near.at("points") == json::parse("[[0, 1000000], [1500000, 400000]]"));
  CHECK(near.at("unit").at("name") == "cm");
  std::vector<std::string> found;
  for (const json& one : page.signal("touch LEVEL").at("thresholds"))
    found.push_back(one.at("text").get<std::string>() + " " +
                    std::to_string(one.at("value").get<int>()));
  std::ranges::sort(found);
  CHECK(found == std::vector<std::string>{"< 1000", "> 2000", "> 8000", "firm 4000"});
  CHECK(page.signal("mood").at("points").size() == 1);  // weak was denied
  CHECK(page.signal("feel").at("labels") == json::parse(R"(["light", "firm"])"));
}

TEST_CASE("a step tells in words what happened in it") {
  const Page page;
  const json& bar = page.run_of.at("actuators").at(0).at("bars").at(0);
  json step;
  for (const json& one : page.run_of.at("steps"))
    if (one.at(0) == bar.at("step")) step = one;
  CHECK(step.at(1) == "touch LEVEL = 3");
  CHECK_THAT(step.dump(), Contains("strong, rule at line 12 triggers\"") &&
                              Contains("arm MOVE SLOWLY TO 90deg"));
}

TEST_CASE("the page is whole by itself, and what a program says stays text in it") {
  const Page page;
  CHECK(page.text.size() - page.run_of.dump().size() < 300'000);
  CHECK(page.run_of.at("messages").at(0).at("text") == "log: </script><b>strong</b>");
  CHECK(page.text.find("<b>strong") == std::string::npos);
  for (const char* const outside : {"src=", "href=", "@import", "fetch("})
    CHECK(page.text.find(outside) == std::string::npos);
  CHECK_FALSE(
      std::regex_search(page.text, std::regex(R"(url\((?!#))")));  // "#": in the page itself
}

TEST_CASE("the same run gives the same page; it is not written over the program") {
  const Page page;
  REQUIRE(page.run(page.path("again.html")).exit == 0);
  CHECK(page.read("again.html") == page.text);
  const Outcome over = page.run(page.program);
  CHECK(over.exit == 2);
  CHECK(page.read("robot.rsl") == kShownProgram);
}

TEST_CASE("a monitor of a robot where nothing happens writes no page, and that is no mistake") {
  const test::Device device;
  const Outcome outcome =
      device.run({"monitor", "--duration", "100ms", "--html", device.path("quiet.html")});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.err, Contains("note: nothing happened that a page could show"));
  CHECK_FALSE(std::filesystem::exists(device.path("quiet.html")));
}
