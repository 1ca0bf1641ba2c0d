// A drive that goes by the encoders of its wheels: with edges that the test says, and with the simulation's virtual wheels.
#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/sim/host_board.hpp"
#include "tests/runtime-m4/drivers/drive.hpp"
#include "tests/runtime-m4/drivers/wheels.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "vm/drive.hpp"

using namespace robosync;
using test::kOff;
using test::order;
using test::Pulses;
using vm::Action;
using vm::Param;
using vm::Value;

namespace counted_drive_test {
namespace {

constexpr Value kCentimetre = 10 * vm::kScale;
constexpr kernel::Time kSecond = 1'000'000;

// An edge each 0.5 cm. The left encoder is the program's second one.
struct Bench {
  explicit Bench(bool directions = true) {
    for (std::size_t s = 0; s < sensors.size(); ++s) {
      sensors[s].driver = vm::DriverId::encoder;
      sensors[s].bus = directions ? static_cast<std::uint8_t>(44 + s) : vm::kNoSecondPin;
      sensors[s].first_channel = static_cast<std::uint8_t>(s);
      sensors[s].channel_count = 1;
      channels[s].scale_num = 200'000;
      channels[s].scale_den = 40;
    }
    drive.driver = vm::DriverId::differential_drive;
    drive.min = -20'000 * kCentimetre;
    drive.max = 20'000 * kCentimetre;
    drive.speed_limit = vm::kValueMax;
    board.count_of = [this](unsigned number) { return counts[1 - number]; };
    vm::Image image;
    image.actuators = std::span(&drive, 1);
    image.constants = values;
    image.sensors = sensors;
    image.channels = channels;
    guard.own(image);
  }
  drivers::Device device() { return {guard, drive, state}; }
  Pulses begin(Action action, std::initializer_list<std::pair<Param, Value>> params = {}) {
    wake = driver.start(device(), order(action, params), now);
    return pulses();
  }
  // The wheels turn on by as many edges, and the driver is called when it wants to be.
  Pulses turn(std::int32_t left, std::int32_t right) {
    counts[0].edges += left;
    counts[1].edges += right;
    REQUIRE(wake > now);
    now = wake;
    wake = driver.advance(device(), now);
    return pulses();
  }
  // Until it ends, without edges; returns how long that takes.
  kernel::Duration wait() {
    const kernel::Time begun = now;
    while (wake > drivers::kBlocked)
      turn(0, 0);
    return now - begun;
  }
  Pulses pulses() const { return test::pulses_of(board); }
  Value position() const { return state.motion.at(now); }

  const drivers::Driver& driver = drivers::driver(vm::DriverId::differential_drive);
  vm::DriveValues values = vm::values_of({.pins = {3, 4, 5, 6},
                                          .trim = {100, 100},
                                          .encoders = {2, 1},
                                          .speed = 40 * kCentimetre,
                                          .track = 12 * kCentimetre,
                                          .usual = 20 * kCentimetre});
  std::array<vm::Sensor, 2> sensors{};
  std::array<vm::Channel, 2> channels{};
  vm::Actuator drive{};
  std::array<policy::EncoderCount, 2> counts{{{-17, 3}, {900, 0}}};  // left, right
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard guard{kernel, board};
  drivers::ActuatorState state;
  kernel::Time now = kSecond, wake = 0;
};

const char* const kRobot = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
              {"name": "left", "type": "GPIO", "device": "encoder", "pins": [40, 41], "pulses_per_turn": 20, "wheel": "65mm"},
              {"name": "right", "type": "GPIO", "device": "encoder", "pins": [42, 43], "pulses_per_turn": 20, "wheel": "65mm"}],
  "actuators": [{"name": "base", "type": "PWM", "device": "differential_drive", "left": [3, 4], "right": [5, 6],
                 "speed": "40cm/s", "track": "12cm", "encoders": ["left", "right"])";

std::string robot(const std::string& more = "") {
  return kRobot + more + "}]}";
}

}  // namespace

TEST_CASE("counted drive: it goes on until both wheels have counted their way") {
  Bench bench;
  CHECK(bench.begin(Action::move, {{Param::by, 10 * kCentimetre}, {Param::at, 10 * kCentimetre}}) ==
        Pulses{5000, 0, 5000, 0});
  for (unsigned i = 0; i < 19; ++i)
    CHECK(bench.turn(1, 1) == Pulses{5000, 0, 5000, 0});
  CHECK(bench.turn(0, 1) == Pulses{5000, 0, 0, 0});
  CHECK(bench.turn(0, 0) == Pulses{5000, 0, 0, 0});
  CHECK(bench.turn(1, 0) == kOff);
  CHECK(bench.wake == drivers::kDone);
  CHECK(bench.position() == 10 * kCentimetre);
}

TEST_CASE("counted drive: a way of less than half an edge moves nothing") {
  Bench bench;
  CHECK(bench.begin(Action::move, {{Param::by, 2 * vm::kScale}}) == kOff);
  CHECK(bench.turn(0, 0) == kOff);
  CHECK(bench.wake == drivers::kDone);
}

TEST_CASE("counted drive: a movement takes 20 ms at least, but its wheels go off at their edges") {
  Bench bench;
  const kernel::Time begun = bench.now;
  CHECK(bench.begin(Action::move, {{Param::by, 5 * vm::kScale}, {Param::at, 40 * kCentimetre}}) ==
        Pulses{20'000, 0, 20'000, 0});
  CHECK(bench.turn(1, 1) == kOff);
  CHECK(bench.now == begun + 5000);
  CHECK(bench.turn(0, 0) == kOff);
  CHECK(bench.wake == drivers::kDone);
  CHECK(bench.now >= begun + 20'000);
  CHECK(bench.position() == 5 * vm::kScale);
}

TEST_CASE("counted drive: the wheel that is ahead gets less power") {
  Bench bench;
  bench.begin(Action::move, {{Param::by, 100 * kCentimetre}});
  CHECK(bench.turn(1, 0) == Pulses{8000, 0, 10'000, 0});
  CHECK(bench.turn(0, 1) == Pulses{10'000, 0, 10'000, 0});
  CHECK(bench.turn(1, 4) == Pulses{10'000, 0, 7500, 0});
}

TEST_CASE("counted drive: backward and in a turn its encoders count backward") {
  Bench bench;
  CHECK(bench.begin(Action::move, {{Param::by, -2 * kCentimetre}}) == Pulses{0, 10'000, 0, 10'000});
  bench.turn(-3, -3);
  CHECK(bench.turn(-1, -1) == kOff);
  CHECK(bench.position() == -2 * kCentimetre);
  CHECK(
      bench.begin(Action::play, {{Param::by, 90 * vm::kScale}, {Param::direction, -kCentimetre}}) ==
      Pulses{0, 10'000, 10'000, 0});  // 9.42 cm
  CHECK(bench.turn(-18, 18) == Pulses{0, 10'000, 10'000, 0});
  CHECK(bench.turn(-1, 1) == kOff);
  CHECK(bench.wake == drivers::kDone);
  CHECK(bench.position() == -2 * kCentimetre);
  bench.begin(Action::move, {{Param::to, 0}});
  CHECK(bench.turn(4, 4) == kOff);
  CHECK(bench.position() == 0);

  Bench forward_only(false);
  forward_only.begin(Action::move, {{Param::by, -2 * kCentimetre}});
  CHECK(forward_only.turn(4, 4) == kOff);
  CHECK(forward_only.position() == -2 * kCentimetre);
}

TEST_CASE("counted drive: a wheel without edges ends it, and so do too many edges") {
  Bench bench;
  bench.begin(Action::move, {{Param::by, 100 * kCentimetre}});
  bench.turn(7, 6);
  const kernel::Duration took = bench.wait();
  CHECK(bench.wake == drivers::kBlocked);
  CHECK(bench.pulses() == kOff);
  CHECK(took >= 600'000);  // half a second, and four edges of 25 ms
  CHECK(took <= 620'000);
  CHECK(bench.position() == 32'500);  // 6.5 edges
  bench.begin(Action::play);
  bench.counts[1].losses = 1;
  CHECK(bench.turn(1, 1) == kOff);
  CHECK(bench.wake == drivers::kBlocked);
}

TEST_CASE(
    "counted drive: what is ordered for a time ends by timing, where its wheels have come to") {
  Bench bench;
  bench.begin(Action::move, {{Param::over, vm::kScale / 2}});
  for (unsigned i = 0; i < 24; ++i)
    CHECK(bench.turn(1, 1) == Pulses{10'000, 0, 10'000, 0});
  CHECK(bench.turn(0, 0) == kOff);
  CHECK(bench.wake == drivers::kDone);
  CHECK(bench.now == kSecond * 3 / 2);
  CHECK(bench.position() == 12 * kCentimetre);
}

TEST_CASE("counted drive: STOP and a halt end it where its wheels have come to") {
  Bench bench;
  bench.begin(Action::move, {{Param::by, 100 * kCentimetre}});
  bench.turn(5, 5);
  CHECK(bench.begin(Action::stop) == kOff);
  CHECK(bench.wake == drivers::kDone);
  CHECK(bench.position() == 25'000);
  bench.begin(Action::move, {{Param::by, 100 * kCentimetre}});
  bench.turn(5, 5);
  bench.guard.halt(1);
  CHECK(bench.pulses() == kOff);
  CHECK(bench.turn(1, 1) == kOff);  // a call that was under way
  bench.driver.release(bench.device(), vm::Release::coast, bench.now);
  CHECK(bench.position() == 55'000);
}

TEST_CASE(
    "counted drive: in a simulation the slower wheel decides, and the robot drives straight") {
  test::Robot robot("WHEN near X > 10 DO DRIVE base FORWARD 51.05cm AT 20cm/s END",
                    counted_drive_test::robot(R"(, "simulated_difference": "20%")"));
  robot.feed(100, "X", 20);
  robot.run(10'000);
  CHECK(robot.only("blocked").empty());
  const std::string done = robot.only("done");
  const unsigned ms = static_cast<unsigned>(std::stoul(done));
  // 100 edges of the right wheel at 16 cm/s take 3.19 s.
  CHECK(ms >= 100 + 3190);
  CHECK(ms <= 100 + 3190 + 6);
  // Without trim the left one would be 20 edges ahead when it ends, at 2.55 s.
  INFO(robot.only("input"));
  const auto told = [&](const std::string& distance) {
    return std::ranges::count_if(robot.lines(), [&](const std::string& line) {
      return line.ends_with(" input DISTANCE " + distance);
    });
  };
  CHECK(told("510.510") == 2);
  CHECK(told("515.615") == 0);
}

// Its wheels turn when the test says so.
struct Program {
  explicit Program(const std::string& body) {
    static constexpr std::array<policy::PinRange, 1> kAny{{{40, 44}}};
    rig.board.board_pins.inputs = kAny;
    rig.board.board_pins.echoes = kAny;
    rig.board.edges_of = [](unsigned, std::uint16_t, std::uint8_t, unsigned,
                            boards::Turned& turned) {
      turned = {};
      return true;
    };
    rig.board.count_of = [this](unsigned) { return count; };
    test::do_at_20_ms(rig, body, robot());
  }
  Pulses at(unsigned ms) { return test::pulses_at(rig, ms); }
  // An edge of both wheels each 50 ms.
  Pulses turn_until(unsigned ms) {
    Pulses pulses{};
    for (auto now = static_cast<unsigned>(rig.kernel.now() / 1000); now < ms;) {
      ++count.edges;
      pulses = at(now = std::min(now + 50, ms));
    }
    return pulses;
  }
  policy::EncoderCount count;
  test::Rig rig;
};

TEST_CASE(
    "counted drive: a blocked one is reported, what waits behind it is dropped, and its response "
    "ends") {
  Program program("DRIVE base FORWARD 20cm\nTURN base LEFT 90deg\nTHEN\nLOG \"over\"");
  CHECK(program.at(600) == Pulses{10'000, 0, 10'000, 0});
  CHECK(program.at(650) == kOff);
  CHECK(program.at(2000) == kOff);
  const test::Rig& rig = program.rig;
  CHECK(rig.only("blocked").find("blocked base") != std::string::npos);
  CHECK(rig.only("cancel").find("cancel base") != std::string::npos);
  CHECK(rig.only("done").empty());
  CHECK(rig.only("log").find("over") != std::string::npos);
  CHECK(rig.only("finished") != "");
}

TEST_CASE("counted drive: in the middle of a movement SAFETY turns it off, and nothing goes on") {
  Program program("DRIVE base FORWARD 20cm\nDRIVE base FORWARD 5cm");
  CHECK(program.turn_until(500) == Pulses{10'000, 0, 10'000, 0});
  program.rig.feed(0, 95, 500);
  CHECK(program.at(500) == kOff);
  CHECK(program.turn_until(3000) == kOff);
  CHECK(program.rig.only("blocked done").empty());
  program.rig.feed(0, 4, 3000);  // the rule lets it go
  CHECK(program.turn_until(4000) == kOff);
  program.rig.feed(0, 20, 4000);
  CHECK(program.at(4010) == Pulses{10'000, 0, 10'000, 0});  // from here on, not from where it was
  CHECK(program.turn_until(4500) == Pulses{10'000, 0, 10'000, 0});
  program.turn_until(10'000);
  CHECK(program.rig.only("blocked").empty());
  CHECK(program.at(10'000) == kOff);
}

TEST_CASE("counted drive: a person's stop in the middle of a movement holds until the resume") {
  Program program("DRIVE base FORWARD 20cm");
  CHECK(program.turn_until(500) == Pulses{10'000, 0, 10'000, 0});
  program.rig.runtime.stop();
  CHECK(program.at(500) == kOff);
  CHECK(program.turn_until(3000) == kOff);
  program.rig.runtime.resume();
  CHECK(program.turn_until(5000) == kOff);
  CHECK(program.rig.only("blocked done").empty());
}

TEST_CASE("counted drive: LIMIT holds for its wheels, and so do the trims") {
  for (const auto& [limit, pulse] : {std::pair{"4cm/s", 2000U}, {"10cm/s", 5000U}}) {
    test::Robot robot("LIMIT base SPEED TO " + std::string(limit) +
                          "\nWHEN near X > 10 DO DRIVE base FORWARD 20cm END",
                      counted_drive_test::robot());
    robot.feed(100, "X", 20);
    robot.run(10'000);
    // 39 edges of 5.105 mm of the slower wheel, 4 % slower than that.
    const unsigned ms = static_cast<unsigned>(std::stoul(robot.only("done")));
    const double takes = 39 * 204.2 / 40 / (pulse / 20'000.0 * 400 * 0.96) * 1000;
    CHECK(ms >= 100 + takes);
    CHECK(ms <= 100 + takes + 30);
  }
}

TEST_CASE("counted drive: a wheel that rocks to and fro ends it") {
  Bench bench;
  bench.begin(Action::move, {{Param::by, 100 * kCentimetre}});
  const kernel::Time begun = bench.now;
  for (std::int32_t rock = 1; bench.wake > drivers::kBlocked; rock = -rock)
    bench.turn(rock, 1);
  CHECK(bench.wake == drivers::kBlocked);
  CHECK(bench.now - begun <= 700'000);
  CHECK(bench.pulses() == kOff);
}

TEST_CASE(
    "counted drive: virtual wheels turn backward, if their encoders know it, and have a speed") {
  const std::string program = R"(
WHEN near X > 10 DO DRIVE base BACKWARD 51.05cm AT 20cm/s END
WHEN left SPEED < -19cm/s DO LOG "back" END
WHEN left SPEED > 19cm/s DO LOG "ahead" END
WHEN left SPEED < -21cm/s OR left SPEED > 21cm/s DO LOG "fast" END
)";
  const std::string one_pin = [] {
    std::string json = counted_drive_test::robot(R"(, "simulated_difference": "0%")");
    json.replace(json.find(R"("pins": [40, 41])"), 16, R"("pin": 40)");
    return json;
  }();
  for (const bool knows : {true, false}) {
    test::Robot robot(program, knows ? counted_drive_test::robot() : one_pin);
    robot.feed(100, "X", 20);
    robot.run(10'000);
    CHECK(robot.only("blocked").empty());
    CHECK(robot.only("done") != "");
    CHECK((robot.only("log").find("back") != std::string::npos) == knows);
    CHECK((robot.only("log").find("ahead") != std::string::npos) == !knows);
    CHECK(robot.only("log").find("fast") == std::string::npos);
  }
}

TEST_CASE("counted drive: nothing of a program's wheels is left for the next one") {
  Bench bench;
  kernel::Kernel kernel;
  sim::HostBoard board;
  guard::OutputGuard guard(kernel, board);
  vm::Image image;
  image.actuators = std::span(&bench.drive, 1);
  image.constants = bench.values;
  image.sensors = bench.sensors;
  image.channels = bench.channels;
  guard.own(image);
  CHECK(board.wheels()->is_on(0));
  CHECK(guard.counted_drive() != nullptr);
  guard.disown();
  CHECK_FALSE(board.wheels()->is_on(0));
  CHECK(guard.counted_drive() == nullptr);
}

}  // namespace counted_drive_test
