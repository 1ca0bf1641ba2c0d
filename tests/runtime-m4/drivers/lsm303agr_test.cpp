// The accelerometer LSM303AGR, with a model of its registers: woken when it is asleep, from counts to g, in any position.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;

namespace {

const char* const kMotionRobot = R"({"sensors": [
  {"name": "motion", "type": "I2C", "address": "0x19", "device": "lsm303agr"}]})";
const char* const kMotionProgram = R"(
WHEN motion X > 0.5g DO LOG "right" END
WHEN motion Y < -0.5g DO LOG "forward" END
WHEN motion STRENGTH > 2.5g DO LOG "shaken" END
WHEN motion STRENGTH < 0.3g DO LOG "falls" END
)";

// A write and a read of the registers of either half: the highest bit of the first byte says to go on to the next register.
bool transfer(std::span<std::byte> registers, std::span<const std::byte> out,
              std::span<std::byte> in) {
  auto place = std::to_integer<std::size_t>(out[0]) & 0x7F;
  const bool goes_on = (out[0] & std::byte{0x80}) != std::byte{0};
  const auto next = [&]() -> std::byte& {
    REQUIRE(place < registers.size());
    return registers[goes_on ? place++ : place];
  };
  for (const std::byte byte : out.subspan(1))
    next() = byte;
  for (std::byte& byte : in)
    byte = next();
  return true;
}

// ST DocID027765 Rev 9: table 25, the registers from 0x20 on, and how a count is laid out.
struct Accelerometer {
  explicit Accelerometer(test::NotingBoard& board) {
    board.on_transfer = [this](std::span<const std::byte> out, std::span<std::byte> in) {
      return transfer(registers, out, in);
    };
    lose_power();
  }
  void lose_power() {
    registers.fill(std::byte{0});
    registers[0x0F] = std::byte{0x33};
    registers[0x20] = std::byte{0x07};
  }
  bool awake() const { return registers[0x20] == std::byte{0x67}; }
  // 10 bits, to the left, of 7.82 mg each.
  void set(unsigned axis, double g) {
    put(axis, static_cast<std::int32_t>(std::lround(g / 0.00782)));
  }
  void put(unsigned axis, std::int32_t count) {
    registers[0x28 + 2 * axis] = static_cast<std::byte>(count * 64 & 0xFF);
    registers[0x29 + 2 * axis] = static_cast<std::byte>(count * 64 >> 8 & 0xFF);
  }
  void lie(double x, double y, double z) {
    set(0, x);
    set(1, y);
    set(2, z);
  }
  std::array<std::byte, 0x40> registers{};
};

struct Reader {
  Reader() { sensor.address = 0x19; }
  bool read(unsigned input) {
    vm::Channel channel{};
    channel.input = static_cast<std::uint8_t>(input);
    return drivers::driver(vm::DriverId::lsm303agr).read(board, sensor, channel, raw);
  }
  test::NotingBoard board;
  Accelerometer device{board};
  vm::Sensor sensor{};
  std::int32_t raw = 0;
};

std::size_t logged(const test::Rig& rig, const std::string& text) {
  std::size_t found = 0;
  for (const std::string& line : rig.lines)
    found += line.find(text) == std::string::npos ? 0 : 1;
  return found;
}

}  // namespace

TEST_CASE("lsm303agr: one that is asleep is woken, once, and says nothing until then") {
  Reader reader;
  CHECK_FALSE(reader.read(0));
  CHECK(reader.device.awake());
  CHECK(reader.device.registers[0x23] == std::byte{0x90});  // BDU, 4 g
  CHECK(reader.board.transfers.size() == 2);
  CHECK(reader.read(0));
  CHECK(reader.board.transfers.size() == 3);
  reader.device.lose_power();
  CHECK_FALSE(reader.read(0));
  CHECK(reader.read(0));
  reader.device.registers[0x23] = std::byte{0x80};  // another range
  CHECK_FALSE(reader.read(0));
  CHECK(reader.device.registers[0x23] == std::byte{0x90});
  reader.board.on_transfer = {};
  CHECK_FALSE(reader.read(0));
}

TEST_CASE("lsm303agr: a count of each axis, and the root of them all") {
  Reader reader;
  static_cast<void>(reader.read(0));
  std::mt19937 random(303);
  for (unsigned round = 0; round < 2000; ++round) {
    std::array<std::int32_t, 3> counts{};
    double square = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      counts[axis] = round == 0 ? -512 : static_cast<std::int32_t>(random() % 1024) - 512;
      reader.device.put(axis, counts[axis]);
      square += double(counts[axis]) * counts[axis];
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
      REQUIRE(reader.read(axis));
      CHECK(reader.raw == counts[axis]);
    }
    REQUIRE(reader.read(3));
    CHECK(reader.raw == static_cast<std::int32_t>(std::sqrt(square)));
  }
}

TEST_CASE("lsm303agr: a program knows how the robot is held, that it is shaken, that it falls") {
  test::Rig rig;
  Accelerometer device(rig.board);
  device.lie(0, 0, -1);
  REQUIRE(rig.activate(test::compile(kMotionProgram, kMotionRobot)).ok());
  rig.run(100);
  CHECK(rig.lines.size() > 0);
  CHECK(logged(rig, " log ") == 0);
  device.lie(0.7, -0.7, 0);
  rig.run(200);
  CHECK(logged(rig, "right") == 1);
  CHECK(logged(rig, "forward") == 1);
  device.lie(1.6, 1.6, 1.6);  // visible in no single axis
  rig.run(300);
  CHECK(logged(rig, "shaken") == 1);
  device.lie(0.05, 0, 0.05);
  rig.run(400);
  CHECK(logged(rig, "falls") == 1);
}

namespace {

// ST DocID027765 Rev 9: table 26, the registers of the magnetometer from 0x60 on, after a reset.
struct Magnetometer {
  explicit Magnetometer(test::NotingBoard& board) {
    board.on_bus = [this](std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                          std::span<std::byte> in) {
      if (bus != 1 || address != 0x1E) return false;
      return transfer(registers, out, in);
    };
    lose_power();
  }
  void lose_power() {
    registers.fill(std::byte{0});
    registers[0x4F] = std::byte{0x40};
    registers[0x60] = std::byte{0x03};  // idle
    registers[0x63] = std::byte{0xE0};
  }
  bool measures() const {
    const auto mode = std::to_integer<unsigned>(registers[0x60]);
    return (mode & 0b11) == 0 && (mode & 0x80) != 0 && registers[0x62] == std::byte{0x10} &&
           registers[0x61] == std::byte{0} && registers[0x63] == std::byte{0xE0};
  }
  void put(unsigned axis, std::int32_t count) {
    registers[0x68 + 2 * axis] = static_cast<std::byte>(count & 0xFF);
    registers[0x69 + 2 * axis] = static_cast<std::byte>(count >> 8 & 0xFF);
  }
  std::array<std::byte, 0x80> registers{};
};

}  // namespace

TEST_CASE("lsm303agr: the magnetometer is woken, once, and a count is a count of each axis") {
  test::NotingBoard board;
  Magnetometer device(board);
  vm::Sensor sensor{};
  sensor.bus = 1;
  sensor.address = 0x1E;
  std::int32_t raw = 0;
  const auto read = [&](unsigned input) {
    vm::Channel channel{};
    channel.input = static_cast<std::uint8_t>(input);
    return drivers::driver(vm::DriverId::lsm303agr).read(board, sensor, channel, raw);
  };
  CHECK_FALSE(read(0));
  CHECK(device.measures());
  CHECK(read(0));
  CHECK(board.transfers.size() == 3);
  std::mt19937 random(1303);
  for (unsigned round = 0; round < 2000; ++round) {
    double square = 0;
    std::array<std::int32_t, 3> counts{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      counts[axis] = round == 0 ? -32768 : static_cast<std::int32_t>(random() % 65536) - 32768;
      device.put(axis, counts[axis]);
      square += double(counts[axis]) * counts[axis];
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
      REQUIRE(read(axis));
      CHECK(raw == counts[axis]);
    }
    REQUIRE(read(3));
    CHECK(raw == static_cast<std::int32_t>(std::sqrt(square)));
  }
  device.lose_power();
  CHECK_FALSE(read(2));
  CHECK(read(2));
}

TEST_CASE("lsm303agr: a program knows a magnet by its field, in uT") {
  test::Rig rig;
  rig.board.board_pins.i2c_buses = 2;
  Magnetometer device(rig.board);
  device.put(0, 200);
  device.put(2, -267);
  REQUIRE(rig.activate(test::compile("WHEN compass X > 29.9uT AND compass Z < -40uT AND compass "
                                     "STRENGTH < 50.1µT DO LOG \"earth\" END\n"
                                     "WHEN compass STRENGTH > 200uT DO LOG \"magnet\" END\n",
                                     R"({"board": "microbit-v2", "sensors": [
  {"name": "compass", "device": "compass"}]})"))
              .ok());
  rig.run(200);
  CHECK(logged(rig, "earth") == 1);
  device.put(1, 2000);
  rig.run(400);
  CHECK(logged(rig, "magnet") == 1);
}
