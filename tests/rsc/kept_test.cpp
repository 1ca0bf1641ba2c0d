// rsc run keeps KEPT numbers from one run to the next, and never what is not its own.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Folder;
using test::Outcome;

namespace {

constexpr const char* kKeptProgram =
    "REMEMBER visits = 0 KEPT\nREMEMBER nearest = 400cm KEPT\nREMEMBER touches = 0\n"
    "WHEN near DISTANCE < 80cm\nDO\n  RAISE visits BY 1\n  RAISE touches BY 1\n"
    "  SET nearest TO MIN(nearest, near DISTANCE)\n  LOG \"visit\", visits, nearest\nEND\n"
    "TEST \"fresh\"\n  AT 0s near DISTANCE = 50cm\n  EXPECT LOG \"visit 1 50cm\" WITHIN "
    "10ms\nEND\n";

// A robot with somebody at 35.5 cm.
class Visit : public Folder {
public:
  Visit() : program(write("robot.rsl", kKeptProgram)) {
    write("robot.json", R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels":
        {"DISTANCE": {"unit": "cm", "range": [2, 400]}}}], "actuators": []})");
    scenario = write("visit.json", R"({"duration": "3s", "stimuli": [
        {"at": "1s", "sensor": "near", "value": "35.5cm"}]})");
  }
  [[nodiscard]] Outcome run(const std::string& file,
                            const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", file, "--scenario", scenario};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::rsc(arguments);
  }
  [[nodiscard]] json kept(const std::string& file = "robot.kept.json") const {
    return json::parse(read(file)).at("kept");
  }

  std::string program, scenario;
};

}  // namespace

TEST_CASE("KEPT numbers go on in the next run, and other ones begin anew") {
  const Visit robot;
  CHECK_THAT(robot.run(robot.program).out, Contains("visit 1 35.5cm"));
  CHECK(robot.kept() == json({{"visits", "1"}, {"nearest", "35.5cm"}}));
  for (const char* const level : {"-O0", "-O1"}) {
    robot.write("robot.kept.json", R"({"kept": {"visits": "41", "nearest": "20cm"}})");
    const Outcome again = robot.run(robot.program, {level});
    CHECK_THAT(again.out, Contains("visit 42 20cm") && Contains("touches becomes 1"));
    CHECK_THAT(again.err,
               Contains("visits starts at 41, from ") && Contains("nearest starts at 20cm"));
    CHECK(robot.kept().at("visits") == "42");
  }
}

TEST_CASE("what the last moment of a run has set is kept, and no more than that") {
  const Visit robot;
  for (const char* const length : {"1s", "1001ms"}) {
    const Outcome run = robot.run(robot.program, {"--duration", length, "--fresh", "--all"});
    CHECK((run.out.find("visits becomes 1") != std::string::npos) == (length[1] == '0'));
    CHECK(robot.kept() == json({{"visits", "1"}, {"nearest", "35.5cm"}}));
  }
  CHECK(robot.run(robot.program, {"--duration", "999ms", "--fresh"}).exit == 0);
  CHECK(robot.kept() == json({{"visits", "0"}, {"nearest", "400cm"}}));
}

TEST_CASE("a run that is interrupted ends there: its files and KEPT numbers are written") {
  const Visit robot;
  const std::string program =
      robot.write("robot.rsl",
                  "REMEMBER visits = 0 KEPT\nEVERY 100ms DO\n  RAISE visits BY 1\nEND\n"
                  "WHEN near DISTANCE < 80cm DO LOG \"near\" END\n");
  for (const int signal : {SIGINT, SIGTERM}) {
    test::Running run({"run", program, "--duration", "100h", "--fresh", "--trace",
                       robot.path("t.jsonl"), "--record", robot.path("r.jsonl"), "--html",
                       robot.path("p.html")});
    REQUIRE(run.has_said("note: without a scenario", 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const Outcome outcome = run.end(signal);
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 128 + signal);
    CHECK_THAT(outcome.err, Contains("note: interrupted; the run ended at "));
    const std::string trace = robot.read("t.jsonl");
    const std::size_t last = trace.rfind('\n', trace.size() - 2) + 1;
    const auto seconds = json::parse(trace.substr(last)).at("t_us").get<double>() / 1e6;
    CHECK(std::stod(robot.kept().at("visits").get<std::string>()) ==
          Approx(seconds * 10).margin(2));
    CHECK(test::rsc({"replay", robot.path("r.jsonl")}).exit == 0);
    CHECK_THAT(robot.read("p.html"), Contains("</html>"));
    for (const char* const name : {"t.jsonl", "r.jsonl", "p.html", "robot.kept.json"})
      std::filesystem::remove(robot.path(name));
  }
}

// The optimiser must not take what is written for what the number is.
TEST_CASE("a KEPT number that nothing sets is what the file says") {
  const Visit robot;
  const std::string program =
      robot.write("robot.rsl",
                  "REMEMBER floor = 0 KEPT\nWHEN near DISTANCE < 80cm AND floor > 2\n"
                  "DO LOG \"floor\", floor\nEND\n");
  for (const char* const level : {"-O0", "-O1"}) {
    robot.write("robot.kept.json", R"({"kept": {"floor": "3"}})");
    CHECK_THAT(robot.run(program, {level}).out, Contains("floor 3"));
    CHECK(robot.kept().at("floor") == "3");
    CHECK_THAT(robot.run(program, {level, "--fresh"}).out, !Contains("floor"));
  }
}

TEST_CASE("an image, --fresh, --kept, and a TEST") {
  const Visit robot;
  robot.write("robot.kept.json", R"({"kept": {"visits": "6", "nearest": "20cm"}})");
  const std::string image = robot.path("robot.rsb");
  const Outcome compiled = test::rsc({"compile", robot.program, "-o", image});
  CHECK(compiled.exit == 0);
  CHECK_THAT(robot.run(image).out, Contains("visit 7 20cm"));
  CHECK(robot.kept() == json({{"visits", "7"}, {"nearest", "200mm"}}));
  CHECK(test::rsc({"test", robot.program}).exit == 0);
  CHECK(robot.kept().at("visits") == "7");
  CHECK_THAT(robot.run(robot.program, {"--fresh"}).out, Contains("visit 1 35.5cm"));
  CHECK(robot.kept().at("visits") == "1");
  CHECK(robot.run(robot.program, {"--kept", robot.path("mine.json")}).exit == 0);
  CHECK(robot.kept("mine.json").at("visits") == "1");
}

TEST_CASE("a person may write a number without quotes") {
  const Visit robot;
  robot.write("robot.kept.json", R"({"kept": {"visits": 6, "nearest": "20cm"}})");
  CHECK_THAT(robot.run(robot.program).out, Contains("visit 7 20cm"));
}

TEST_CASE("a number without a unit is offered the one of the program") {
  const Visit robot;
  robot.write("robot.kept.json", R"({"kept": {"visits": "6", "nearest": "5"}})");
  CHECK_THAT(robot.run(robot.program).err, Contains("this is a distance; write it as 5cm;"));
  robot.write("robot.kept.json", R"({"kept": {"visits": "6", "nearest": "5s"}})");
  CHECK_THAT(robot.run(robot.program).err, Contains("it takes a number with mm, cm or m;"));
}

TEST_CASE("what cannot be read is left as it is") {
  const Visit robot;
  const std::string half = R"({"kept": {"visi)";
  for (const std::string& text :
       {half, std::string(), std::string("[1]"), std::string(R"({"sensors": []})"),
        std::string(R"({"kept": {"visits": true}})"), std::string(R"({"kept": {}, "more": 1})")}) {
    robot.write("robot.kept.json", text);
    for (const bool fresh : {false, true}) {
      const Outcome outcome = robot.run(
          robot.program, fresh ? std::vector<std::string>{"--fresh"} : std::vector<std::string>{});
      CHECK(outcome.exit == 3);
      CHECK(outcome.out.empty());
      CHECK_THAT(outcome.err, Contains("robot.kept.json: this is not a file of kept numbers") &&
                                  Contains("nothing was changed"));
      CHECK(robot.read("robot.kept.json") == text);
    }
  }
}

TEST_CASE("a number of another kind, one too large, and one that the program does not have") {
  const Visit robot;
  const std::string other = R"({"kept": {"Visits": "3s", "old": "4"}})";
  robot.write("robot.kept.json", other);
  Outcome outcome = robot.run(robot.program);
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("`Visits`: `3s` is a time, but this is a plain number") &&
                              Contains("--fresh"));
  CHECK(robot.read("robot.kept.json") == other);
  robot.write("robot.kept.json", R"({"kept": {"visits": "9999999999"}})");
  CHECK(robot.run(robot.program).exit == 3);

  robot.write("robot.kept.json", R"({"kept": {"Visits": "3", "old": "4"}})");
  outcome = robot.run(robot.program);
  CHECK_THAT(outcome.out, Contains("visit 4 35.5cm"));
  CHECK_THAT(outcome.err, Contains("also keeps `old`, which the program does not; it stays there"));
  CHECK(robot.kept() == json({{"Visits", "4"}, {"old", "4"}, {"nearest", "35.5cm"}}));
}

TEST_CASE("a program that keeps nothing makes no file, and a trace is not written onto it") {
  const Visit robot;
  const std::string plain =
      robot.write("plain.rsl", "WHEN near DISTANCE < 80cm\nDO LOG \"x\"\nEND\n");
  CHECK(robot.run(plain, {"--config", robot.path("robot.json")}).exit == 0);
  CHECK(!robot.has("plain.kept.json"));
  CHECK(robot.run(robot.program).exit == 0);
  const std::string before = robot.read("robot.kept.json");
  CHECK(robot.run(robot.program, {"--trace", robot.path("robot.kept.json")}).exit == 2);
  CHECK(robot.read("robot.kept.json") == before);
}
