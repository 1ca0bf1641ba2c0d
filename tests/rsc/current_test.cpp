// What holds on a robot is told to whoever comes later: the built rsc, and a robot in this process.
#include "rsc/device/current.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "rsc/device/uploader.hpp"
#include "tests/rsc/device.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Device;

TEST_CASE("what is tripped, halted and stopped is told to who comes later") {
  const Device device;
  const std::string guarded = device.write(
      "guarded.rsl",
      "SAFETY far\n  WHEN touch LEVEL > 8\n  DO STOP left_arm\n  RESUME WHEN touch "
      "LEVEL < 3\nEND\nWHEN touch LEVEL < 3 DO\n  MOVE left_arm SLOWLY TO 90deg\nEND\n");
  REQUIRE(device.run({"feed", "touch.LEVEL=1", "--upload", guarded}).exit == 0);
  const auto state = [&] {
    return json::parse(device.run({"info", "--format", "json"}).out).at("state");
  };
  const auto lines = [&](const std::string& format) {
    return device.run({"monitor", "--duration", "200ms", "--format", format}).out;
  };
  CHECK(state() == json::parse(R"({"stopped": false, "tripped": [], "halted": []})"));
  CHECK_THAT(device.run({"info"}).out, !Contains("tripped"));
  CHECK_THAT(lines("human"), !Contains("tripped"));
  CHECK_THAT(lines("json"), !Contains("\"state\""));

  REQUIRE(device.run({"feed", "touch.LEVEL=9", "--watch", "200ms"}).exit == 0);
  CHECK(state() == json::parse(R"({"stopped": false, "tripped": [{"rule": 0, "line": 1}],
                                   "halted": ["left_arm"]})"));
  CHECK_THAT(device.run({"info"}).out,
             Contains("tripped   safety rule at line 1\n") && Contains("halted    left_arm\n"));
  CHECK_THAT(lines("human"), Contains("      tripped  safety rule at line 1\n") &&
                                 Contains("       halted  left_arm\n"));
  CHECK_THAT(lines("json"), Contains(R"("tripped":[{"rule":0,"line":1}])"));

  REQUIRE(device.run({"stop"}).exit == 0);
  CHECK(state().at("stopped") == true);
  CHECK_THAT(lines("human"), Contains("      stopped  all outputs are in their safe state"));
  REQUIRE(device.run({"resume"}).exit == 0);
  REQUIRE(device.run({"feed", "touch.LEVEL=1", "--watch", "200ms"}).exit == 0);
  CHECK(state() == json::parse(R"({"stopped": false, "tripped": [], "halted": []})"));
}

TEST_CASE(
    "the values that are known are told as events, also those that one answer has no room for") {
  test::Robot robot;
  tool::Client client(robot);
  constexpr int kMany = 31, kChanged = 20;
  std::string text =
      "TIMER since\n";  // with it and the channel one more than an answer has room for
  for (int i = 0; i < kMany; ++i)
    text += "REMEMBER v" + std::to_string(i) + " = " + std::to_string(i) + "\n";
  text += "WHEN touch LEVEL > 5 DO\n";
  for (int i = 0; i < kChanged; ++i)
    text += "  SET v" + std::to_string(i) + " TO v" + std::to_string(i) + " + 1\n";
  const tool::Program program = test::compile(text + "  RESTART since\nEND\n");
  const vm::Image& image = program.image();
  const link::ActivateResult activation =
      tool::upload(client, client.hello(), program.bytes(), {}).activation;
  CAPTURE(activation.refusal, activation.section, activation.index);
  REQUIRE(activation.running == 1);
  robot.run(50);
  CHECK(tool::current_of(client, nullptr).events.empty());
  CHECK(tool::current_of(client, &image).events.size() == kMany);  // touch is unknown

  REQUIRE(client.feed({.channel = 0, .at_us = 0, .value = 6000}).error == link::FeedError::none);
  robot.run(50);
  const tool::Current now = tool::current_of(client, &image);
  REQUIRE(now.events.size() == 1 + kMany);
  CHECK(now.events.front().kind == link::EventKind::input);
  CHECK(now.events.front().subject == 0);
  CHECK(now.events.front().values[0] == 6000);
  for (std::size_t i = 1; i < now.events.size(); ++i) {
    const link::Event& event = now.events[i];
    const std::string name(image.string(image.variables[event.subject].name));
    CAPTURE(name);
    CHECK(event.kind == link::EventKind::set);
    const int number = std::stoi(name.substr(1));
    CHECK(event.values[0] == 1000 * (number < kChanged ? number + 1 : number));
    CHECK(event.time_us >= 50'000);
    CHECK(event.time_us <= client.status().program_us);
  }
}

TEST_CASE("monitor tells what has tripped while its line was lent") {
  const int master = test::open_pty_master();
  const std::string port = ptsname(master);
  const test::RobotFolder robot;
  const std::string guarded =
      robot.write("robot.rsl", "SAFETY far\n  WHEN touch LEVEL > 8\n  DO STOP left_arm\nEND\n");
  const test::Bridge bridge(master, false);
  REQUIRE(test::rsc({"feed", "touch.LEVEL=2", "--upload", guarded, "--port", port}).exit == 0);
  const std::size_t heard = bridge.bytes_heard();
  test::Outcome monitor;
  std::thread watching([&] {
    monitor = test::rsc({"monitor", "--port", port, "--duration", "2s"});
  });
  while (bridge.bytes_heard() == heard)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const test::Outcome fed =
      test::rsc({"feed", "touch.LEVEL=9", "--watch", "200ms", "--port", port});
  watching.join();
  CAPTURE(fed.err, monitor.err);
  CHECK(fed.exit == 0);
  CHECK_THAT(monitor.err, Contains("another rsc has used the line for"));
  CHECK_THAT(monitor.out, Contains("      tripped  safety rule at line 1\n"));
}
