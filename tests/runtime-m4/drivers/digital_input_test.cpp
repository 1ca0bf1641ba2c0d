// Buttons and switches: from the level of a pin to readings, and the debouncing of contacts.
#include <array>
#include <random>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Rig;

namespace {

constexpr std::uint64_t kMillisecond = 1000;
// Data sheets of push buttons and switches specify at most 5 to 15 ms.
constexpr std::uint64_t kBouncing = 18 * kMillisecond;
constexpr std::uint64_t kBetweenSamples = 20 * kMillisecond;

const char* const kOfButton = R"(
WHEN it IS pressed DO LOG "down" END
WHEN it IS released DO LOG "up" END
)";

std::string with_button(const std::string& more = "") {
  return R"({"sensors": [{"name": "it", "type": "GPIO", "pin": 41, "device": "button")" + more +
         "}]}";
}

std::vector<std::string> logs(const Rig& rig) {
  std::vector<std::string> said;
  for (const std::string& line : rig.lines)
    if (line.find(" log ") != std::string::npos) said.push_back(line);
  return said;
}

// A contact to ground on a pin that is pulled up. While it bounces, the level is random.
struct Contact {
  std::uint64_t closes, opens;
  std::uint32_t seed;

  bool high(std::uint64_t now) const {
    const auto bounces = [&](std::uint64_t since) {
      return now >= since && now < since + kBouncing;
    };
    if (bounces(closes) || bounces(opens)) {
      std::mt19937 random(seed ^ static_cast<std::uint32_t>(now / 100));
      return (random() & 1) != 0;
    }
    return now < closes || now >= opens;
  }
};

}  // namespace

TEST_CASE("digital_input: the active level reads as 1, on the sensor's pin") {
  test::NotingBoard board;
  std::int32_t raw = 7;
  vm::Sensor sensor{};
  sensor.address = 41;
  for (const auto active : {vm::ActiveLevel::low, vm::ActiveLevel::high})
    for (const bool high : {false, true}) {
      board.level = [&](std::uint16_t pin) { return pin == 41 ? high : !high; };
      sensor.bus = static_cast<std::uint8_t>(active);
      REQUIRE(drivers::driver(vm::DriverId::digital_input).read(board, sensor, {}, raw));
      CHECK(raw == (high == (active == vm::ActiveLevel::high) ? 1 : 0));
    }
}

TEST_CASE("robot.json says which level is the active one; it is low where it says nothing") {
  for (const auto& [more, high] : {std::pair<const char*, bool>{"", false},
                                   {R"(, "active": "low")", false},
                                   {R"(, "active": "high")", true}}) {
    Rig rig;
    rig.board.level = [high = high](std::uint16_t) { return high; };
    REQUIRE(rig.activate(test::compile(kOfButton, with_button(more))).ok());
    rig.run(100);
    REQUIRE(logs(rig).size() == 1);
    CHECK(logs(rig).front().find("down") != std::string::npos);
  }
}

TEST_CASE("however a contact bounces, it is pressed once and released once, soon enough") {
  std::mt19937 random(41);
  for (unsigned round = 0; round < 200; ++round) {
    Rig rig;
    const std::uint64_t closes = 40 * kMillisecond + random() % kBetweenSamples;
    const Contact contact{closes, closes + kBouncing + kBetweenSamples + random() % kBetweenSamples,
                          static_cast<std::uint32_t>(random())};
    rig.board.level = [&](std::uint16_t) { return contact.high(rig.kernel.now()); };
    REQUIRE(rig.activate(test::compile(kOfButton, with_button())).ok());
    rig.run(300);
    const std::vector<std::string> said = logs(rig);
    CAPTURE(round, contact.closes, contact.opens, said);
    REQUIRE(said.size() == 3);  // it was up when the program began
    CHECK(said[1].find("down") != std::string::npos);
    CHECK(said[2].find("up") != std::string::npos);
    CHECK(std::stoull(said[1]) * kMillisecond <= contact.closes + kBouncing + kBetweenSamples);
    CHECK(std::stoull(said[2]) * kMillisecond <= contact.opens + kBouncing + kBetweenSamples);
  }
}

TEST_CASE("board_part: a touch of the logo and the temperature are readings of the board") {
  Rig rig;
  std::int32_t touched = 1, quarters = 80;
  bool known = true;
  rig.board.measure_of = [&](boards::Part part, std::int32_t& raw) {
    raw = part == boards::Part::logo ? touched : quarters;
    return known;
  };
  REQUIRE(rig.activate(test::compile(R"(
WHEN logo IS pressed DO LOG "down" END
WHEN logo IS released DO LOG "up" END
WHEN thermometer TEMPERATURE > 21C DO LOG "warm" END
)",
                                     R"({"board": "microbit-v2", "sensors": [
  {"name": "logo", "device": "logo"}, {"name": "thermometer", "device": "thermometer"}]})"))
              .ok());
  rig.run(15);
  CHECK(logs(rig).empty());  // a result of before the program
  touched = 0;
  rig.run(100);
  REQUIRE(logs(rig).size() == 1);
  CHECK(logs(rig)[0].find("up") != std::string::npos);
  touched = 1;
  quarters = 85;
  rig.run(3000);
  REQUIRE(logs(rig).size() == 3);
  CHECK(logs(rig)[1].find("down") != std::string::npos);
  CHECK(logs(rig)[2].find("warm") != std::string::npos);
  known = false;
  rig.run(6000);
  CHECK(rig.only("stale") != "");
}

TEST_CASE("an input that cannot measure an echo is refused as one's, and may be read") {
  static constexpr std::array<policy::PinRange, 1> kEchoes{{{41, 41}}};
  for (const int pin : {40, 41}) {
    Rig rig;
    rig.board.board_pins.echoes = kEchoes;
    const std::string echo =
        R"({"sensors": [{"name": "it", "type": "GPIO", "trigger": 3, "echo": )" +
        std::to_string(pin) + R"(, "device": "hc-sr04"}]})";
    const vm::Verdict verdict =
        rig.activate(test::compile("WHEN it < 30cm DO LOG \"near\" END", echo));
    CHECK(verdict.refusal == (pin == 41 ? vm::Refusal::none : vm::Refusal::no_input));
  }
  Rig rig;
  rig.board.board_pins.echoes = kEchoes;
  const std::string button =
      R"({"sensors": [{"name": "it", "type": "GPIO", "pin": 40, "device": "button"}]})";
  CHECK(rig.activate(test::compile(kOfButton, button)).ok());
}
