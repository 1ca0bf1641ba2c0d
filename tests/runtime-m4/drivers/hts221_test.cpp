// The hygrometer and thermometer with its own calibration: from counts to thousandths, and counts that are not a reading.
#include <cmath>
#include <random>
#include <utility>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/drivers/hts221_model.hpp"
#include "tests/runtime-m4/drivers/transfers.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Hts221;
using test::Transfers;
using test::writes_of;

namespace {

constexpr std::size_t kAirReads = 3;  // transfers of a sample
constexpr unsigned kHumidityInput = 0, kTemperatureInput = 1, kAirInputs = 2;
constexpr std::uint64_t kAirPeriodMs = 200;

struct AirReader {
  AirReader() {
    sensor.bus = 1;
    sensor.address = 0x5F;
    board.on_bus = [this](std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                          std::span<std::byte> in) {
      return bus == sensor.bus && address == sensor.address && chip.transfer(out, in);
    };
  }
  bool ask(unsigned input) {
    vm::Channel channel{};
    channel.input = static_cast<std::uint8_t>(input);
    return drivers::driver(vm::DriverId::hts221).read(board, sensor, channel, raw);
  }
  // Waits a period, then takes a sample.
  bool read(unsigned input) {
    chip.clock_ms += kAirPeriodMs;
    return ask(input);
  }
  void start() {
    read(kHumidityInput);
    REQUIRE(read(kHumidityInput));
    raw = 77;
  }
  Transfers take_transfers() { return std::exchange(board.transfers, {}); }

  Hts221 chip;
  test::NotingBoard board;
  vm::Sensor sensor{};
  std::int32_t raw = 77;
};

// According to the data sheet, in thousandths.
double interpolated(const Hts221::Points& points, double steps_each, int count, double least,
                    double most) {
  const double low = points.low / steps_each, high = points.high / steps_each;
  const double value =
      low + (high - low) * (count - points.low_count) / (points.high_count - points.low_count);
  return 1000 * std::clamp(value, least, most);
}

}  // namespace

TEST_CASE(
    "hts221: one that is off is told to measure once, and gives nothing before it has measured") {
  AirReader reader;
  CHECK_FALSE(reader.ask(kHumidityInput));
  CHECK(writes_of(reader.take_transfers()) == 1);
  CHECK(reader.chip.is_on());
  CHECK((reader.chip.control() & 0x04) != 0);  // BDU
  for (unsigned i = 0; i < 20; ++i)
    CHECK_FALSE(reader.ask(i % kAirInputs));
  CHECK(reader.raw == 77);
  CHECK(reader.read(kHumidityInput));
  CHECK(reader.read(kTemperatureInput));
  const Transfers transfers = reader.take_transfers();
  CHECK(writes_of(transfers) == 0);
  CHECK(transfers.size() == 22 * kAirReads);
}

TEST_CASE("hts221: humidity and temperature, at both ends, at both points, and between them") {
  AirReader reader;
  reader.start();
  const auto close = [&](double wanted, double count_is) {
    CAPTURE(wanted, reader.raw);
    CHECK(std::abs(reader.raw - 1000 * wanted) <= 500 * count_is + 1);
  };
  for (const double humidity : {0.0, 0.5, 20.0, 43.21, 50.0, 80.0, 99.5, 100.0}) {
    reader.chip.humidity = humidity;
    REQUIRE(reader.read(kHumidityInput));
    close(humidity, 0.006);
  }
  for (const double temperature : {-40.0, -0.0625, 0.0, 10.0, 21.375, 35.0, 100.0, 120.0}) {
    reader.chip.temperature = temperature;
    REQUIRE(reader.read(kTemperatureInput));
    close(temperature, 0.0625);
  }
}

TEST_CASE(
    "hts221: any count with any two points gives what the data sheet's line says, to a "
    "thousandth") {
  std::mt19937 random(221);
  const auto word = [&] { return static_cast<std::int16_t>(random() & 0xFFFF); };
  AirReader reader;
  reader.start();
  for (unsigned round = 0; round < 5000; ++round) {
    Hts221::Points& h = reader.chip.humidity_points;
    Hts221::Points& t = reader.chip.temperature_points;
    h = {static_cast<int>(random() % 256), static_cast<int>(random() % 256), word(), word()};
    t = {static_cast<int>(random() % 1024), static_cast<int>(random() % 1024), word(), word()};
    if (round % 4 == 0) h.high_count = static_cast<std::int16_t>(h.low_count ^ 1);
    if (round % 4 == 1) t.high_count = static_cast<std::int16_t>(t.low_count ^ 1);
    reader.chip.humidity_count = round == 8 ? INT16_MIN : round == 9 ? INT16_MAX : word();
    reader.chip.temperature_count = round == 8 ? INT16_MAX : round == 9 ? INT16_MIN : word();
    CAPTURE(round, h.low, h.high, h.low_count, h.high_count, *reader.chip.humidity_count);
    CAPTURE(t.low, t.high, t.low_count, t.high_count, *reader.chip.temperature_count);
    if (h.low_count != h.high_count) {
      REQUIRE(reader.read(kHumidityInput));
      REQUIRE(std::abs(reader.raw - interpolated(h, 2, *reader.chip.humidity_count, 0, 100)) <= 1);
    }
    if (t.low_count != t.high_count) {
      REQUIRE(reader.read(kTemperatureInput));
      REQUIRE(std::abs(reader.raw - interpolated(t, 8, *reader.chip.temperature_count, -40, 120)) <=
              1);
    }
  }
}

TEST_CASE(
    "hts221: two points at the same count say nothing: unknown, and the other channel is read") {
  AirReader reader;
  reader.start();
  for (const unsigned broken : {kHumidityInput, kTemperatureInput}) {
    AirReader fresh;
    fresh.start();
    Hts221::Points& points =
        broken == kHumidityInput ? fresh.chip.humidity_points : fresh.chip.temperature_points;
    points.high_count = points.low_count;
    CHECK_FALSE(fresh.read(broken));
    CHECK(fresh.raw == 77);
    CHECK(fresh.read(1 - broken));
  }
  // Nothing at all in its memory.
  reader.chip.humidity_points = reader.chip.temperature_points = {0, 0, 0, 0};
  reader.chip.humidity_count = reader.chip.temperature_count = 5;
  CHECK_FALSE(reader.read(kHumidityInput));
  CHECK_FALSE(reader.read(kTemperatureInput));
}

TEST_CASE("hts221: counts of 0 are a reading when they are new") {
  AirReader reader;
  reader.start();
  reader.chip.humidity_count = reader.chip.temperature_count = 0;
  REQUIRE(reader.read(kHumidityInput));
  CHECK(reader.raw == 44'000);
  CHECK_FALSE(reader.ask(kHumidityInput));  // no longer valid
  REQUIRE(reader.read(kTemperatureInput));
  CHECK(reader.raw == -8'750);
}

TEST_CASE("hts221: a loss of power is noticed and mended, and nothing wrong is read meanwhile") {
  AirReader reader;
  reader.start();
  reader.chip.lose_power();
  reader.chip.humidity = 70;
  // A replacement part has other points.
  reader.chip.humidity_points = {30, 150, 9000, -9000};
  CHECK_FALSE(reader.read(kHumidityInput));
  CHECK_FALSE(reader.ask(kHumidityInput));
  REQUIRE(reader.read(kHumidityInput));
  CHECK(std::abs(reader.raw - 70'000) < 10);
}

TEST_CASE("hts221: whatever it was told meanwhile, it is told again; reserved bits are its own") {
  for (unsigned bit = 0; bit < 8; ++bit) {
    CAPTURE(bit);
    AirReader reader;
    reader.start();
    const std::uint8_t told = reader.chip.control();
    reader.chip.set_control(static_cast<std::uint8_t>(told ^ 1U << bit));
    reader.take_transfers();
    const bool is_ours = (0x87U >> bit & 1) != 0;
    CHECK(reader.read(kHumidityInput) == !is_ours);
    CHECK(writes_of(reader.take_transfers()) == (is_ours ? 1 : 0));
    CHECK((reader.chip.control() & 0x87) == 0x87);
  }
}

TEST_CASE("hts221: another chip at its address is told nothing, and gives no reading") {
  for (const std::uint8_t name : {std::uint8_t{0x00}, std::uint8_t{0xB1}, std::uint8_t{0xFF}}) {
    AirReader reader;
    reader.chip.be_named(name);
    for (unsigned i = 0; i < 3; ++i)
      CHECK_FALSE(reader.read(i % kAirInputs));
    CHECK(writes_of(reader.take_transfers()) == 0);
  }
}

TEST_CASE("hts221: an input that it has not is not read, and the bus not asked") {
  AirReader reader;
  reader.start();
  reader.take_transfers();
  for (unsigned input = kAirInputs; input < 256; ++input)
    CHECK_FALSE(reader.read(input));
  CHECK(reader.take_transfers().empty());
}

TEST_CASE("hts221: no answer is no reading, be it to the first, the second or the third question") {
  AirReader reader;
  reader.start();
  for (const std::size_t silent_at : {0U, 1U, 2U}) {
    std::size_t asked = 0;
    reader.board.on_bus = [&](std::uint8_t, std::uint8_t, std::span<const std::byte> out,
                              std::span<std::byte> in) {
      return reader.chip.transfer(out, in) && asked++ != silent_at;
    };
    CHECK_FALSE(reader.read(kTemperatureInput));
    CHECK(asked == kAirReads);
    CHECK(reader.raw == 77);
  }
  // On a bus that works in the background: the driver asks ahead for the same reads as when it is due, and writes nothing.
  reader.board.on_bus = [](std::uint8_t, std::uint8_t, std::span<const std::byte>,
                           std::span<std::byte> in) { return in.empty(); };
  reader.take_transfers();
  CHECK_FALSE(reader.read(kHumidityInput));
  const Transfers ahead = reader.take_transfers();
  CHECK_FALSE(reader.read(kTemperatureInput));
  const Transfers due = reader.take_transfers();
  CHECK(writes_of(ahead) == 0);
  REQUIRE(ahead.size() == kAirReads);
  for (std::size_t i = 0; i < kAirReads; ++i) {
    CHECK(ahead[i].out == due.at(i).out);
    CHECK(ahead[i].in == due.at(i).in);
  }
}

TEST_CASE("hts221: its transfers are as many as are declared of it, and as long") {
  AirReader reader;
  reader.read(kHumidityInput);  // including the writes
  const Transfers transfers = reader.take_transfers();
  const test::Declared said = test::declared_of(vm::DriverId::hts221);
  CHECK(transfers.size() == said.transfers);
  CHECK(test::bytes_of(transfers) == said.bytes);
}

TEST_CASE("hts221: a program knows the air, and one without power is unknown and comes back") {
  test::Rig rig;
  Hts221 chip;
  chip.now_ms = [&] { return rig.kernel.now() / 1000; };
  rig.board.on_bus = [&](std::uint8_t, std::uint8_t address, std::span<const std::byte> out,
                         std::span<std::byte> in) {
    return address == 0x5F && chip.transfer(out, in);
  };
  REQUIRE(
      rig
          .activate(test::compile(
              R"(
WHEN air HUMIDITY > 70% DO LOG "damp" END
WHEN air HUMIDITY < 0.1% DO LOG "dry" END
WHEN air TEMPERATURE > 28C DO LOG "warm" END
WHEN air TEMPERATURE < -5C DO LOG "frost" END
)",
              R"({"sensors": [{"name": "air", "type": "I2C", "address": "0x5f", "device": "hts221"}]})"))
          .ok());
  const auto logged = [&](const std::string& text) {
    return std::ranges::count_if(
        rig.lines, [&](const std::string& line) { return line.find(text) != std::string::npos; });
  };
  const auto pass = [&](double humidity, double temperature, std::uint64_t ms) {
    rig.lines.clear();
    chip.humidity = humidity;
    chip.temperature = temperature;
    rig.run(rig.kernel.now() / 1000 + ms);
  };
  pass(50, 20, 1000);
  CHECK(logged("input HUMIDITY") == 1);
  CHECK(logged(" log ") == 0);
  pass(75, 20, 500);
  CHECK((logged("damp") == 1 && logged(" log ") == 1));
  pass(75, 30, 500);
  CHECK((logged("warm") == 1 && logged(" log ") == 1));
  pass(-3, -6, 500);  // the line continues below 0 %
  CHECK((logged("dry") == 1 && logged("frost") == 1));
  chip.lose_power();
  chip.absent = true;
  pass(75, 30, 2000);
  CHECK((logged("silent air") == 1 && logged("stale HUMIDITY") == 1 &&
         logged("stale TEMPERATURE") == 1));
  CHECK(logged(" log ") == 0);
  chip.absent = false;
  pass(75, 30, 1000);
  CHECK((logged("answers air") == 1 && logged("damp") == 1 && logged("warm") == 1));
}
