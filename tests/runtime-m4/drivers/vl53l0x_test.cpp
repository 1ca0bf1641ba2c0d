// The optical distance sensor: from its results to readings, the writes to it and their times, and results that are not readings.
#include <utility>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/drivers/hts221_model.hpp"
#include "tests/runtime-m4/drivers/transfers.hpp"
#include "tests/runtime-m4/drivers/vl53l0x_model.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Transfers;
using test::Vl53l0x;
using test::writes_of;

namespace {

constexpr std::size_t kLightReads = 2;  // transfers of a sample

struct LightReader {
  LightReader() {
    sensor.bus = 1;
    sensor.address = 0x29;
    board.on_bus = [this](std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                          std::span<std::byte> in) {
      return bus == sensor.bus && address == sensor.address && chip.transfer(out, in);
    };
  }
  // Takes a sample, `after_ms` after the last one.
  bool read(std::uint64_t after_ms = vm::kMinRangingPeriodMs) {
    chip.clock_ms += after_ms;
    return drivers::driver(vm::DriverId::vl53l0x).read(board, sensor, vm::Channel{}, raw);
  }
  Transfers take_transfers() { return std::exchange(board.transfers, {}); }

  Vl53l0x chip;
  test::NotingBoard board;
  vm::Sensor sensor{};
  std::int32_t raw = 77;
};

const char* const kSeeing = R"({
  "sensors": [{"name": "front", "type": "I2C", "address": "0x29", "device": "vl53l0x"},
              {"name": "room", "type": "I2C", "address": "0x5f", "device": "hts221"}],
  "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo"}]})";

// A robot with both sensors of this kind on one bus.
struct SeeingRobot {
  // The distance sensor has been used before: a result is there, `before_mm`.
  explicit SeeingRobot(const std::string& program, unsigned before_mm = 1000) {
    light.now_ms = air.now_ms = [this] { return rig.kernel.now() / 1000; };
    light.measure_before(before_mm);
    rig.board.on_bus = [this](std::uint8_t, std::uint8_t address, std::span<const std::byte> out,
                              std::span<std::byte> in) {
      if (address == 0x29) return light.transfer(out, in);
      return address == 0x5F && air.transfer(out, in);
    };
    REQUIRE(rig.activate(test::compile(program, kSeeing)).ok());
  }
  std::size_t logged(const std::string& text) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        rig.lines, [&](const std::string& line) { return line.find(text) != std::string::npos; }));
  }
  Vl53l0x light;
  test::Hts221 air;
  test::Rig rig;
};

}  // namespace

TEST_CASE(
    "vl53l0x: the first sample has it measure, each other one takes a result in millimetres") {
  LightReader reader;
  CHECK_FALSE(reader.read());
  CHECK(reader.chip.measures());
  for (const unsigned mm : {0U, 1U, 20U, 255U, 256U, 1000U, 1999U, 2000U, 8189U}) {
    reader.chip.mm = mm;
    REQUIRE(reader.read());
    CHECK(reader.raw == static_cast<std::int32_t>(mm));
    CHECK(reader.chip.measures());
    CHECK_FALSE(reader.chip.has_untaken());
  }
  CHECK(reader.chip.starts == 10);
}

TEST_CASE("vl53l0x: a result is taken once, and what is not ready yet is none") {
  LightReader reader;
  reader.read();
  REQUIRE(reader.read());
  reader.raw = 77;
  reader.chip.mm = 500;
  for (unsigned i = 0; i < 3; ++i)
    CHECK_FALSE(reader.read(10));
  CHECK(reader.raw == 77);
  REQUIRE(reader.read(Vl53l0x::kMeasuringMs));
  CHECK(reader.raw == 500);
}

TEST_CASE("vl53l0x: a result that is not valid is none, and neither is one of 8190 mm and more") {
  LightReader reader;
  reader.read();
  for (unsigned status = 0; status < 16; ++status) {
    CAPTURE(status);
    reader.chip.status = status;
    reader.raw = 77;
    CHECK(reader.read() == (status == Vl53l0x::kValid));
    CHECK(reader.raw == (status == Vl53l0x::kValid ? 1000 : 77));
    CHECK(reader.chip.measures());  // the next result may be valid
  }
  reader.chip.status = Vl53l0x::kValid;
  for (const unsigned mm : {8190U, 8191U, 0x2000U, 0xFFFFU}) {
    reader.chip.mm = mm;
    CHECK_FALSE(reader.read());
  }
  reader.chip.mm = 30;
  CHECK(reader.read());
}

TEST_CASE("vl53l0x: another chip at its address is told nothing, and gives no reading") {
  for (const std::uint8_t name : {std::uint8_t{0x00}, std::uint8_t{0xEA}, std::uint8_t{0xFF}}) {
    LightReader reader;
    reader.read();
    reader.chip.be_named(name);
    reader.take_transfers();
    for (unsigned i = 0; i < 3; ++i)
      CHECK_FALSE(reader.read());
    CHECK(writes_of(reader.take_transfers()) == 0);
  }
}

TEST_CASE("vl53l0x: no answer is no reading, be it to the first question or to the second") {
  LightReader reader;
  reader.read();
  for (const std::size_t silent_at : {0U, 1U}) {
    std::size_t asked = 0;
    reader.board.on_bus = [&](std::uint8_t, std::uint8_t, std::span<const std::byte> out,
                              std::span<std::byte> in) {
      return reader.chip.transfer(out, in) && asked++ != silent_at;
    };
    CHECK_FALSE(reader.read());
    CHECK(asked == kLightReads);
    CHECK(reader.raw == 77);
  }
  // On a bus that works in the background: the driver asks ahead for the same reads as when it is due, and writes nothing.
  reader.board.on_bus = [](std::uint8_t, std::uint8_t, std::span<const std::byte>,
                           std::span<std::byte> in) { return in.empty(); };
  reader.take_transfers();
  CHECK_FALSE(reader.read());
  const Transfers ahead = reader.take_transfers();
  CHECK_FALSE(reader.read());
  const Transfers due = reader.take_transfers();
  CHECK(writes_of(ahead) == 0);
  REQUIRE(ahead.size() == kLightReads);
  for (std::size_t i = 0; i < kLightReads; ++i) {
    CHECK(ahead[i].out == due.at(i).out);
    CHECK(ahead[i].in == due.at(i).in);
  }
}

TEST_CASE("vl53l0x: its transfers are as many as are declared of it, and as long") {
  LightReader reader;
  reader.read();
  reader.take_transfers();
  REQUIRE(reader.read());
  const Transfers transfers = reader.take_transfers();
  const test::Declared said = test::declared_of(vm::DriverId::vl53l0x);
  CHECK(transfers.size() == said.transfers);
  CHECK(test::bytes_of(transfers) == said.bytes);
}

TEST_CASE("vl53l0x: after a loss of power it is told all again, and reads two samples later") {
  LightReader reader;
  reader.read();
  REQUIRE(reader.read());
  reader.chip.lose_power();
  CHECK_FALSE(reader.read(1));  // it boots
  CHECK_FALSE(reader.read());
  reader.chip.mm = 333;
  REQUIRE(reader.read());
  CHECK(reader.raw == 333);
}

TEST_CASE("vl53l0x: readings are in centimetres, up to 2 m, beside another sensor on the bus") {
  for (const auto& [mm, says] :
       {std::pair{0U, "at it"}, {1234U, "middle"}, {2000U, "far"}, {3500U, "far"}}) {
    SeeingRobot robot(R"(
WHEN front DISTANCE < 0.1cm DO LOG "at it" END
WHEN front DISTANCE > 123.3cm AND front DISTANCE < 123.5cm DO LOG "middle" END
WHEN front DISTANCE > 199.9cm DO LOG "far" END
WHEN room HUMIDITY > 49% AND room TEMPERATURE < 21C DO LOG "air" END
)");
    CAPTURE(mm);
    robot.light.mm = mm;
    robot.rig.run(500);
    CHECK(robot.logged(says) == 1);
    CHECK(robot.logged("air") == 1);
    CHECK(robot.logged(" log ") == 2);
  }
}

TEST_CASE("vl53l0x: it is asked 20 times a second, each time once, and has measured by then") {
  SeeingRobot robot("WHEN front DISTANCE < 1cm DO LOG \"near\" END\n");
  robot.rig.run(1010);
  CHECK(robot.light.starts >= 20);
  CHECK(robot.light.starts <= 22);
  CHECK(robot.logged("silent front") == 0);
  CHECK(robot.logged("input DISTANCE") == 1);
}

TEST_CASE("vl53l0x: what it has measured before the program is no reading, of SAFETY neither") {
  for (const bool safe : {false, true}) {
    CAPTURE(safe);
    const std::string wall = "SAFETY wall\n  WHEN front DISTANCE < 20cm\n  DO STOP arm\nEND\n";
    SeeingRobot robot((safe ? wall : "") + "WHEN front DISTANCE < 50cm DO LOG \"near\" END\n", 100);
    robot.rig.run(500);
    CHECK(robot.logged("near") == 0);
    CHECK(robot.rig.only("trip").empty());
    CHECK(robot.logged("silent front") == 0);
    CHECK(robot.logged("deadline") == 0);
    CHECK(robot.logged("input DISTANCE") == 1);
  }
}

TEST_CASE(
    "vl53l0x: where it sees nothing the distance is unknown after a while, and SAFETY trips") {
  SeeingRobot robot(R"(
SAFETY wall
  WHEN front DISTANCE < 20cm
  DO STOP arm
  RESUME WHEN front DISTANCE > 30cm
END
WHEN front DISTANCE < 50cm DO LOG "near" END
)");
  robot.rig.run(500);
  CHECK(robot.rig.only("trip").empty());
  for (const bool absent : {false, true}) {
    robot.rig.lines.clear();
    robot.light.absent = absent;
    robot.light.status = 4;
    robot.rig.run(robot.rig.kernel.now() / 1000 + 700);
    CAPTURE(absent);
    CHECK(robot.logged("stale DISTANCE") == (absent ? 0 : 1));
    CHECK(robot.logged("silent front") == (absent ? 0 : 1));
    CHECK(robot.rig.only("trip").empty() == absent);
    CHECK(robot.logged(" log ") == 0);
  }
  robot.light.absent = false;
  robot.light.lose_power();
  robot.light.status = Vl53l0x::kValid;
  robot.light.mm = 450;
  robot.rig.run(robot.rig.kernel.now() / 1000 + 300);
  CHECK(robot.logged("answers front") == 1);
  CHECK(robot.logged("near") == 1);
}
