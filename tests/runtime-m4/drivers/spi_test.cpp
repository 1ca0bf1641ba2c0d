// Parts on SPI: what their drivers write and make of what they read, and a part that is not there.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/drivers/mcp3008_model.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Rig;

namespace {

struct Sent {
  std::uint8_t bus;
  std::uint16_t select;
  std::vector<std::byte> out;
  std::size_t in;
};

// A part whose registers all hold `bytes`.
struct Registers {
  explicit Registers(std::array<std::uint8_t, 2> held) : bytes(held) {
    board.on_spi = [this](std::uint8_t bus, std::uint16_t select, std::span<const std::byte> out,
                          std::span<std::byte> in) {
      sent.push_back({bus, select, {out.begin(), out.end()}, in.size()});
      for (std::size_t i = 0; i < in.size(); ++i)
        in[i] = std::byte{bytes.at(i)};
      return ends;
    };
  }
  std::optional<std::int32_t> read(vm::SpiFormat format) {
    vm::Sensor sensor{};
    sensor.bus = 1;
    sensor.address = 36;
    sensor.first_input = static_cast<std::uint8_t>(format);
    vm::Channel channel{};
    channel.input = 0xA8;
    std::int32_t raw = -1;
    const bool done = drivers::driver(vm::DriverId::spi_register).read(board, sensor, channel, raw);
    return done ? std::optional(raw) : std::nullopt;
  }
  std::array<std::uint8_t, 2> bytes;
  bool ends = true;
  std::vector<Sent> sent;
  test::NotingBoard board;
};

const char* const kKnob = "WHEN knob LEVEL > 50% DO LOG \"up\" END\n";
constexpr std::string_view kOfKnob =
    R"({"sensors": [{"name": "knob", "type": "SPI", "pin": 37, "device": "mcp3008",
        "channels": {"LEVEL": {"input": 5}}}], "actuators": [{"name": "claw", "type": "VIRTUAL"}]})";

struct Knob {
  Knob() {
    rig.board.on_spi = [this](std::uint8_t bus, std::uint16_t select,
                              std::span<const std::byte> out, std::span<std::byte> in) {
      if (bus != 0 || select != 37) return false;
      chip.transfer(out, in);
      return true;
    };
    REQUIRE(rig.activate(test::compile(kKnob, std::string(kOfKnob))).ok());
  }
  test::Mcp3008 chip;
  Rig rig;
};

}  // namespace

TEST_CASE("spi_register: writes the register, and reads one or two bytes of each format") {
  using vm::SpiFormat;
  for (const auto& [format, raw] : {std::pair{SpiFormat::uint16, 0x8182},
                                    {SpiFormat::int16, 0x8182 - 0x10000},
                                    {SpiFormat::uint16le, 0x8281},
                                    {SpiFormat::int16le, 0x8281 - 0x10000},
                                    {SpiFormat::uint8, 0x81},
                                    {SpiFormat::int8, 0x81 - 0x100}}) {
    CAPTURE(static_cast<int>(format));
    Registers part({0x81, 0x82});
    CHECK(part.read(format) == raw);
    REQUIRE(part.sent.size() == 1);
    const Sent& sent = part.sent[0];
    CHECK((sent.bus == 1 && sent.select == 36));
    CHECK(sent.out == std::vector{std::byte{0xA8}});
    CHECK(sent.in == (format >= SpiFormat::uint8 ? 1 : 2));
  }
  Registers low({0x7F, 0x01});
  CHECK(low.read(SpiFormat::int16) == 0x7F01);
  CHECK(low.read(SpiFormat::int8) == 0x7F);
  low.ends = false;
  CHECK(low.read(SpiFormat::uint16) == std::nullopt);
}

TEST_CASE("mcp3008: a count of its input, and nothing without a part or with a disturbed line") {
  test::Mcp3008 chip;
  test::NotingBoard board;
  board.on_spi = [&](std::uint8_t, std::uint16_t, std::span<const std::byte> out,
                     std::span<std::byte> in) {
    chip.transfer(out, in);
    return true;
  };
  const auto read = [&](unsigned input) -> std::optional<std::int32_t> {
    vm::Channel channel{};
    channel.input = static_cast<std::uint8_t>(input);
    std::int32_t raw = -1;
    const bool done = drivers::driver(vm::DriverId::mcp3008).read(board, {}, channel, raw);
    return done ? std::optional(raw) : std::nullopt;
  };
  for (unsigned input = 0; input < test::Mcp3008::kInputs; ++input)
    for (unsigned counts = 0; counts < 1024; ++counts) {
      chip.counts = {};
      chip.counts.at(input) = static_cast<std::uint16_t>(counts);
      REQUIRE(read(input) == static_cast<std::int32_t>(counts));
    }
  // The null bit, or a bit that is sent twice.
  chip.counts.fill(0x2A5);
  constexpr unsigned kNull = 8, kB0 = kNull + 10;
  for (unsigned bit = kNull; bit < 24; ++bit) {
    CAPTURE(bit);
    chip.disturbed = 1U << bit;
    const bool once = (bit > kNull && bit < kNull + 5) || bit == kB0;  // B9 to B6, and B0
    CHECK(read(3).has_value() == once);
  }
  chip.disturbed = 0;
  chip.connected = false;
  CHECK(read(3) == std::nullopt);
  chip.pulled_up = false;  // as docs/devices.md says
  CHECK(read(3) == 0);
}

TEST_CASE("mcp3008: 0 to 1023 are 0 to 100 percent") {
  Knob robot;
  for (const auto& [counts, reading] : {std::pair{1023, "100"}, {512, "50.049"}, {0, "0"}}) {
    robot.chip.counts[5] = static_cast<std::uint16_t>(counts);
    robot.rig.lines.clear();
    robot.rig.run(robot.rig.kernel.now() / 1000 + 60);
    CAPTURE(counts, robot.rig.only("input"));
    CHECK(robot.rig.only("input").find(reading) != std::string::npos);
  }
}

TEST_CASE("mcp3008: a part that is not there is told, and unknown after a while") {
  Knob robot;
  robot.chip.counts[5] = 600;
  robot.rig.run(100);
  CHECK(robot.rig.only("log") != "");
  CHECK(robot.rig.only("silent").empty());
  robot.chip.connected = false;
  robot.rig.run(400);
  CHECK(robot.rig.only("silent") != "");
  CHECK(robot.rig.only("stale") != "");
  robot.chip.connected = true;
  robot.rig.run(600);
  CHECK(robot.rig.only("answers") != "");
}

TEST_CASE("a part on SPI: the board has its bus and its select pin") {
  const vm::Sensor fine{.name = 0,
                        .driver = vm::DriverId::spi_register,
                        .bus = 0,
                        .address = 36,
                        .period_ms = 20,
                        .first_channel = 0,
                        .channel_count = 1,
                        .first_input = 0,
                        .room = 0};
  CHECK(policy::judge(fine, boards::kPins) == vm::Refusal::none);
  vm::Sensor wrong = fine;
  wrong.bus = 1;
  CHECK(policy::judge(wrong, boards::kPins) == vm::Refusal::no_bus);
  wrong = fine;
  wrong.address = 35;  // an output
  CHECK(policy::judge(wrong, boards::kPins) == vm::Refusal::no_pin);
}

TEST_CASE("a part on a bus that works by itself is asked a millisecond before it is sampled") {
  struct Asked {
    std::uint64_t at_ms;
    bool ahead;
    bool operator==(const Asked&) const = default;
  };
  Rig rig;
  std::vector<Asked> asked;
  test::Mcp3008 chip;
  chip.counts[5] = 1000;
  rig.board.asks_ahead = 1;
  rig.board.on_spi = [&](std::uint8_t, std::uint16_t, std::span<const std::byte> out,
                         std::span<std::byte> in) {
    asked.push_back({rig.kernel.now() / 1000, rig.board.asked_ahead});
    if (rig.board.asked_ahead) return false;
    chip.transfer(out, in);
    return true;
  };
  REQUIRE(rig.activate(test::compile(kKnob, std::string(kOfKnob))).ok());
  rig.run(25);
  CHECK(asked == std::vector<Asked>{{0, true}, {0, false}, {19, true}, {20, false}});
  CHECK(rig.only("log") != "");
}

namespace {

// The board's SPI bus has pins 20 to 22, which are also outputs, and 21 an input; its serial line has 22. Pin 23 may select.
constexpr policy::PinRange kBusPins[] = {{20, 22}};
constexpr policy::PinRange kSelectPins[] = {{23, 24}, {36, 37}};
constexpr policy::PinRange kInputPins[] = {{21, 21}, {40, 43}};

policy::BoardPins pins_with_bus() {
  policy::BoardPins pins = boards::kPins;
  pins.inputs = kInputPins;
  pins.analog = kInputPins;
  pins.panels = kBusPins;
  pins.spi_pins = kBusPins;
  pins.selects = kSelectPins;
  pins.player_pin = 22;
  return pins;
}

vm::Sensor part_at(std::uint16_t select) {
  vm::Sensor sensor{};
  sensor.driver = vm::DriverId::mcp3008;
  sensor.address = select;
  return sensor;
}

// The verdict about one more user of a pin; `alone`: without a part on SPI.
vm::Refusal verdict(const std::optional<vm::Sensor>& sensor,
                    const std::optional<vm::Actuator>& actuator, bool alone,
                    std::span<const vm::Value> constants = {}) {
  std::vector<vm::Sensor> sensors;
  if (!alone) sensors.push_back(part_at(36));
  if (sensor) sensors.push_back(*sensor);
  std::vector<vm::Actuator> actuators;
  if (actuator) actuators.push_back(*actuator);
  vm::Image image{};
  image.sensors = sensors;
  image.actuators = actuators;
  image.constants = constants;
  return policy::judge(image, pins_with_bus()).refusal;
}

vm::Actuator actuator_of(vm::DriverId driver, std::uint16_t pin, std::uint8_t bus = 0) {
  vm::Actuator actuator{};
  actuator.driver = driver;
  actuator.pin = pin;
  actuator.bus = bus;
  return actuator;
}

}  // namespace

TEST_CASE("a board refuses another use of a pin that its SPI bus has, if there is a part on it") {
  using enum vm::DriverId;
  const auto both = [](const std::optional<vm::Sensor>& sensor,
                       const std::optional<vm::Actuator>& actuator) {
    CHECK(verdict(sensor, actuator, true) == vm::Refusal::none);
    CHECK(verdict(sensor, actuator, false) == vm::Refusal::shared_pin);
  };
  vm::Sensor button{};
  button.driver = digital_input;
  button.address = 21;
  both(button, {});
  vm::Sensor voltage = button;
  voltage.driver = analog_input;
  both(voltage, {});
  vm::Sensor sonar{};
  sonar.driver = hc_sr04;
  sonar.bus = 20;
  sonar.address = 40;
  both(sonar, {});
  for (const std::uint16_t pin : {std::uint16_t{20}, std::uint16_t{21}, std::uint16_t{22}}) {
    both({}, actuator_of(servo, pin));
    both({}, actuator_of(motor, pin, 3));
    both({}, actuator_of(motor, 3, static_cast<std::uint8_t>(pin)));
  }
  both({}, actuator_of(ws2812_face, 21));
  both({}, actuator_of(player, 0, vm::kFirstPlayerLine));
  button.address = 40;
  CHECK(verdict(button, actuator_of(servo, 19), false) == vm::Refusal::none);
}

TEST_CASE("a part on SPI: its select pin may be an output that the board names for it") {
  policy::BoardPins pins = pins_with_bus();
  for (const auto& [select, refusal] : {std::pair{36, vm::Refusal::none},
                                        {23, vm::Refusal::none},
                                        {24, vm::Refusal::none},
                                        {25, vm::Refusal::no_pin},
                                        {20, vm::Refusal::no_pin},
                                        {40, vm::Refusal::no_pin}})
    CHECK(policy::judge(part_at(static_cast<std::uint16_t>(select)), pins) == refusal);
}

TEST_CASE("an SPI bus has its pins while a program has a part on it, and no pulse is on them") {
  Rig rig;
  rig.board.board_pins = pins_with_bus();
  unsigned changes = 0;
  rig.board.on_spi_pins = [&] {
    ++changes;
    for (const std::uint16_t pin : {std::uint16_t{20}, std::uint16_t{21}, std::uint16_t{23}})
      CHECK(rig.board.pulse(pin) == 0);
  };
  const char* const kMoves =
      "AT START DO MOVE arm TO 90deg END\nAT START DO MOVE hand TO 90deg END\n";
  const char* const kArms = R"({"actuators": [{"name": "arm", "device": "servo", "pin": 20},
                                              {"name": "hand", "device": "servo", "pin": 23}]})";
  const std::string part =
      R"({"sensors": [{"name": "knob", "device": "mcp3008", "pin": 37, "channels": {"LEVEL": {"input": 5}}},
                      {"name": "dial", "type": "I2C", "address": "0x19", "channels": {"LEVEL": {"input": 5}}}],
          "actuators": [{"name": "claw", "type": "VIRTUAL"}]})";
  const std::string both = std::string(kKnob) + "WHEN dial LEVEL > 3 DO LOG \"dial\" END\n";
  REQUIRE(rig.activate(test::compile(kMoves, kArms)).ok());
  rig.run(100);
  CHECK(rig.board.pulse(20) != 0);
  CHECK(rig.board.pulse(23) != 0);
  CHECK(rig.board.opened.empty());
  REQUIRE(rig.activate(test::compile(both, part)).ok());
  CHECK(rig.board.opened == std::vector<std::pair<std::uint8_t, std::uint16_t>>{{0, 37}});
  CHECK(changes == 1);
  REQUIRE(rig.activate(test::compile(kMoves, kArms)).ok());
  CHECK(rig.board.opened.empty());
  CHECK(changes == 2);
}
