// rsc upload with several --port: robots that run in this process, each at a line of its own, and the built rsc.
#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/rsc/device.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Device;
using test::Outcome;

namespace {

Outcome upload_to(const std::vector<std::string>& ports, const std::string& program,
                  const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"upload", program};
  for (const std::string& port : ports)
    arguments.insert(arguments.end(), {"--port", port});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test::rsc(std::move(arguments));
}

// What runs there; empty when nothing does.
std::string running_at(const Device& device) {
  const json program =
      json::parse(device.run({"info", "--format", "json"}).out).at("board").at("program");
  return program.is_null() ? "" : program.at("hash").get<std::string>();
}

// The lines of the table: its head, and one for each robot.
std::vector<std::string> rows_of(const std::string& table) {
  std::vector<std::string> rows;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);)
    rows.push_back(line);
  return rows;
}

}  // namespace

TEST_CASE("an upload to several robots at once: each runs the program, and has a line of a table") {
  const Device one, two;
  const std::string other = one.write("other.rsl", "EVERY 1s DO LOG \"tick\" END\n");
  REQUIRE(one.run({"upload", one.program}).exit == 0);
  const std::string before = running_at(one);
  const Outcome outcome = upload_to({one.port, two.port}, other);
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit == 0);
  CHECK(outcome.err.empty());
  const std::string hash = running_at(one);
  CHECK(hash != before);
  CHECK(running_at(two) == hash);
  const std::vector<std::string> rows = rows_of(outcome.out);
  REQUIRE(rows.size() == 3);
  CHECK_THAT(rows[0], Catch::StartsWith("port ") && Contains("program") && Contains("bytes sent") &&
                          Contains("ms  state"));
  CHECK_THAT(rows[1], Catch::StartsWith(one.port + "  " + hash) &&
                          Contains("  running; not kept: this board has no working store"));
  CHECK_THAT(rows[2], Catch::StartsWith(two.port + "  " + hash) && Contains("  running; "));
}

TEST_CASE("an upload to several robots goes on without those that are not there or are too small") {
  const Device good;
  const Device small(12 * 1024);
  const std::string absent = "unix:" + good.path("nobody");
  std::string many = test::kProgram;
  for (int i = 0; i < 20; ++i)
    many += "BEHAVIOR b" + std::to_string(i) + " PRIORITY " + std::to_string(i + 1) +
            "\nWHEN touch LEVEL = " + std::to_string(i % 10) + " DO\n  MOVE left_arm SLOWLY TO " +
            std::to_string(i) + "deg\nEND\nEND\n";
  good.write("many.rsl", many);

  Outcome outcome = upload_to({small.port, good.port}, good.path("many.rsl"));
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("many.rsl runs on 1 of 2 robots"));
  CHECK(running_at(small).empty());
  const std::string hash = running_at(good);
  CHECK_FALSE(hash.empty());
  std::vector<std::string> rows = rows_of(outcome.out);
  REQUIRE(rows.size() == 3);
  CHECK_THAT(rows[1], Catch::StartsWith(small.port + "  - ") &&
                          Contains("cannot run this program: the program needs ") &&
                          Contains("the board has 12288 for programs"));
  CHECK_THAT(rows[2], Catch::StartsWith(good.port + "  " + hash) && Contains("  running; "));

  // The worst of all is the exit, wherever it stands.
  outcome = upload_to({absent, good.port, small.port}, good.path("many.rsl"));
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 3);
  rows = rows_of(outcome.out);
  REQUIRE(rows.size() == 4);
  CHECK_THAT(rows[1], Catch::StartsWith(absent + "  - ") && Contains("is the robot running?"));
  CHECK_THAT(rows[2], Catch::StartsWith(good.port + " ") && Contains("  " + hash + "  ") &&
                          Contains("  running; "));
}

TEST_CASE("a program for another board than several robots are is refused for each of them") {
  const Device mine;
  json robot = json::parse(test::kRobot);
  robot["board"] = "b-l475e-iot01a";
  robot["actuators"][0]["pin"] = 3;
  const std::string config = mine.write("other.json", robot.dump());
  const Device here;
  const Outcome outcome =
      upload_to({mine.port, here.port}, mine.program, {"--config", config, "--format", "json"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 3);
  const json list = json::parse(outcome.out);
  CHECK(list.size() == 2);
  for (const json& one : list) {
    CHECK(one.at("exit") == 3);
    CHECK_THAT(one.at("error").get<std::string>(),
               Contains("it is for b-l475e-iot01a, and this is mps2-an386"));
  }
}

TEST_CASE("an upload to several robots as JSON: what one robot gives, with its port") {
  const Device one, two;
  const std::string absent = "unix:" + one.path("nobody");
  const json alone = json::parse(one.run({"upload", one.program, "--format", "json"}).out);
  const Outcome outcome =
      upload_to({one.port, absent, two.port}, one.program, {"--format", "json"});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 3);
  const json list = json::parse(outcome.out);
  REQUIRE(list.size() == 3);
  for (const auto& [key, value] : alone.items()) {
    CAPTURE(key);
    CHECK(list.at(0).contains(key));
    CHECK(list.at(2).contains(key));
  }
  CHECK(list.at(0).at("port") == one.port);
  CHECK(list.at(0).at("program") == running_at(one));
  CHECK_FALSE(list.at(0).contains("error"));
  CHECK(list.at(1).at("port") == absent);
  CHECK(list.at(1).at("exit") == 3);
  CHECK_THAT(list.at(1).at("error").get<std::string>(), Contains("is the robot running?"));
  CHECK(list.at(2).at("port") == two.port);
}

TEST_CASE("several robots are waited for at the same time") {
  const test::RobotFolder folder;
  std::vector<int> dumb;
  std::vector<std::string> ports;
  for (int i = 0; i < 20; ++i) {
    dumb.push_back(test::listen_at(folder.path("dumb" + std::to_string(i))));
    ports.push_back("unix:" + folder.path("dumb" + std::to_string(i)));
  }
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = upload_to(ports, folder.program);
  const auto took = std::chrono::steady_clock::now() - start;
  for (const int file : dumb)
    close(file);
  CAPTURE(outcome.out);
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("runs on 0 of 20 robots"));
  CHECK(took < std::chrono::seconds(30));  // each takes two
}

TEST_CASE("the same port twice, under whatever name, is wrong usage, and nothing is uploaded") {
  const Device device;
  std::filesystem::create_symlink(device.path("line"), device.path("link"));
  const std::string link = "unix:" + device.path("link");
  for (const std::string& again : {device.port, link}) {
    const Outcome outcome = upload_to({device.port, again}, device.program);
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains("--port " + again + " is ") &&
                                Contains(again == link ? device.port : "twice"));
  }
  CHECK(upload_to({"tcp:localhost:1", "tcp:localhost:1"}, device.program).exit == 2);
  CHECK(running_at(device).empty());
}

TEST_CASE("a program with a robot's name is not given to several robots, but --anyway") {
  const Device one, two;
  json robot = json::parse(test::kRobot);
  robot["name"] = "ada";
  const std::string config = one.write("ada.json", robot.dump());
  Outcome outcome = upload_to({one.port, two.port}, one.program, {"--config", config});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("is for the robot \"ada\"") && Contains("2 robots") &&
                              Contains("--config") && Contains("Nothing was sent"));
  CHECK(running_at(one).empty());
  CHECK(running_at(two).empty());
  CHECK(upload_to({one.port, two.port}, one.program, {"--config", config, "--anyway"}).exit == 0);
  CHECK(upload_to({one.port}, one.program, {"--config", config}).exit == 0);
  CHECK(running_at(two) == running_at(one));
}
