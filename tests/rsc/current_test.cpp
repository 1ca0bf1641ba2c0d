// What holds on a robot is told to whoever comes later: the built rsc, and a robot in this process.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

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
