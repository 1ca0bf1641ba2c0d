// Response times of whole programs: against a simulation of their task sets, and what
// `rsc check --timing` says of those that the board cannot keep up with.
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/bus_load.hpp"
#include "analysis/report.hpp"
#include "analysis/step_work.hpp"
#include "analysis/task_set.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/board.hpp"
#include "runtime-m4/policy/link_share.hpp"
#include "tests/analysis/simulation.hpp"
#include "tests/rsc/process.hpp"
#include "tests/timing/programs.hpp"

using namespace robosync;
using analysis::Instructions;
using Catch::Contains;

namespace {

const char* const kRobot = R"({
  "sensors": [
    {"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
     "channels": {"LEVEL": {"input": 0, "range": [0, 10], "rate": "RATE"}}}
  ],
  "actuators": [{"name": "arm", "type": "PWM", "pin": "10", "device": "servo", "range": ["0deg", "90deg"]}]
})";

const char* const kProgram = R"(WHEN touch LEVEL > 3
DO
  MOVE arm QUICKLY
END
)";

// A robot whose sensor is read at this rate.
struct Robot : test::Folder {
  explicit Robot(const std::string& rate, const std::string& program = kProgram)
      : file(write("robot.rsl", program)) {
    std::string robot = kRobot;
    robot.replace(robot.find("RATE"), 4, rate);
    write("robot.json", robot);
  }
  std::string file;
};

const policy::BoardCosts& costs_of_board(std::string_view name) {
  const auto names = compiler::board_names();
  const auto place = std::ranges::find(names, name);
  REQUIRE(place != names.end());
  return tool::costs_of(compiler::board_at(static_cast<std::size_t>(place - names.begin())));
}

// Of the board that an example is for.
const policy::BoardCosts& costs_for(const std::filesystem::path& example) {
  const std::string robot = testing::read_file(example / "robot.json");
  for (const std::string_view name : compiler::board_names())
    if (robot.find("\"board\": \"" + std::string(name)) != std::string::npos)
      return costs_of_board(name);
  return tool::board_costs();
}

}  // namespace

TEST_CASE("examples: no simulated release takes longer than is printed") {
  std::mt19937 random(5);  // one of the seeds with which a rule that cools down would fire again
  for (const auto& entry : std::filesystem::directory_iterator(test::kRoot / "examples")) {
    const std::string file = "examples/" + entry.path().filename().string() + "/robot.rsl";
    if (!std::filesystem::exists(test::kRoot / file)) continue;
    INFO(file);
    const tool::Program program = test::compile_example(file);
    const policy::BoardCosts& board = costs_for(entry.path());
    const analysis::TaskSet set = analysis::task_set_of(program.image(), board, tool::module_cost);
    CHECK(analysis::response_report(program.image(), board, tool::module_cost).schedulable());
    for (unsigned p = 0; p < 100; ++p) {
      test::Pattern pattern;
      for (const analysis::Source& source : set.sources)
        pattern.first.push_back(source.follows == analysis::Source::kNone ? 1 + random() % 20'000
                                                                          : ~test::Time{0});
      for (const analysis::Interference& one : set.interferences)
        pattern.interference_first.push_back(1 + random() % one.period);
      pattern.behaviors_begin = 2'000;
      pattern.follow_delay = 16'000;
      const auto seen = test::simulate(set, pattern, 1'000'000, random);
      for (std::size_t s = 0; s < seen.size(); ++s) {
        const analysis::ResponseTime said =
            analysis::response_time_of(set, s, analysis::Priorities::base);
        if (said.bounded) CHECK(seen[s] <= said.time);
      }
    }
  }
}

TEST_CASE("adapted priorities make nothing shorter") {
  const tool::Program program = test::compile_example("examples/tickle_companion/robot.rsl");
  const analysis::ResponseReport report =
      analysis::response_report(program.image(), tool::board_costs(), tool::module_cost, 99);
  REQUIRE_FALSE(report.paths.empty());
  for (const analysis::PathTiming& path : report.paths)
    CHECK((!path.adapted.bounded || path.adapted.time >= path.base.time));
}

TEST_CASE("adapted priorities: robot.json says so, and each path is told for both") {
  std::string robot = kRobot;
  robot.replace(robot.find("RATE"), 4, "50Hz");
  robot.insert(robot.find('{') + 1, R"("scheduler": {"alpha": 2, "window": "1s", "cap": 90},)");
  test::Folder folder;
  folder.write("robot.json", robot);
  const test::Outcome outcome =
      test::rsc({"check", "--timing", folder.write("robot.rsl", kProgram)});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("touch -> arm") && Contains("adapted to P_max"));
}

TEST_CASE("check: algorithms take memory and time, and who asks for too much is refused") {
  const auto check = [](int count, const std::string& more) {
    test::Folder folder;
    std::string algorithms;
    std::string program;
    for (int i = 0; i < count; ++i) {
      const std::string name = "skin" + std::to_string(i);
      algorithms += std::string(i == 0 ? "" : ",") + R"({"name": ")" + name +
                    R"(", "module": "touch_levels", "input": "pad")" + more + "}";
      program += "WHEN " + name + " TOUCH IS tap\nDO MOVE a\nEND\n";
    }
    folder.write("robot.json",
                 R"({"sensors": [{"name": "pad", "type": "VIRTUAL", "channels": {"FORCE": {}}}],
    "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}],
    "algorithms": [)" +
                     algorithms + "]}");
    return test::rsc({"check", "--timing", folder.write("robot.rsl", program)});
  };
  const test::Outcome one = check(1, "");
  CHECK_THAT(one.out,
             Contains("algorithms          1136 of 114688 bytes") && Contains("skin0 -> a"));
  CHECK_THAT(check(2, "").out, Contains("algorithms          2272 of 114688 bytes"));
  CHECK(check(2, R"(, "rate": "500Hz")").exit == 0);
  const test::Outcome fast = check(8, R"(, "rate": "500Hz")");
  CHECK(fast.exit == 1);
  CHECK_THAT(fast.err, Contains("E0412") && Contains("for skin0") && Contains("lower rate"));
}

TEST_CASE("check: a sensor that is read too often is refused, and why") {
  const Robot slow("50Hz");
  const test::Outcome good = test::rsc({"check", "--timing", slow.file});
  CHECK(good.exit == 0);
  CHECK_THAT(good.out, Contains("touch -> arm") && Contains("processor, in total"));

  const Robot fast("1000Hz");
  const auto check_says = [](const std::string& text) {
    CHECK_THAT(text, Contains("E0412") && Contains("the board cannot keep up") &&
                         Contains("touch -> arm takes up to") && Contains("for touch") &&
                         Contains("robot.rsl:1:1") && Contains("lower rate"));
  };
  const test::Outcome bad = test::rsc({"check", fast.file});
  CHECK(bad.exit == 1);
  check_says(bad.err);
  const test::Outcome with_table = test::rsc({"check", "--timing", fast.file});
  CHECK(with_table.exit == 1);
  check_says(with_table.err);
  CHECK_THAT(with_table.out, Contains("processor, in total"));
}

TEST_CASE("check: more than an I2C bus carries at once is refused, where it is asked ahead") {
  const auto robot_of = [](const std::string& board, int inputs) {
    std::string channels;
    for (int i = 0; i < inputs; ++i)
      channels += fmt::format(R"({}"C{}": {{"input": {}}})", i == 0 ? "" : ", ", i, i);
    return R"({"board": ")" + board + R"(", "actuators": [],
  "sensors": [
    {"name": "imu", "type": "I2C", "address": "0x6a", "device": "lsm6dsl",
     "channels": {"STRENGTH": {}, "TURN_Z": {}}},
    {"name": "pads", "type": "I2C", "address": "0x70", "device": "max34451",
     "channels": {)" +
           channels + "}}]}";
  };
  const auto program_of = [](int inputs) {
    std::string program = "WHEN imu STRENGTH > 2g OR imu TURN_Z > 9deg/s DO LOG \"moved\" END\n";
    for (int i = 0; i < inputs; ++i)
      program += fmt::format("WHEN pads C{} > 3 DO LOG \"{}\" END\n", i, i);
    return program;
  };
  const auto check = [&](const std::string& board, int inputs) {
    const test::Folder folder;
    folder.write("robot.json", robot_of(board, inputs));
    return test::rsc({"check", folder.write("robot.rsl", program_of(inputs))});
  };
  for (const std::string board : {"b-l475e-iot01a", "microbit-v2"}) {
    const test::Outcome fits = check(board, 8);
    CAPTURE(board, fits.err);
    CHECK(fits.exit == 0);
    const test::Outcome refused = check(board, 9);
    CHECK(refused.exit == 1);
    CHECK_THAT(refused.err, Contains("error[E0412]") && Contains("I2C bus 0 needs 2.98 ms") &&
                                Contains("and has 2.90 ms") && Contains("robot.json:5") &&
                                Contains("imu 0.71 ms, pads 2.27 ms"));
  }
  // The reference board's bus is slower, and is asked earlier.
  CHECK(check("mps2-an386", 1).exit == 0);
  const test::Outcome slow = check("mps2-an386", 2);
  CHECK(slow.exit == 1);
  CHECK_THAT(slow.err, Contains("I2C bus 0 needs 3.9") && Contains("and has 3.79 ms") &&
                           Contains("imu 2.4") && Contains("pads 1.54 ms"));

  // An image that was compiled nevertheless.
  const test::Folder folder;
  folder.write("robot.json", robot_of("b-l475e-iot01a", 12));
  const std::string program = folder.write("robot.rsl", program_of(12));
  const std::string image = folder.path("robot.rsb");
  REQUIRE(test::rsc({"compile", program, "-o", image, "--anyway"}).exit == 0);
  const test::Outcome upload = test::rsc({"upload", image, "--port", folder.path("none")});
  CHECK(upload.exit == 1);
  CHECK_THAT(upload.err, Contains("I2C bus 0") && Contains("--anyway"));
}

TEST_CASE("an SPI bus and an I2C bus of the same number carry their sensors apart") {
  const policy::BoardCosts& board = costs_of_board("microbit-v2");
  std::vector<vm::Sensor> sensors(8);
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    sensors[s].driver = s < 4 ? vm::DriverId::lsm6dsl : vm::DriverId::mcp3008;
    sensors[s].channel_count = s < 4 ? 7 : 8;
    sensors[s].period_ms = 20;
  }
  vm::Image image;
  image.sensors = sensors;
  CHECK(analysis::overloaded_buses(image, board).empty());
  for (vm::Sensor& sensor : sensors)
    sensor.period_ms = 1;
  const auto loads = analysis::overloaded_buses(image, board);
  REQUIRE(loads.size() == 2);
  CHECK((!loads[0].spi && loads[1].spi));
  CHECK(loads[1].us == 4 * 3 * 8 * (board.spi_transfer_us + 3 * board.spi_byte_us));
}

TEST_CASE("all the sensors on the B-L475E-IOT01A at once are not too much for their bus") {
  const test::Folder folder;
  folder.write("robot.json", R"({"board": "b-l475e-iot01a", "sensors": [
    {"name": "moved", "device": "motion"}, {"name": "front", "device": "distance"},
    {"name": "air", "device": "climate"}]})");
  const test::Outcome all = test::rsc(
      {"check",
       folder.write("robot.rsl",
                    "WHEN moved STRENGTH > 2g OR front DISTANCE < 20cm DO LOG \"a\" END\n"
                    "WHEN air HUMIDITY > 60% OR air TEMPERATURE > 30C DO LOG \"b\" END\n")});
  CAPTURE(all.err);
  CHECK(all.exit == 0);
}

TEST_CASE(
    "what a bus carries counts for each of its sensors: as often as it is asked, once for what is "
    "shared") {
  // Microseconds of one of so many like it; 0: their bus carries them.
  const auto us_of = [](const policy::BoardCosts& board, unsigned count, vm::DriverId driver,
                        std::uint8_t channels, std::uint16_t period_ms) {
    vm::Sensor sensor{};
    sensor.driver = driver;
    sensor.channel_count = channels;
    sensor.period_ms = period_ms;
    const std::vector<vm::Sensor> sensors(count, sensor);
    vm::Image image;
    image.sensors = sensors;
    const auto loads = analysis::overloaded_buses(image, board);
    return loads.empty() ? 0U : loads.front().shares.front().us;
  };
  for (const std::string_view name : {"b-l475e-iot01a", "microbit-v2"}) {
    const policy::BoardCosts& board = costs_of_board(name);
    const auto us = [&](unsigned transfers, unsigned bytes) {
      return transfers * board.i2c_transfer_us + bytes * board.i2c_byte_us;
    };
    using enum vm::DriverId;
    CHECK(us_of(board, 20, lsm6dsl, 1, 20) == us(3, 26));
    CHECK(us_of(board, 20, lsm6dsl, 7, 20) == us(3, 26));
    for (const auto& [period_ms, times] : {std::pair{20, 1}, {3, 1}, {2, 2}, {1, 3}})
      CHECK(us_of(board, 20, i2c_register, 7, static_cast<std::uint16_t>(period_ms)) ==
            static_cast<unsigned>(times) * 7 * us(1, 5));
    CHECK(us_of(board, 20, ssd1306, 0, 50) == us(1, 20));
    CHECK(us_of(board, 20, vl53l0x, 1, 50) == us(4, 27));
    CHECK(us_of(board, 20, hts221, 2, 200) == us(4, 41));
    const unsigned of_part = board.spi_transfer_us + 3 * board.spi_byte_us;
    CHECK(us_of(board, 20, mcp3008, 8, 20) == 8 * of_part);
    CHECK(us_of(board, 4, mcp3008, 8, 20) == 0);  // as many channels as a program can have
    CHECK(us_of(board, 20, digital_input, 1, 20) == 0);
    CHECK(us_of(board, 4, lsm6dsl, 7, 20) == 0);
    CHECK(us_of(board, 5, lsm6dsl, 7, 20) != 0);
    // As docs/boards.md says.
    CHECK(us_of(board, 3, mpu6050, 7, 20) == 0);
    CHECK(us_of(board, 4, mpu6050, 7, 20) != 0);
    CHECK(us_of(board, 1, max34451, 11, 20) == 0);
    CHECK(us_of(board, 1, max34451, 12, 20) != 0);
  }
  // … and of the reference board, which asks earlier.
  const policy::BoardCosts& reference = costs_of_board("mps2-an386");
  using enum vm::DriverId;
  CHECK(us_of(reference, 1, hts221, 2, 200) == 0);
  CHECK(us_of(reference, 1, mpu6050, 7, 20) == 0);
  CHECK(us_of(reference, 2, mpu6050, 7, 20) != 0);
  CHECK(us_of(reference, 1, max34451, 4, 20) == 0);
  CHECK(us_of(reference, 1, max34451, 5, 20) != 0);
}

TEST_CASE("a rule that starves the board is refused by check, compile and upload") {
  const Robot robot("50Hz",
                    "REMEMBER n = 0\nEVERY 1ms DO\n  REPEAT 1500 TIMES\n    SET n TO n + 1\n  END\n"
                    "  MOVE arm QUICKLY\nEND\n");
  const std::string image = robot.path("robot.rsb");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"check", robot.file},
        {"compile", robot.file, "-o", image},
        {"upload", robot.file, "--port", robot.path("none")}}) {
    const test::Outcome outcome = test::rsc(arguments);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("E0412") && Contains("robot.rsl:2:1"));
  }
  CHECK_FALSE(robot.has("robot.rsb"));

  REQUIRE(test::rsc({"compile", robot.file, "-o", image, "--anyway"}).exit == 0);
  test::Outcome upload = test::rsc({"upload", image, "--port", robot.path("none")});
  CHECK(upload.exit == 1);
  CHECK_THAT(upload.err, Contains("the board cannot keep up") && Contains("--anyway"));
  for (const std::string& file : {image, robot.file}) {
    upload = test::rsc({"upload", file, "--port", robot.path("none"), "--anyway"});
    CHECK(upload.exit == 3);  // only the port is missing
  }
}

TEST_CASE(
    "a rule fires at a moment once, whatever else it asks for, unless it also fires without it") {
  struct Case {
    std::string condition;
    bool alternates, fires_after;
  };
  const std::vector<Case> cases{
      {"m BECOMES b", true, false},
      {"n IS b AND m BECOMES b", true, false},
      {"m BECOMES b AND n IS b AND touch LEVEL > 3", true, false},
      {"(m BECOMES b AND touch LEVEL > 3) OR (n BECOMES b AND touch LEVEL < 1)", false, false},
      {"n IS b OR m BECOMES b", false, true},
      {"NOT (m BECOMES b)", false, true},
      {"n IS b AND touch LEVEL CHANGES", false, false},
  };
  for (const Case& one : cases) {
    CAPTURE(one.condition);
    const tool::Program program = test::compile_with_docs_robot(
        "STATE m: a, b\nSTATE n: a, b\nWHEN " + one.condition +
        " DO\n  LOG \"now\"\nEND\nEVERY 1s DO\n  SET m TO b\n  SET n TO b\nEND\n");
    const analysis::StepWork work(program.image());
    const unsigned rule = program.image().rules[0].kind == vm::RuleKind::when ? 0 : 1;
    REQUIRE(work.has_events(rule));
    CHECK(work.alternates(rule) == one.alternates);
    CHECK(work.fires_after_event(rule) == one.fires_after);
  }
}

TEST_CASE("a program that may leave the link nothing waits for it, and only such a one") {
  const auto link_of = [](const std::string& file) {
    const tool::Program program = test::compile_example(file);
    return analysis::task_set_of(program.image(), tool::board_costs(), tool::module_cost);
  };
  const auto turn_of = [](const analysis::TaskSet& set) {
    return std::ranges::find(set.interferences, "the link's turns", &analysis::Interference::name);
  };
  const analysis::TaskSet light = link_of("examples/paper/robot.rsl");
  CHECK(turn_of(light) == light.interferences.end());

  const auto heavy = [&](unsigned rounds) {
    const tool::Program program = test::compile_with_docs_robot(
        "REMEMBER n = 0\nEVERY 7ms DO\n  REPEAT " + std::to_string(rounds) +
        " TIMES\n    SET n TO n + 1\n  END\nEND\n");
    return analysis::task_set_of(program.image(), tool::board_costs(), tool::module_cost);
  };
  const analysis::TaskSet some = heavy(200);
  CHECK(turn_of(some) == some.interferences.end());
  const analysis::TaskSet much = heavy(3800);
  REQUIRE(turn_of(much) != much.interferences.end());
  const Instructions ms = tool::board_costs().instructions_per_ms();
  CHECK(turn_of(much)->period == ms);
  CHECK(turn_of(much)->cost == (ms + policy::kLinkParts - 1) / policy::kLinkParts);
  CHECK(std::next(turn_of(much))->cost == policy::kLinkTurnMs * ms);
}

TEST_CASE("what actuators are told takes its time, in programs that have them") {
  const auto set_with = [](const std::string& actuator) {
    const std::string robot =
        R"({"board": "microbit-v2", "sensors": [{"name": "a", "device": "button_a"}],
      "actuators": [{"name": "it", )" +
        actuator + "}]}";
    const tool::Program program = test::as_program(compiler::compile(
        {"robot.rsl", "WHEN a IS pressed DO\n  STOP it\nEND\n"}, {"robot.json", robot}));
    return analysis::task_set_of(program.image(), costs_of_board("microbit-v2"), tool::module_cost);
  };
  const auto cost_of = [](const analysis::TaskSet& set, const char* name) -> Instructions {
    const auto found = std::ranges::find(set.interferences, name, &analysis::Interference::name);
    return found == set.interferences.end() ? 0 : found->cost;
  };
  const policy::BoardCosts& board = costs_of_board("microbit-v2");
  CHECK(cost_of(set_with(R"("type": "GPIO", "pin": 0, "device": "ws2812")"), "the panel") ==
        board.panel);
  CHECK(cost_of(set_with(R"("type": "GPIO", "pin": 0, "device": "ws2812_strip", "lights": 8)"),
                "the strip of lights") == board.strip);
  CHECK(cost_of(set_with(R"("device": "lights")"), "the lights") == board.row);
  CHECK(cost_of(set_with(R"("type": "UART", "bus": 1, "device": "dfplayer")"),
                "the sound player") == board.say);
  const analysis::TaskSet shown = set_with(R"("type": "VIRTUAL", "device": "ws2812")");
  for (const char* const name : {"the panel", "the lights", "the sound player"})
    CHECK(cost_of(shown, name) == 0);
}

TEST_CASE("a program that is late on one path though the processor has time") {
  // Two steps that take long, seldom: the touch is answered after its next reading.
  const Robot robot("200Hz",
                    "REMEMBER n = 0\nEVERY 1s DO\n  REPEAT 3500 TIMES\n    SET n TO n + 1\n  END\n"
                    "END\n" +
                        std::string(kProgram));
  const test::Outcome outcome = test::rsc({"check", robot.file});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("touch -> arm takes up to") &&
                              Contains("the next reading may come after 5000 us") &&
                              Contains("the rule at line 2"));
}

TEST_CASE(
    "a TIMER comes round as seldom as it is asked for; each millisecond where that is worked out") {
  const auto period_ms = [](const std::string& condition) {
    const tool::Program program =
        test::compile_with_docs_robot("TIMER idle\nREMEMBER n = 5s\nWHEN " + condition +
                                      " DO\n  RESTART idle\n  SET n TO idle\nEND\n");
    const policy::BoardCosts& board = tool::board_costs();
    const analysis::TaskSet set = analysis::task_set_of(program.image(), board, tool::module_cost);
    const auto timer = std::ranges::find_if(set.sources, [](const analysis::Source& source) {
      return source.name == "the rule at line 3, FOR or TIMER";
    });
    REQUIRE(timer != set.sources.end());
    return timer->period / board.instructions_per_ms();
  };
  CHECK(period_ms("idle >= 2s") == 2000);
  CHECK(period_ms("idle > 30s") == 30'001);
  CHECK(period_ms("idle < 3s") == 3000);
  CHECK(period_ms("idle IS BETWEEN 4s AND 10s") == 2000);  // both may come together
  CHECK(period_ms("idle > n") == 1);
}

TEST_CASE(
    "each board that robot.json may name has costs of its own, by which its programs are judged") {
  REQUIRE(tool::all_board_costs().size() == compiler::board_names().size());
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i) {
    const compiler::Board board = compiler::board_at(i);
    const policy::BoardCosts& costs = tool::costs_of(board);
    CHECK(&costs != &tool::board_costs());
    CHECK(costs.instructions_per_ms() > 0);
    if (board.name == compiler::default_board().name)
      CHECK(costs.clock_hz == tool::board_costs().clock_hz);
    if (board.name == "b-l475e-iot01a") CHECK(costs.clock_hz == 80'000'000);
    if (board.name == "microbit-v2") CHECK(costs.clock_hz == 64'000'000);
  }
}

TEST_CASE(
    "sound is heard once for all channels, and its block began one and a half periods before") {
  const auto path_of = [](const std::string& channels) {
    const tool::Program program = test::as_program(compiler::compile(
        {"robot.rsl", "WHEN ear LOUDNESS > 60dB" + channels + " DO RUN lamp TO 10% END\n"},
        {"robot.json", R"({"board": "microbit-v2",
        "sensors": [{"name": "ear", "device": "microphone"}],
        "actuators": [{"name": "lamp", "type": "PWM", "pin": 1, "device": "pwm"}]})"}));
    const analysis::ResponseReport report = analysis::response_report(
        program.image(), costs_of_board("microbit-v2"), tool::module_cost);
    REQUIRE(report.paths.size() == 1);
    return report.paths.front();
  };
  const policy::BoardCosts& board = costs_of_board("microbit-v2");
  const analysis::PathTiming one = path_of(""), two = path_of(" OR ear PITCH > 100Hz");
  CHECK(one.measuring == 30ULL * board.instructions_per_ms());
  CHECK(one.base.time > one.measuring + board.sound);
  CHECK(two.base.time < one.base.time + board.sound);
  CHECK(two.base.time > one.base.time);
}

TEST_CASE("what is told to measure began with the sample before: that is where its path begins") {
  for (const std::string_view name : {"mps2-an386", "b-l475e-iot01a"}) {
    CAPTURE(name);
    const tool::Program program = test::as_program(compiler::compile(
        {"robot.rsl", "WHEN front DISTANCE < 20cm DO RUN wheel FORWARD END\n"}, {"robot.json", R"({
        "sensors": [{"name": "front", "type": "I2C", "address": "0x29", "device": "vl53l0x"}],
        "actuators": [{"name": "wheel", "type": "PWM", "pins": [4, 6], "device": "motor"}]})"}));
    const policy::BoardCosts& board = costs_of_board(name);
    const analysis::ResponseReport report =
        analysis::response_report(program.image(), board, tool::module_cost);
    REQUIRE(report.paths.size() == 1);
    const analysis::PathTiming& path = report.paths.front();
    CHECK(path.measuring == 50ULL * board.instructions_per_ms());
    CHECK(path.measuring == path.period);
    CHECK(path.base.time > path.measuring);
    CHECK(path.share(path.base) < 0.5);
    CHECK(path.in_time());
  }
}

TEST_CASE("all the edges of an encoder that a board counts in a period may come at once") {
  const tool::Program program = test::as_program(compiler::compile(
      {"robot.rsl", "WHEN wheel DISTANCE > 20cm DO LOG \"there\" END\n"}, {"robot.json", R"({
        "sensors": [{"name": "wheel", "type": "GPIO", "pin": 40, "device": "encoder", "pulses_per_turn": 20, "wheel": "65mm"}]})"}));
  policy::BoardCosts board = tool::board_costs();
  const auto edges = [&] {
    const auto set = analysis::task_set_of(program.image(), board, tool::module_cost);
    const auto found =
        std::ranges::find(set.interferences, "the edges of wheel", &analysis::Interference::name);
    return found == set.interferences.end() ? analysis::Interference{} : *found;
  };
  CHECK(edges().cost == 0);  // this board has no edges
  board.edge = 150;
  CHECK(edges().cost == 150ULL * 120);  // 4 in each of 20 + 10 ms
  CHECK(edges().period == 20ULL * board.instructions_per_ms());
}

TEST_CASE("a sensor with an echo is asked 40 ms before: that is where its path begins") {
  const tool::Program program = test::as_program(compiler::compile(
      {"robot.rsl", "WHEN sonar DISTANCE < 20cm DO RUN wheel FORWARD END\n"}, {"robot.json", R"({
        "sensors": [{"name": "sonar", "type": "GPIO", "trigger": 3, "echo": 40, "device": "hc-sr04"}],
        "actuators": [{"name": "wheel", "type": "PWM", "pins": [4, 5], "device": "motor"}]})"}));
  const policy::BoardCosts& board = tool::board_costs();
  const analysis::TaskSet set = analysis::task_set_of(program.image(), board, tool::module_cost);
  const auto asking = std::ranges::find(set.sources, "asking for sonar", &analysis::Source::name);
  const auto sampling = std::ranges::find(set.sources, "sonar", &analysis::Source::name);
  REQUIRE((asking != set.sources.end() && sampling != set.sources.end()));
  CHECK(asking->sample == board.wake_by_timer + board.ping);
  CHECK(asking->period == sampling->period);
  CHECK(sampling->follows ==
        analysis::Source::kNone);  // it is sampled in time, whenever it was asked
  CHECK(sampling->measuring == 40ULL * board.instructions_per_ms());
  CHECK(sampling->sample >= board.wake_by_timer + board.echo);
  const analysis::ResponseReport report =
      analysis::response_report(program.image(), board, tool::module_cost);
  REQUIRE(report.paths.size() == 1);
  const analysis::PathTiming& path = report.paths.front();
  CHECK(path.measuring == sampling->measuring);
  CHECK(path.base.time > path.measuring);
  CHECK(path.base.time < path.measuring + board.instructions_per_ms() * 10ULL);
  CHECK(path.share(path.base) < 0.2);
  CHECK(path.in_time());
  // What the processor does may take until the next sample, not until the next pulse.
  analysis::PathTiming slow = path;
  slow.base.time = slow.period + slow.measuring;
  CHECK(slow.in_time());
  slow.base.time += 1;
  CHECK_FALSE(slow.in_time());
}

TEST_CASE(
    "a sensor whose bus works by itself is asked a millisecond before: that is where its path "
    "begins") {
  const char* const config = R"({"board": "microbit-v2",
    "sensors": [{"name": "motion", "device": "accelerometer", "channels": {"STRENGTH": {}}}],
    "actuators": [{"name": "face", "device": "lights"}]})";
  const tool::Program program = test::as_program(
      compiler::compile({"robot.rsl", "WHEN motion STRENGTH > 2g DO SHOW face scared END\n"},
                        {"robot.json", config}));
  const vm::Image& image = program.image();
  const policy::BoardCosts& board = costs_of_board("microbit-v2");
  const analysis::TaskSet set = analysis::task_set_of(image, board, tool::module_cost);
  const auto named = [&](std::string_view name) {
    const auto found = std::ranges::find(set.sources, name, &analysis::Source::name);
    REQUIRE(found != set.sources.end());
    return static_cast<std::size_t>(found - set.sources.begin());
  };
  const std::size_t asking = named("asking for motion"), sampling = named("motion");
  // At worst it is told to wake up as well.
  CHECK(set.sources[asking].sample == board.wake_by_timer + 2 * board.i2c_ask);
  CHECK(set.sources[asking].step == 0);
  CHECK(set.sources[asking].actuators.empty());
  CHECK(set.sources[sampling].follows == asking);
  const auto us = [&](unsigned bus_us) {
    return Instructions{board.instructions_per_ms()} * bus_us / 1000;
  };
  CHECK(set.sources[sampling].early == us(1'000));
  CHECK(set.sources[sampling].delay ==
        us(1'100 + 2 * board.i2c_transfer_us + 23 * board.i2c_byte_us));
  CHECK(set.sources[asking].rank == set.sources[sampling].rank);
  const analysis::ResponseReport report =
      analysis::response_report(image, board, tool::module_cost);
  CHECK(report.schedulable());
  REQUIRE(report.paths.size() == 1);
  CHECK(report.paths[0].base.time > set.sources[sampling].delay);
}
