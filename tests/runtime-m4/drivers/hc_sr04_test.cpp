// The ultrasonic sensor: from the length of an echo to readings, when it is asked, and a sensor that does not answer.
#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Rig;

namespace {

const char* const kOfSonar = R"(
WHEN sonar DISTANCE < 50cm DO LOG "near" END
)";
const char* const kSafeSonar = R"(
SAFETY wall
  WHEN sonar DISTANCE < 20cm
  DO STOP arm
  RESUME WHEN sonar DISTANCE > 30cm
END
WHEN sonar DISTANCE < 50cm DO LOG "near" END
)";
const char* const kWithSonar = R"({
  "sensors": [{"name": "sonar", "type": "GPIO", "trigger": 7, "echo": 41, "device": "hc-sr04",
               "channels": {"DISTANCE": {"rate": "10Hz"}}}],
  "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo"}]})";
const char* const kWithout = R"({
  "sensors": [{"name": "sonar", "type": "VIRTUAL", "device": "hc-sr04"}],
  "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo"}]})";
constexpr std::uint32_t kOneMetre = 5831;  // us, there and back at 343 m/s

constexpr vm::Limits kEverything{};
using Pings = std::vector<std::pair<std::uint16_t, std::uint16_t>>;

// Records when it is asked and when it is sampled, in ms.
struct Robot {
  explicit Robot(const std::string& program = kOfSonar, const char* wiring = kWithSonar) {
    rig.board.echo_us = [this](std::uint16_t echo) {
      if (echo != 41 || rig.board.pings.empty()) return 0U;
      sampled.push_back(rig.kernel.now() / 1000);
      return length;
    };
    REQUIRE(rig.activate(test::compile(program, wiring)).ok());
  }
  std::vector<std::uint64_t> sampled;
  std::uint32_t length = kOneMetre;
  Rig rig;
};

}  // namespace

TEST_CASE("hc_sr04: a count is a microsecond; what is no echo from 2 cm to 4 m is no reading") {
  test::NotingBoard board;
  vm::Sensor sensor{};
  sensor.address = 41;
  std::int32_t raw = 0;
  const auto read = [&](std::uint32_t us) {
    board.echo_us = [=](std::uint16_t pin) { return pin == 41 ? us : 1000; };
    return drivers::driver(vm::DriverId::hc_sr04).read(board, sensor, {}, raw);
  };
  for (const std::uint32_t us : {100U, 117U, kOneMetre, 23'324U, 25'000U}) {
    REQUIRE(read(us));
    CHECK(raw == static_cast<std::int32_t>(us));
  }
  for (const std::uint32_t us : {0U, 1U, 99U, 25'001U, 38'000U, 0xFFFF'FFFFU})
    CHECK_FALSE(read(us));
}

TEST_CASE("hc_sr04: the reading is in centimetres, inside what the part measures") {
  for (const auto& [us, below, above] :
       {std::tuple{kOneMetre, 101, 99}, {102U, 3, 1}, {24'900U, 401, 399}}) {
    Robot robot("WHEN sonar DISTANCE < " + std::to_string(below) + "cm AND sonar DISTANCE > " +
                std::to_string(above) + "cm DO LOG \"it\" END\n");
    robot.length = us;
    robot.rig.run(250);
    CAPTURE(us);
    CHECK(robot.rig.only("log").find("it") != std::string::npos);
  }
}

TEST_CASE(
    "hc_sr04: it is asked 40 ms before each sample, and never sooner than 60 ms after the last "
    "time") {
  Robot robot;
  std::vector<std::uint64_t> asked;
  for (std::uint64_t ms = 1; ms < 400; ++ms) {
    const std::size_t before = robot.rig.board.pings.size();
    robot.rig.run(ms);
    if (robot.rig.board.pings.size() > before) asked.push_back(ms);
  }
  REQUIRE(asked.size() >= 3);
  CHECK(robot.rig.board.pings == Pings(asked.size(), {7, 41}));
  for (std::size_t i = 0; i < robot.sampled.size(); ++i) {
    CAPTURE(i);
    CHECK(robot.sampled[i] == 100 * (i + 1));
    CHECK(asked[i] - (100 * (i + 1) - 40) <= 1);
  }
}

TEST_CASE("hc_sr04: two channels of it are of one echo, for which it is asked once") {
  const std::string wiring = R"({
    "sensors": [{"name": "sonar", "type": "GPIO", "trigger": 7, "echo": 41, "device": "hc-sr04",
                 "channels": {"DISTANCE": {"rate": "10Hz"},
                              "ROUGHLY": {"input": 0, "unit": "m", "range": ["0m", "4m"], "scale": 0.0001715, "rate": "10Hz"}}}]})";
  Robot robot("WHEN sonar DISTANCE > 99cm AND sonar ROUGHLY > 0.9m DO LOG \"it\" END\n",
              wiring.c_str());
  robot.rig.run(450);
  CHECK(robot.rig.board.pings == Pings(4, {7, 41}));
  CHECK(robot.rig.only("log").find("it") != std::string::npos);
}

TEST_CASE("hc_sr04: a part that says nothing is unknown after a while, and SAFETY trips") {
  Robot robot(kSafeSonar);
  robot.rig.run(1000);
  CHECK(robot.rig.only("trip").empty());
  for (const std::uint32_t nothing : {0U, 38'000U}) {  // unplugged; nothing within 4 m
    Robot silent(kSafeSonar);
    silent.rig.run(1000);
    silent.length = nothing;
    silent.rig.run(1400);
    CHECK(silent.rig.only("trip").empty());  // 500 ms after the last one
    silent.rig.run(1620);
    CHECK(silent.rig.only("trip").find("trip r0") != std::string::npos);
    silent.length = kOneMetre;
    silent.rig.run(3000);
    CHECK(silent.rig.only("resume") != "");
  }
}

TEST_CASE("hc_sr04: SAFETY knows before anything moves, and near is near") {
  Robot robot(kSafeSonar);
  robot.length = 600;  // 10 cm
  robot.rig.run(500);
  CHECK(robot.rig.only("trip").find("trip r0") != std::string::npos);
}

TEST_CASE("hc_sr04: nobody's trigger gives a pulse, and a halt holds none back") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard guard(kernel, board);
  const auto with = test::compile(kOfSonar, kWithSonar),
             without = test::compile(kOfSonar, kWithout);
  vm::Image image;
  guard.ping(0);
  CHECK(board.pings.empty());
  REQUIRE(vm::verify(with, kEverything, image).ok());
  guard.begin_with(~guard::OutputGuard::Mask{0});
  guard.own(image);
  guard.ping(0);
  guard.ping(1);
  CHECK(board.pings == Pings{{7, 41}});
  const unsigned before = board.takes;
  vm::Image other;
  REQUIRE(vm::verify(without, kEverything, other).ok());
  guard.end_measurements();
  CHECK(board.takes == before + 1);  // what went on is over
  guard.ping(0);
  guard.own(other);
  guard.ping(0);
  guard.own(image);
  guard.disown();
  guard.ping(0);
  CHECK(board.pings.size() == 1);
}

TEST_CASE(
    "hc_sr04: a pin that the board does not let programs drive gets no pulse, whatever the image "
    "says") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  board.board_pins.outputs = board.board_pins.outputs.first(0);
  guard::OutputGuard guard(kernel, board);
  const auto bytes = test::compile(kOfSonar, kWithSonar);
  vm::Image image;
  REQUIRE(vm::verify(bytes, kEverything, image).ok());
  guard.own(image);
  guard.ping(0);
  CHECK(board.pings.empty());
}
