// upload, info, feed and monitor: the built rsc talks over a Unix socket, TCP and a pty to a robot
// that runs in this process (the real kernel, runtime and server).
#include "tests/rsc/device.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <thread>

#include <arpa/inet.h>
#include <catch2/catch.hpp>
#include <fcntl.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Bridge;
using test::Device;
using test::Folder;
using test::listen_at;
using test::open_pty_master;
using test::Outcome;
using test::RobotFolder;

TEST_CASE("upload, info, feed and monitor against a running robot") {
  const Device device;
  Outcome outcome = device.run({"info"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("board     mps2-an386, firmware") &&
                              Contains("program   none") && Contains("link"));

  outcome = device.run({"feed", "touch.LEVEL=2"});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("no program runs"));

  outcome = device.run({"upload", device.program});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("bytes in") && Contains("runs since"));
  CHECK(outcome.err.find('\r') == std::string::npos);  // progress is for terminals

  outcome = device.run({"info", "--format", "json"});
  REQUIRE(outcome.exit == 0);
  const json info = json::parse(outcome.out);
  CHECK(info.at("board").at("program").at("bytes") > 100);
  CHECK(info.at("status").at("activations") == 1);
  CHECK(info.at("threads").back().at("name") == "link");

  outcome = device.run({"feed", "touch.LEVEL=2", "--watch", "700ms", "--format", "json"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit == 0);
  std::vector<std::string> kinds;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);)
    kinds.push_back(json::parse(line).at("event"));
  CHECK(std::ranges::find(kinds, "input") != kinds.end());
  CHECK(std::ranges::find(kinds, "command") != kinds.end());

  outcome = device.run({"feed", "touch.LEVL=2"});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("did you mean `LEVEL`?"));
  for (const char* const none : {"touch", "=1", ".LEVEL=1"}) {
    outcome = device.run({"feed", none});
    CHECK(outcome.exit == 2);
    CHECK_THAT(outcome.err, Contains("is not a reading; write SENSOR.CHANNEL=VALUE"));
  }

  outcome = device.run({"feed", "proximity.DISTANCE=9m", "touch.LEVEL=1", "--format", "json"});
  CHECK(json::parse(outcome.out) == json({{"fed", 2}}));
  CHECK(outcome.err ==
        "note: 9000mm is out of the range of proximity DISTANCE, 20mm to 4000mm: the robot reads "
        "4000mm\n");

  outcome = device.run({"monitor", "--duration", "200ms"});
  CHECK(outcome.exit == 0);
}

namespace {

// The readings of touch that a watch has shown, thousandths.
std::vector<double> touches(const std::string& out) {
  std::vector<double> values;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);)
    if (const json event = json::parse(line);
        event.at("event") == "input" && event.at("sensor") == "touch")
      values.push_back(event.at("value"));
  return values;
}

// How long after the first of them the last one came, by the program's time.
std::int64_t spread_us(const std::string& out) {
  std::vector<std::int64_t> times;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);)
    if (const json event = json::parse(line);
        event.at("event") == "input" && event.at("sensor") == "touch")
      times.push_back(event.at("t_us"));
  return times.empty() ? 0 : times.back() - times.front();
}

}  // namespace

TEST_CASE("a scenario for a program that runs already counts from now") {
  const Device device;
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  const std::string scenario = device.write("visit.json", R"({"stimuli": [
    {"at": "0s", "sensor": "touch", "value": 1}, {"at": "5ms", "sensor": "touch", "value": 2},
    {"at": "300ms", "sensor": "touch", "value": 3}]})");
  Outcome outcome =
      device.run({"feed", "--scenario", scenario, "--watch", "200ms", "--format", "json"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(touches(outcome.out) == std::vector<double>{1, 2, 3});
  CHECK(spread_us(outcome.out) >= 100'000);  // 300 ms, less what a busy machine comes late
  CHECK(device.run({"feed", "--scenario", scenario}).exit == 0);
  outcome = device.run({"feed", "touch.LEVEL=2", "--at", "10ms"});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("the program is already past 10 ms: --at is a program time; "
                                   "without it the readings are for now"));
}

TEST_CASE("a scenario that is fed with the program may begin with it") {
  const Device device;
  const std::string scenario = device.write("visit.json", R"({"stimuli": [
    {"at": "0s", "sensor": "touch", "value": 1}, {"at": "1ms", "sensor": "touch", "value": 2},
    {"at": "2ms", "sensor": "touch", "value": 3}, {"at": "3ms", "sensor": "touch", "value": 4},
    {"at": "900ms", "sensor": "touch", "value": 5}]})");
  // The watch goes on until the last one is due, and then so long.
  Outcome outcome = device.run({"feed", "--upload", device.program, "--scenario", scenario,
                                "--watch", "200ms", "--format", "json"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(touches(outcome.out) == std::vector<double>{1, 2, 3, 4, 5});
  CHECK_THAT(outcome.err, Contains("due right at the start came a little late"));
  // Nothing is uploaded for one that is wrong.
  device.write("visit.json", R"({"stimuli": [{"at": "0s", "sensor": "touch", "value": "x"}]})");
  const json before = json::parse(device.run({"info", "--format", "json"}).out);
  CHECK(device.run({"feed", "--upload", device.program, "--scenario", scenario}).exit == 1);
  const json after = json::parse(device.run({"info", "--format", "json"}).out);
  CHECK(before.at("status").at("activations") == after.at("status").at("activations"));
}

TEST_CASE("a sensor whose bus is held down is told at the upload, by info and by monitor") {
  const Device device;
  device.write("robot.json", R"({
    "sensors": [{"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
                 "channels": {"LEVEL": {"input": 0, "range": [0, 10]}}}],
    "actuators": [{"name": "arm", "type": "VIRTUAL", "device": "virtual_actuator"}]})");
  const std::string file = device.write("touch.rsl", "WHEN touch LEVEL > 5 DO\n  MOVE arm\nEND\n");
  const auto says_held = [](const std::string& text) {
    CHECK_THAT(text, Contains("touch at address 0x70 on i2c bus 0 does not answer (") &&
                         Contains("a line of that bus is held low"));
  };

  Outcome outcome = device.run({"upload", file, "--config", device.path("robot.json")});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit == 0);
  CHECK_THAT(outcome.err, Contains("warning: "));
  says_held(outcome.err);
  outcome = device.run({"upload", file, "--config", device.path("robot.json"), "--format", "json"});
  const json uploaded = json::parse(outcome.out).at("silent").at(0);
  CHECK(uploaded.at("sensor") == "touch");
  CHECK(uploaded.at("bus_held") == true);

  outcome = device.run({"info"});
  CHECK_THAT(outcome.out, Contains("buses     1 sensors, ") && Contains(", 2 bus clears\n") &&
                              Contains("silent    "));
  says_held(outcome.out);
  const json buses = json::parse(device.run({"info", "--format", "json"}).out).at("buses");
  CHECK(buses.at("clears") == 2);
  CHECK(buses.at("devices").at(0).at("answers") == false);
  CHECK(buses.at("devices").at(0).at("driver") == "max34451");

  outcome = device.run({"monitor", "--duration", "200ms"});
  CHECK_THAT(outcome.out, Contains("       silent  "));
  says_held(outcome.out);
  outcome = device.run({"monitor", "--duration", "200ms", "--format", "json"});
  CHECK(json::parse(outcome.out.substr(0, outcome.out.find('\n'))).at("silent").size() == 1);
}

TEST_CASE("a program for another board than the one on the line is refused, and both are named") {
  const Device device;
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  json robot = json::parse(test::kRobot);
  robot["board"] = "b-l475e-iot01a";
  robot["actuators"][0]["pin"] = 3;
  const std::string config = device.write("other.json", robot.dump());
  const std::string image = device.path("other.rsb");
  REQUIRE(test::rsc({"compile", device.program, "--config", config, "-o", image}).exit == 0);
  CHECK_THAT(test::rsc({"dump", image}).out, Contains("for b-l475e-iot01a; "));
  for (const std::vector<std::string>& upload :
       {std::vector<std::string>{"upload", device.program, "--config", config},
        {"upload", image},
        {"upload", image, "--anyway"},
        {"feed", "touch.LEVEL=2", "--upload", image}}) {
    const Outcome outcome = device.run(upload);
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 3);
    CHECK_THAT(outcome.err,
               Contains("it is for b-l475e-iot01a, and this is mps2-an386: say \"board\": "
                        "\"mps2-an386\" in robot.json, and compile it again"));
  }
  CHECK(json::parse(device.run({"info", "--format", "json"}).out).at("status").at("activations") ==
        1);
}

TEST_CASE("feed uploads a program that takes too long only with --anyway") {
  const Device device;
  json robot = json::parse(test::kRobot);
  robot["board"] = "mps2-an386";
  (void)device.write("robot.json", robot.dump());
  const std::string busy =
      device.write("busy.rsl",
                   "REMEMBER round = 0\nEVERY 1ms DO\n  REPEAT 900 TIMES\n    SET round TO (round "
                   "* 3 + 1) MOD 1000\n"
                   "  END\nEND\nWHEN touch LEVEL > 3 DO\n  MOVE left_arm TO 1deg\nEND\n");
  const Outcome outcome = device.run({"feed", "touch.LEVEL=2", "--upload", busy});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("error[E0412]"));
  CHECK(device.run({"feed", "touch.LEVEL=2", "--upload", busy, "--anyway"}).exit == 0);
}

TEST_CASE("a program for another robot is refused with both names, except with --anyway") {
  const Device device;
  const auto program_for = [&](const std::string& name) {
    json robot = json::parse(test::kRobot);
    if (!name.empty()) robot["name"] = name;
    const std::string image = device.path(name + ".rsb");
    REQUIRE(test::rsc({"compile", device.program, "--config",
                       device.write(name + ".json", robot.dump()), "-o", image})
                .exit == 0);
    return image;
  };
  const std::string ada = program_for("ada"), bob = program_for("bob"), any = program_for("");
  const auto name = [&] {
    return json::parse(device.run({"info", "--format", "json"}).out).at("board").at("robot");
  };
  REQUIRE(device.run({"upload", any}).exit == 0);
  CHECK(name() == nullptr);
  REQUIRE(device.run({"upload", ada}).exit == 0);
  CHECK(name() == "ada");
  for (const std::vector<std::string>& sent :
       {std::vector<std::string>{"upload", bob}, {"feed", "touch.LEVEL=2", "--upload", bob}}) {
    const Outcome outcome = device.run(sent);
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 3);
    CHECK_THAT(outcome.err, Contains("this robot is \"ada\", and the program is for \"bob\""));
  }
  CHECK(name() == "ada");
  // The refused transfer has kept the line.
  CHECK(device.run({"upload", bob}).exit == 3);
  const Outcome fed = device.run({"feed", "touch.LEVEL=9", "--watch", "700ms"});
  CHECK(fed.exit == 0);
  CHECK_THAT(fed.out, Contains("touch LEVEL = 9"));
  CHECK_THAT(device.run({"info"}).out, Contains("robot     ada\n"));
  CHECK_THAT(device.run({"monitor", "--duration", "200ms"}).out, Contains("        robot  ada\n"));
  REQUIRE(device.run({"feed", "touch.LEVEL=2", "--upload", bob, "--anyway"}).exit == 0);
  CHECK(name() == "bob");
  CHECK_THAT(test::rsc({"dump", bob}).out, Contains(", the robot \"bob\"; "));
}

TEST_CASE("a program this board cannot run is refused before it is sent, and the old one goes on") {
  const Device device(12 * 1024);  // less than the board that robot.json is for
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  std::string many = test::kProgram;
  for (int i = 0; i < 20; ++i) {
    many += "BEHAVIOR b" + std::to_string(i) + " PRIORITY " + std::to_string(i + 1) +
            "\nWHEN touch LEVEL = " + std::to_string(i % 10) + " DO\n  MOVE left_arm SLOWLY TO " +
            std::to_string(i) + "deg\nEND\nEND\n";
  }
  device.write("many.rsl", many);
  const Outcome outcome = device.run({"upload", device.path("many.rsl")});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("cannot run this program") && Contains("the program needs ") &&
                              Contains("the board has 12288 for programs"));
  const json info = json::parse(device.run({"info", "--format", "json"}).out);
  CHECK(info.at("status").at("activations") == 1);
}

namespace {

// One that needs many frames.
std::string long_program() {
  const std::string tail = " is what it says to whoever reads what is in the log of it";
  std::string text = std::string(test::kProgram) + "BEHAVIOR talks PRIORITY 1\n";
  for (int i = 0; i < 30; ++i)
    text += "WHEN touch LEVEL = " + std::to_string(i % 10) + " DO\n  LOG \"" + std::to_string(i) +
            tail + "\"\nEND\n";
  return text + "END\n";
}

std::string running_on(const Device& device) {
  return json::parse(device.run({"info", "--format", "json"}).out)
      .at("board")
      .at("program")
      .at("hash");
}

// Ends with 3, soon. Three seconds are tested in virtual time (update/upload_faults_test.cpp); a busy machine takes longer, above all
// under sanitizers. Without an end to the silence it would be 25 s.
Outcome fails_soon(const Device& device, const std::vector<std::string>& arguments) {
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome = device.run(arguments);
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 3);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
  return outcome;
}

constexpr std::size_t kHelloReply = sizeof(link::HelloReply) + link::kFrameOverhead + 2;
constexpr std::size_t kTransferStatus = sizeof(link::TransferStatus) + link::kFrameOverhead + 2;

}  // namespace

TEST_CASE("a program for which there is no room beside the running one may replace it") {
  const Device device(176 * 64);
  const std::string file = device.write("talkative.rsl", long_program());
  const Outcome first = device.run({"upload", file});
  CAPTURE(first.err);
  REQUIRE(first.exit == 0);
  const Outcome beside = device.run({"upload", file});
  CAPTURE(beside.err);
  CHECK(beside.exit == 3);
  CHECK_THAT(beside.err, Contains("bytes free, and the image has ") && Contains("--replace"));
  CHECK(json::parse(device.run({"info", "--format", "json"}).out).at("status").at("activations") ==
        1);
  const Outcome instead = device.run({"upload", file, "--replace"});
  CAPTURE(instead.err);
  CHECK(instead.exit == 0);
  const json info = json::parse(device.run({"info", "--format", "json"}).out);
  CHECK(info.at("status").at("activations") == 2);
  const json memory = info.at("board").at("memory");
  std::uint32_t all = 0;
  for (const auto& [whose, bytes] : memory.at("by").items())
    all += bytes.get<std::uint32_t>();
  CHECK(memory.at("used") == all);
}

TEST_CASE("a damaged image is not uploaded") {
  const Device device;
  REQUIRE(test::rsc({"compile", device.program}).exit == 0);
  std::string image = device.read("robot.rsb");
  image.back() = static_cast<char>(image.back() ^ 1);
  const Outcome outcome = device.run({"upload", device.write("damaged.rsb", image)});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("damaged.rsb: the image is damaged"));
}

TEST_CASE("a port that is not there is exit 3, and says what to try") {
  const RobotFolder robot;
  for (const auto& [port, hint] : std::vector<std::pair<std::string, std::string>>{
           {"/dev/ttyNOTHING", "`rsc ports` lists"},
           {"unix:" + robot.path("nobody"), "is the robot running?"},
           {"tcp:127.0.0.1:1", "refused"}}) {
    const Outcome outcome = test::rsc({"info", "--port", port});
    CAPTURE(port, outcome.err);
    CHECK(outcome.exit == 3);
    CHECK_THAT(outcome.err, Contains(port) && Contains(hint));
  }
}

TEST_CASE("a port without firmware behind it is exit 3") {
  const RobotFolder robot;
  const int file = listen_at(robot.path("dumb"));
  const Outcome outcome = test::rsc(
      {"upload", robot.program, "--port", "unix:" + robot.path("dumb"), "--timeout", "1s"});
  close(file);
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("the board does not answer") && Contains(robot.path("dumb")));
}

TEST_CASE("a timeout that no board can meet is refused") {
  const Device device;
  for (const char* const time : {"0s", "1ms", "999ms"}) {
    const Outcome outcome = device.run({"upload", device.program, "--timeout", time});
    CHECK(outcome.exit == 2);
    CHECK_THAT(outcome.err, Contains("--timeout: a board may need 1s to answer"));
  }
  CHECK(device.run({"upload", device.program, "--timeout", "1s"}).exit == 0);
}

TEST_CASE("a board that falls silent in mid-upload: soon, and says that the old program runs") {
  Device device;
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  const std::string old = running_on(device);
  device.bridge.fall_silent_after(kHelloReply + 3 * kTransferStatus);
  const Outcome outcome =
      fails_soon(device, {"upload", device.write("long.rsl", long_program()), "--anyway"});
  CHECK_THAT(outcome.err, Contains("has fallen silent") &&
                              Contains("program " + old + " keeps running") &&
                              Contains("upload again when the line works"));
  device.bridge.fall_silent_after(Bridge::kNever);
  CHECK(running_on(device) == old);
}

TEST_CASE("an activation whose answer is lost: soon, and says that the new program may run") {
  Device device;
  device.bridge.fall_silent_with_program();
  const Outcome outcome = fails_soon(device, {"upload", device.program});
  CHECK_THAT(outcome.err, Contains("may run") && Contains("`rsc info` shows what runs"));
}

TEST_CASE("orders to a board that falls silent end soon, and say that they may have been done") {
  Device device;
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  for (const auto& [arguments, bytes] :
       std::vector<std::pair<std::vector<std::string>, std::size_t>>{
           {{"resume"}, kHelloReply},
           {{"feed", "touch.LEVEL=2"}, kHelloReply},
           {{"feed", "touch.LEVEL=2"}, kHelloReply + 300}}) {
    device.bridge.fall_silent_after(bytes);
    const Outcome outcome = fails_soon(device, arguments);
    CHECK_THAT(outcome.err, Contains("has fallen silent"));
    if (arguments.front() == "resume")
      CHECK_THAT(outcome.err, Contains("may have done it all the same: `rsc info`"));
  }
}

TEST_CASE("who interrupts an upload may start another one at once") {
  Device device;
  const std::string file = device.write("long.rsl", long_program());
  const std::size_t heard = device.bridge.bytes_heard();
  test::Running first({"upload", file, "--anyway", "--port", device.port});
  while (device.bridge.bytes_heard() < heard + 600)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  (void)first.end(SIGINT);
  const Outcome outcome = device.run({"upload", device.program});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
}

TEST_CASE("a line that is closed in mid-upload: what runs, and what to do") {
  Device device;
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  const std::string old = running_on(device);
  device.bridge.hang_up_after(kHelloReply + 3 * kTransferStatus);
  const Outcome outcome =
      fails_soon(device, {"upload", device.write("long.rsl", long_program()), "--anyway"});
  CHECK_THAT(outcome.err, Contains("the other end closed the line") &&
                              Contains("program " + old + " keeps running") &&
                              Contains("upload again when the line works"));
}

TEST_CASE("a line that is closed while somebody listens, and stays so, is exit 3") {
  auto device = std::make_unique<Device>();
  Outcome outcome;
  std::thread monitor([&, port = device->port] {
    outcome = test::rsc({"monitor", "--port", port, "--duration", "2500ms"});
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(700));  // it watches
  device.reset();
  monitor.join();
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("the other end closed the line; looking for it again"));
}

TEST_CASE("a monitor says once that the board has restarted") {
  Device device;
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  test::Running monitor({"monitor", "--port", device.port, "--duration", "5s"});
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  device.bridge.reset();
  const Outcome outcome = monitor.end(0);
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(outcome.err == "rsc: the board has restarted\n");
}

// As on a laptop that sleeps: when it looks again, the board has been up for longer than at its last look.
TEST_CASE("a monitor that was stopped meanwhile says that the board has restarted") {
  Device device;
  test::Running monitor({"monitor", "--port", device.port, "--duration", "14s"});
  std::this_thread::sleep_for(std::chrono::milliseconds(4500));
  monitor.send(SIGSTOP);
  device.bridge.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(6500));
  monitor.send(SIGCONT);
  const Outcome outcome = monitor.end(0);
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(outcome.err == "rsc: the board has restarted\n");
}

TEST_CASE("a monitor finds a line again that was closed, and says so") {
  Device device;
  const std::string ticking = device.write("robot.rsl", "EVERY 100ms DO LOG \"tick\" END\n");
  const Folder folder;
  Outcome outcome;
  std::thread monitor([&] {
    outcome = device.run(
        {"monitor", "--duration", "5s", "--upload", ticking, "--record", folder.path("r.jsonl")});
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(2200));
  device.bridge.hang_up();
  monitor.join();
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.err, Contains("looking for it again") &&
                              Contains("the line is back; what happened meanwhile"));
  CHECK_THAT(outcome.out, Contains("log: tick"));
  // The recording has a gap there, which replay respects.
  outcome = test::rsc({"replay", folder.path("r.jsonl"), "--format", "json"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit == 0);
  const json report = json::parse(outcome.out);
  REQUIRE(report.at("programs").size() == 1);
  CHECK(report.at("programs").at(0).at("events") > 0);
  CHECK_THAT(report.at("programs").at(0).at("gap").get<std::string>(), Contains("closed the line"));
  CHECK(report.at("not_replayed") > 0);
}

TEST_CASE("a robot that was uploaded to while it was recorded is replayed to the same commands") {
  const Device device;
  std::string robot = test::kRobot;
  robot.replace(robot.find("cm"), 2, "mm");
  device.write("robot.json", robot);
  const std::string program =
      device.write("robot.rsl", "EVERY 100ms DO MOVE left_arm QUICKLY TO 10deg END\n");
  const std::string record = device.path("r.jsonl");
  test::Running monitor({"monitor", "--upload", program, "--record", record, "--html",
                         device.path("r.html"), "--port", device.port});
  CHECK(monitor.has_written(record, R"("to":10)", 3));
  device.write("robot.rsl",
               "EVERY 1h DO MOVE left_amr TO 20deg END\n");  // wrong: nothing happens
  CHECK(monitor.has_said("robot.rsl:1", 1));
  device.write("robot.rsl",
               "EVERY 150ms DO MOVE left_arm QUICKLY TO 30deg END\n"
               "WHEN proximity DISTANCE < 20mm DO LOG \"near\" END\n");
  CHECK(monitor.has_written(record, R"("to":30)", 3));
  Outcome outcome = monitor.end(SIGINT);
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.err, Contains("robot.rsl:1"));
  outcome = test::rsc({"replay", device.path("r.jsonl"), "--format", "json"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit == 0);
  const json report = json::parse(outcome.out);
  REQUIRE(report.at("programs").size() == 2);
  for (const json& one : report.at("programs")) {
    CHECK(one.at("gap").is_null());
    CHECK(one.at("commands") > 2);
  }
  // The page is that of the program that ran last, with its lines and the units of its configuration.
  CHECK_THAT(device.read("r.html"), Contains("QUICKLY TO 30") && !Contains("QUICKLY TO 10") &&
                                        Contains("EVERY 150ms DO MOVE") &&
                                        Contains(R"("name":"mm")"));
  CHECK(device.run({"monitor", "--duration", "100ms", "--record", program, "--upload", program})
            .exit == 2);
}

TEST_CASE("to write on a line that is closed is an error, and no signal that ends the tool") {
  const RobotFolder robot;
  const int listener = listen_at(robot.path("line"));
  const std::unique_ptr<tool::Transport> transport = tool::open_port("unix:" + robot.path("line"));
  close(accept(listener, nullptr, nullptr));
  close(listener);
  CHECK_THROWS_WITH(transport->write(std::array<std::byte, 1>{}), Contains("Broken pipe"));
}

TEST_CASE("a port whose owner takes nobody is exit 3, and says so") {
  const RobotFolder folder;
  const int listener = listen_at(folder.path("busy"));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  folder.path("busy").copy(address.sun_path, sizeof address.sun_path - 1);
  std::vector<int> waiting;
  do
    waiting.push_back(socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0));
  while (connect(waiting.back(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  const Outcome outcome = test::rsc({"info", "--port", "unix:" + folder.path("busy")});
  for (const int file : waiting)
    close(file);
  close(listener);
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("takes no more connections"));
}

TEST_CASE("the line may be TCP") {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  REQUIRE(bind(file, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  socklen_t length = sizeof address;
  getsockname(file, reinterpret_cast<sockaddr*>(&address), &length);
  REQUIRE(listen(file, 1) == 0);
  const Bridge bridge(file, true);
  const Outcome outcome =
      test::rsc({"info", "--port", "tcp:localhost:" + std::to_string(ntohs(address.sin_port))});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  const int same_below_65536 = ntohs(address.sin_port) + 65536;
  for (const std::string& wrong :
       {std::to_string(same_below_65536), std::string("0"), std::string("x")})
    CHECK(test::rsc({"info", "--port", "tcp:localhost:" + wrong}).exit == 2);
}

TEST_CASE("the line may be a pty") {
  const int master = open_pty_master();
  const std::string path = ptsname(master);
  const int kept_open = open(path.c_str(), O_RDWR | O_NOCTTY);  // or the master reads EIO
  termios raw{};
  tcgetattr(kept_open, &raw);
  cfmakeraw(&raw);
  tcsetattr(kept_open, TCSANOW, &raw);
  {
    const RobotFolder robot;
    const Bridge bridge(master, false);
    const Outcome outcome = test::rsc({"upload", robot.program, "--port", path});
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 0);
  }
  close(kept_open);
}

TEST_CASE("ports is valid JSON, whatever this computer has") {
  const Outcome outcome = test::rsc({"ports", "--format", "json"});
  CHECK(outcome.exit == 0);
  CHECK(json::parse(outcome.out).is_array());
}

TEST_CASE(
    "a line that another rsc uses and does not lend is exit 3, and says so, until that one ends") {
  const int master = open_pty_master();
  const std::string port = ptsname(master);
  const Bridge bridge(master, false);
  {
    const std::unique_ptr<tool::Transport> other = tool::open_port(port);
    const Outcome outcome = test::rsc({"info", "--port", port});
    CHECK(outcome.exit == 3);
    CHECK_THAT(outcome.err, Contains(port + ": another rsc uses this line; end it first"));
  }
  CHECK(test::rsc({"info", "--port", port}).exit == 0);
}

TEST_CASE("stop does not wait for another rsc that uses the line") {
  const int master = open_pty_master();
  const std::string port = ptsname(master);
  const Bridge bridge(master, false);
  {
    const std::unique_ptr<tool::Transport> other = tool::open_port(port);
    const Outcome outcome = test::rsc({"stop", "--port", port});
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 0);
  }
  CHECK_THAT(test::rsc({"info", "--port", port}).out,
             Contains("stopped   all outputs are in their safe state"));
}

TEST_CASE("monitor lends the line to an upload, and goes on with the new program") {
  const int master = open_pty_master();
  const std::string port = ptsname(master);
  const RobotFolder robot;
  const std::string ticking = robot.write("robot.rsl", "EVERY 100ms DO LOG \"tick\" END\n");
  const Bridge bridge(master, false);
  Outcome monitor;
  std::thread watching([&] {
    monitor = test::rsc({"monitor", "--port", port, "--duration", "2s"});
  });
  bridge.wait_until_heard();
  const Outcome upload = test::rsc({"upload", ticking, "--port", port});
  watching.join();
  CAPTURE(upload.err, monitor.err);
  CHECK(upload.exit == 0);
  CHECK(monitor.exit == 0);
  CHECK_THAT(monitor.err, Contains("another rsc has used the line for") &&
                              Contains(", and another program runs; what happened"));
  CHECK_THAT(monitor.out, Contains("log: tick"));
}

TEST_CASE("a monitor whose line is lent for its whole time ends without a word on it") {
  const int master = open_pty_master();
  const std::string port = ptsname(master);
  const Bridge bridge(master, false);
  Outcome monitor;
  std::thread watching([&] {
    monitor = test::rsc({"monitor", "--port", port, "--duration", "300ms"});
  });
  bridge.wait_until_heard();
  const std::unique_ptr<tool::Transport> other = tool::open_port(port);
  const std::size_t heard = bridge.bytes_heard();
  watching.join();
  CAPTURE(monitor.err);
  CHECK(monitor.exit == 0);
  CHECK(bridge.bytes_heard() == heard);
}
