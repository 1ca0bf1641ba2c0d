// Chips with an accelerometer and a gyroscope, and one with a magnetometer: woken and configured, from counts to g, deg/s and uT,
// and configured again after a loss of power.
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <utility>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/axes.hpp"
#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/drivers/axes_chips.hpp"
#include "tests/runtime-m4/drivers/transfers.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Transfers;
using test::writes_of;

namespace {

constexpr unsigned kStrengthInput = 3, kTurningInput = 4;
constexpr std::uint64_t kPeriodMs = 20;
constexpr unsigned kPatience = 4;  // samples until a chip that lost its power is read again
constexpr std::size_t kReads = 2;  // transfers of a sample

struct KnownChip {
  const char* name;
  const char* device;
  std::uint8_t address;
  vm::DriverId driver;
  unsigned inputs;
  std::unique_ptr<test::ModelOfAxes> (*make)();
};
template <typename Chip>
std::unique_ptr<test::ModelOfAxes> make() {
  return std::make_unique<Chip>();
}
constexpr KnownChip kChips[] = {
    {"lsm6dsl", "lsm6dsl", 0x6A, vm::DriverId::lsm6dsl, 7, make<test::Lsm6dsl>},
    {"mpu6050", "mpu6050", 0x68, vm::DriverId::mpu6050, 7, make<test::Mpu6050>},
    {"mpu6500", "mpu6050", 0x68, vm::DriverId::mpu6050, 7, make<test::Mpu6500>},
    {"lis3mdl", "lis3mdl", 0x1E, vm::DriverId::lis3mdl, 4, make<test::Lis3mdl>}};
constexpr std::span kMotionChips = std::span(kChips).first<3>();

struct Reader {
  explicit Reader(const KnownChip& known) : chip(known.make()), driver(known.driver) {
    sensor.bus = 1;
    sensor.address = 0x6A;
    board.on_bus = [this](std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                          std::span<std::byte> in) {
      return bus == sensor.bus && address == sensor.address && chip->transfer(out, in);
    };
  }
  bool ask(unsigned input) {
    vm::Channel channel{};
    channel.input = static_cast<std::uint8_t>(input);
    return drivers::driver(driver).read(board, sensor, channel, raw);
  }
  // Takes a sample, then waits a period.
  bool read(unsigned input) {
    const bool known = ask(input);
    chip->clock_ms += kPeriodMs;
    return known;
  }
  // The number of failed samples until there is a reading.
  unsigned in_vain() {
    unsigned samples = 0;
    while (!read(0) && samples <= kPatience)
      ++samples;
    return samples;
  }
  Transfers take_transfers() { return std::exchange(board.transfers, {}); }

  std::unique_ptr<test::ModelOfAxes> chip;
  vm::DriverId driver;
  test::NotingBoard board;
  vm::Sensor sensor{};
  std::int32_t raw = 0;
};

std::int32_t strength_of(std::int32_t x, std::int32_t y, std::int32_t z) {
  return static_cast<std::int32_t>(std::sqrt(double(x) * x + double(y) * y + double(z) * z));
}

std::size_t logged(const test::Rig& rig, const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      rig.lines, [&](const std::string& line) { return line.find(text) != std::string::npos; }));
}

// A robot with that chip, and a program that reacts to its motion.
struct MovedRobot {
  explicit MovedRobot(const KnownChip& known) : chip(known.make()) {
    chip->now_ms = [this] { return rig.kernel.now() / 1000; };
    rig.board.on_bus = [this, place = known.address](std::uint8_t, std::uint8_t address,
                                                     std::span<const std::byte> out,
                                                     std::span<std::byte> in) {
      return address == place && chip->transfer(out, in);
    };
    const std::string robot = R"({"sensors": [{"name": "motion", "type": "I2C", "address": )" +
                              std::to_string(known.address) + R"(, "device": ")" + known.device +
                              R"("}]})";
    REQUIRE(rig.activate(test::compile(R"(
WHEN motion X > 0.5g DO LOG "right" END
WHEN motion Y < -0.5g DO LOG "forward" END
WHEN motion STRENGTH > 2.5g DO LOG "shaken" END
WHEN motion STRENGTH < 0.3g DO LOG "falls" END
WHEN motion TURN_X < -90deg/s DO LOG "nods" END
WHEN motion TURN_Y > 90deg/s DO LOG "rolls" END
WHEN motion TURN_Z > 450deg/s DO LOG "spins" END
)",
                                       robot))
                .ok());
  }
  void move(std::array<double, test::kMostAxes> motion, std::uint64_t until_ms) {
    chip->motion = motion;
    rig.run(until_ms);
  }
  std::unique_ptr<test::ModelOfAxes> chip;
  test::Rig rig;
};

}  // namespace

TEST_CASE("six axes: one that comes asleep is told what to do, one thing with each sample") {
  for (const KnownChip& known : kChips) {
    INFO(known.name);
    Reader reader(known);
    unsigned samples = 0;
    while (!reader.read(samples % known.inputs)) {
      REQUIRE(++samples < kPatience);
      const Transfers transfers = reader.take_transfers();
      CHECK(transfers.size() - writes_of(transfers) == kReads);
      CHECK(writes_of(transfers) <= 1);
    }
    CHECK(samples > 0);
    CHECK(reader.chip->is_as_told());
    reader.take_transfers();
    for (unsigned input = 0; input < known.inputs; ++input)
      CHECK(reader.read(input));
    CHECK(reader.take_transfers().size() == known.inputs * kReads);
  }
}

TEST_CASE("six axes: what has not measured yet gives no 0, however often it is asked") {
  for (const KnownChip& known : kChips) {
    INFO(known.name);
    Reader reader(known);
    for (unsigned i = 0; i < 20; ++i)
      CHECK_FALSE(reader.ask(kStrengthInput));
    CHECK(reader.in_vain() <= kPatience);
    CHECK(reader.chip->is_as_told());
  }
}

TEST_CASE("six axes: a loss of power is noticed and mended, and nothing wrong is read meanwhile") {
  for (const KnownChip& known : kChips) {
    INFO(known.name);
    Reader reader(known);
    reader.in_vain();
    REQUIRE(reader.read(2));
    const std::int32_t measured = reader.raw;
    CHECK(std::abs(measured - reader.chip->counts_each(2)) <= 0.5);
    reader.chip->lose_power();
    unsigned samples = 0;
    while (!reader.read(2))
      REQUIRE(++samples < kPatience);
    CHECK(samples > 0);
    CHECK(reader.raw == measured);
  }
}

TEST_CASE("six axes: each register that does not hold what it was told is told again") {
  for (const KnownChip& known : kChips) {
    Reader reader(known);
    reader.in_vain();
    for (const std::size_t place : reader.chip->settings())
      for (const unsigned bit : {2U, 3U, 4U, 6U}) {
        INFO(known.name << " register " << place << " bit " << bit);
        reader.chip->registers[place] ^= std::byte{1} << bit;
        CHECK_FALSE(reader.read(0));
        CHECK(reader.chip->is_as_told());
        CHECK(reader.in_vain() <= 1);
      }
  }
}

TEST_CASE("six axes: no answer is no reading, be it to the first question or to the second") {
  for (const KnownChip& known : kChips) {
    INFO(known.name);
    Reader reader(known);
    reader.in_vain();
    for (const std::size_t silent_at : {0U, 1U}) {
      std::size_t asked = 0;
      reader.board.on_bus = [&](std::uint8_t, std::uint8_t, std::span<const std::byte> out,
                                std::span<std::byte> in) {
        return asked++ != silent_at && reader.chip->transfer(out, in);
      };
      reader.raw = 77;
      CHECK_FALSE(reader.read(0));
      CHECK(asked == kReads);
      CHECK(reader.raw == 77);
    }
    // On a bus that works in the background: the driver asks ahead for the same reads as when it is due, and writes nothing.
    reader.board.on_bus = [](std::uint8_t, std::uint8_t, std::span<const std::byte>,
                             std::span<std::byte> in) { return in.empty(); };
    reader.take_transfers();
    CHECK_FALSE(reader.read(known.inputs - 1));
    const Transfers ahead = reader.take_transfers();
    CHECK_FALSE(reader.read(known.inputs - 1));
    const Transfers due = reader.take_transfers();
    CHECK(writes_of(ahead) == 0);
    REQUIRE(ahead.size() == kReads);
    for (std::size_t i = 0; i < kReads; ++i) {
      CHECK(ahead[i].out == due.at(i).out);
      CHECK(ahead[i].in == due.at(i).in);
    }
  }
}

TEST_CASE("six axes: the count of each axis, and the root of those of acceleration") {
  std::mt19937 random(6050);
  for (const KnownChip& known : kChips) {
    INFO(known.name);
    Reader reader(known);
    reader.in_vain();
    for (unsigned round = 0; round < 500; ++round) {
      std::array<std::int32_t, test::kMostAxes> counts{};
      for (std::int32_t& count : counts)
        count = round == 0   ? -32768
                : round == 1 ? 32767
                             : static_cast<std::int32_t>(random() % 65536) - 32768;
      reader.chip->exact_counts = counts;
      for (unsigned axis = 0; axis < 3; ++axis) {
        REQUIRE(reader.read(axis));
        CHECK(reader.raw == counts[axis]);
        if (known.inputs <= kTurningInput) continue;
        REQUIRE(reader.read(kTurningInput + axis));
        CHECK(reader.raw == counts[3 + axis]);
      }
      REQUIRE(reader.read(kStrengthInput));
      CHECK(reader.raw == strength_of(counts[0], counts[1], counts[2]));
    }
    if (known.inputs <= kTurningInput) continue;
    reader.chip->exact_counts = {0, 0, 0, 0, 1, 0};
    CHECK(reader.read(kStrengthInput));  // it falls, and turns a little
    CHECK(reader.raw == 0);
  }
}

TEST_CASE("six axes: an input that it has not is not read, and the bus not asked") {
  for (const KnownChip& known : kChips) {
    Reader reader(known);
    reader.in_vain();
    reader.take_transfers();
    for (unsigned input = known.inputs; input < 256; ++input)
      CHECK_FALSE(reader.read(input));
    CHECK(reader.take_transfers().empty());
  }
}

TEST_CASE("six axes: a program knows how the robot is held, that it is shaken, falls, and turns") {
  for (const KnownChip& known : kMotionChips) {
    INFO(known.name);
    MovedRobot robot(known);
    robot.move({0, 0, 1, 0, 0, 0}, 200);
    CHECK(robot.rig.lines.size() > 0);
    CHECK(logged(robot.rig, " log ") == 0);
    robot.move({0.7, -0.7, 0, -100, 80, 440}, 300);
    CHECK(logged(robot.rig, " log ") == 3);
    CHECK(logged(robot.rig, "right") == 1);
    CHECK(logged(robot.rig, "forward") == 1);
    CHECK(logged(robot.rig, "nods") == 1);
    robot.move({1.6, 1.6, 1.6, 0, 100, 470}, 400);  // the shaking is visible in no single axis
    CHECK(logged(robot.rig, " log ") == 6);
    CHECK(logged(robot.rig, "shaken") == 1);
    CHECK(logged(robot.rig, "rolls") == 1);
    CHECK(logged(robot.rig, "spins") == 1);
    robot.move({0.05, 0, 0.05, 0, 0, 0}, 500);
    CHECK(logged(robot.rig, "falls") == 1);
  }
}

TEST_CASE(
    "six axes: one without power for a while is unknown then, falls nowhere, and comes back") {
  for (const KnownChip& known : kMotionChips) {
    INFO(known.name);
    MovedRobot robot(known);
    robot.move({0, 0, 1, 0, 0, 0}, 200);
    robot.rig.lines.clear();
    robot.chip->lose_power();
    robot.chip->answers = false;
    robot.rig.run(600);
    CHECK(logged(robot.rig, "silent motion") == 1);
    CHECK(logged(robot.rig, "stale STRENGTH") == 1);
    CHECK(logged(robot.rig, "stale TURN_Z") == 1);
    robot.chip->answers = true;
    robot.rig.run(1000);
    CHECK(logged(robot.rig, "answers motion") == 1);
    CHECK(logged(robot.rig, "input STRENGTH 1") == 1);
    CHECK(logged(robot.rig, " log ") == 0);
    robot.move({0.7, 0, 0.7, 0, 0, 0}, 1100);
    CHECK(logged(robot.rig, "right") == 1);
  }
}

TEST_CASE("six axes: the compass on a board knows a magnet by its field, in uT") {
  test::Rig rig;
  rig.board.board_pins.i2c_buses = 2;
  test::Lis3mdl chip;
  chip.now_ms = [&] { return rig.kernel.now() / 1000; };
  rig.board.on_bus = [&](std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                         std::span<std::byte> in) {
    return bus == 1 && address == 0x1E && chip.transfer(out, in);
  };
  chip.motion = {30, 0, -40.2, 0, 0, 0};
  REQUIRE(rig.activate(test::compile("WHEN compass X > 29.9uT AND compass Z < -40uT AND compass "
                                     "STRENGTH < 50.3uT DO LOG \"earth\" END\n"
                                     "WHEN compass STRENGTH > 200uT DO LOG \"magnet\" END\n"
                                     "WHEN compass Y > 1590uT DO LOG \"strong\" END\n",
                                     R"({"board": "b-l475e-iot01a", "sensors": [
  {"name": "compass", "device": "compass"}]})"))
              .ok());
  rig.run(300);
  CHECK(logged(rig, "earth") == 1);
  CHECK(logged(rig, "magnet") == 0);
  chip.motion[1] = 300;
  rig.run(500);
  CHECK(logged(rig, "magnet") == 1);
  CHECK(logged(rig, "strong") == 0);
  chip.motion[1] = 1600;
  rig.run(700);
  CHECK(logged(rig, "strong") == 1);
}

TEST_CASE("axes: the strength is the whole root of the sum of their squares") {
  std::mt19937 random(303);
  for (unsigned round = 0; round < 20'000; ++round) {
    const auto draw = [&] {
      const unsigned bits = 1 + random() % 16;  // small ones, too
      return static_cast<std::int16_t>(random() & ((1U << bits) - 1));
    };
    const std::array<std::int16_t, drivers::kAxes> axes{draw(), draw(), draw()};
    std::array<std::byte, drivers::kAxesBytes> registers;
    for (std::size_t i = 0; i < registers.size(); ++i)
      registers[i] = static_cast<std::byte>(axes[i / 2] >> 8 * (i % 2));
    const std::int32_t strength =
        drivers::acceleration(registers, std::endian::little, 0, kStrengthInput);
    CHECK(strength == strength_of(axes[0], axes[1], axes[2]));
  }
}
