// Melodies and tones: which, for how long, and silence whenever the speaker may not sound.
#include <regex>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/support/golden.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;

namespace {

const char* const kHornRobot = R"({"board": "microbit-v2",
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [{"name": "horn", "device": "beeper"}]})";

std::string text_of(const char* name) {
  return testing::read_file(std::filesystem::path(ROBOSYNC_SOURCE_DIR) / name);
}

// Hz and milliseconds, as in melodies.def.
using Notes = std::vector<std::pair<unsigned, unsigned>>;
std::vector<std::pair<std::string, Notes>> melodies_written() {
  std::vector<std::pair<std::string, Notes>> melodies;
  const std::string text = text_of("runtime-m4/drivers/melodies.def");
  const std::regex melody(R"(\nMELODY\((\w+),(.*))"), note(R"(NOTE\((\d+), (\d+)\))");
  for (std::sregex_iterator m(text.begin(), text.end(), melody), end; m != end; ++m) {
    Notes notes;
    const std::string body = (*m)[2];
    for (std::sregex_iterator n(body.begin(), body.end(), note); n != end; ++n)
      notes.emplace_back(std::stoul((*n)[1]), std::stoul((*n)[2]));
    melodies.emplace_back((*m)[1], notes);
  }
  return melodies;
}

// The sound from the command on, millisecond by millisecond.
struct Horn {
  explicit Horn(const std::string& body) {
    const std::string rsl = test::stops_when_far(body);
    REQUIRE(rig.activate(test::compile(rsl, kHornRobot)).ok());
    rig.feed(0, 6);
    rig.run(10);
    rig.board.sounds.clear();
    rig.feed(0, 20);
  }
  Notes listen(unsigned milliseconds) {
    Notes heard;
    for (const unsigned end = at + milliseconds; at < end; ++at) {
      rig.run(10 + at);
      const unsigned now = rig.board.sounds.empty() ? 0 : rig.board.sounds.back();
      if (heard.empty() || heard.back().first != now)
        heard.emplace_back(now, 1);
      else
        ++heard.back().second;
    }
    return heard;
  }
  unsigned now() { return rig.board.sounds.empty() ? 0 : rig.board.sounds.back(); }

  test::Rig rig;
  unsigned at = 0;
};

unsigned length_of(const Notes& notes) {
  unsigned all = 0;
  for (const auto& [hertz, milliseconds] : notes)
    all += milliseconds;
  return all;
}

}  // namespace

TEST_CASE("tones: each word is a melody, which is played as it is written, and then it is silent") {
  const auto words = nlohmann::json::parse(text_of("stdlib/devices/tones.json")).at("words");
  const auto melodies = melodies_written();
  REQUIRE(melodies.size() >= 8);
  REQUIRE(words.size() == melodies.size());
  for (std::size_t i = 0; i < melodies.size(); ++i) {
    const auto& [name, notes] = melodies[i];
    INFO(name);
    CHECK(words.at(name).at("item") == i);
    Horn horn("PLAY horn " + name);
    Notes heard = horn.listen(length_of(notes) + 100);
    REQUIRE(heard.size() == notes.size() + 1);
    CHECK(heard.back().first == 0);
    heard.pop_back();
    CHECK(heard == notes);
  }
}

TEST_CASE("tones: FOR goes on and over, or cuts off; AT is a tone of its own") {
  const Notes hello = melodies_written()[1].second;
  const unsigned once = length_of(hello);
  Horn again("PLAY horn hello FOR 1s");
  const Notes heard = again.listen(1500);
  CHECK(length_of(heard) == 1500);
  CHECK(heard.back().first == 0);
  CHECK(heard.back().second == 500);
  CHECK(heard[0] == hello[0]);
  CHECK(heard[hello.size()] == hello[0]);
  CHECK(once < 1000);
  CHECK(Horn("PLAY horn hello FOR 50ms").listen(100) == Notes{{hello[0].first, 50}, {0, 50}});
  CHECK(Horn("PLAY horn AT 440Hz FOR 200ms").listen(300) == Notes{{440, 200}, {0, 100}});
  CHECK(Horn("PLAY horn AT 440Hz").listen(1100) == Notes{{440, 1000}, {0, 100}});
  CHECK(Horn("PLAY horn AT 1Hz").listen(10) == Notes{{50, 10}});
  CHECK(Horn("PLAY horn AT 1000kHz").listen(10) == Notes{{10'000, 10}});
  CHECK(Horn("PLAY horn FOR 0ms").listen(10) == Notes{{0, 10}});
  CHECK(Horn("PLAY horn").listen(200) == Notes{{1000, 120}, {0, 80}});
}

TEST_CASE("tones: one behind the other, and STOP ends it") {
  CHECK(Horn("PLAY horn AT 440Hz FOR 30ms\nPLAY horn AT 880Hz FOR 30ms").listen(100) ==
        Notes{{440, 30}, {880, 30}, {0, 40}});
  CHECK(Horn("PLAY horn alarm FOR 5s\nWAIT 20ms\nSTOP horn").listen(50).back().first == 0);
}

TEST_CASE(
    "tones: a halt is silent at once, and so is all until it is over; so is another program") {
  for (const bool person : {false, true}) {
    Horn horn("PLAY horn alarm FOR 60s");
    horn.listen(500);
    if (person)
      horn.rig.runtime.stop();
    else
      horn.rig.feed(0, 95);
    CHECK(horn.listen(3).back().first == 0);
    CHECK(horn.listen(3000) == Notes{{0, 3000}});
  }
  Horn next("PLAY horn alarm FOR 60s");
  next.listen(100);
  CHECK(next.now() != 0);
  REQUIRE(
      next.rig.activate(test::compile("WHEN near X > 10\nDO LOG \"x\"\nEND\n", kHornRobot)).ok());
  CHECK(next.now() == 0);
  Horn cleared("PLAY horn alarm FOR 60s");
  cleared.listen(100);
  cleared.rig.runtime.clear();
  CHECK(cleared.now() == 0);
}

TEST_CASE("tones: a response that is interrupted takes its tone with it") {
  Horn horn(
      "PLAY horn alarm FOR 60s\nEND\nBEHAVIOR stops PRIORITY 90\nWHEN near X > 50\nDO STOP "
      "horn\nEND");
  horn.listen(100);
  horn.rig.feed(0, 60);
  CHECK(horn.listen(20).back().first == 0);
}

TEST_CASE("tones: the guard sounds nothing for whom it has halted, nor for who has no speaker") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  const auto wiring = test::servo_and(vm::DriverId::tones, vm::Release::hold);
  vm::Image image;
  image.actuators = wiring;
  outputs.sound(1, 440);  // no program owns it yet
  outputs.own(image);
  outputs.sound(0, 440);
  CHECK(board.sounds.empty());
  outputs.sound(1, 440);
  outputs.halt(0b10);
  outputs.sound(1, 440);
  CHECK(board.sounds == std::vector<std::uint32_t>{440, 0});
  outputs.let_go(0b10);
  outputs.sound(1, 880);
  outputs.disown();
  outputs.sound(1, 880);
  CHECK(board.sounds == std::vector<std::uint32_t>{440, 0, 880, 0});
}

TEST_CASE(
    "tones: two actuators that have the speaker are refused, and one that would hold its tone") {
  const auto judged = [](auto change) {
    std::vector<std::byte> bytes =
        test::compile("WHEN near X > 10\nDO\nPLAY horn hello\nMOVE arm TO 10deg\nEND\n",
                      R"({"board": "microbit-v2",
          "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
          "actuators": [{"name": "horn", "device": "beeper"},
                        {"name": "arm", "type": "PWM", "pin": 0, "device": "servo"}]})");
    vm::Image image;
    REQUIRE(vm::view_image(bytes, image));
    for (const vm::Actuator& actuator : image.actuators)
      change(const_cast<vm::Actuator&>(actuator));
    vm::test::repair_crc(bytes);
    return test::Rig().activate(bytes).refusal;
  };
  CHECK(judged([](vm::Actuator&) {}) == vm::Refusal::none);
  CHECK(judged([](vm::Actuator& actuator) {
          actuator.driver = vm::DriverId::tones;
          actuator.safe = vm::Release::coast;
        }) == vm::Refusal::shared_pin);
  CHECK(judged([](vm::Actuator& actuator) {
          if (actuator.driver == vm::DriverId::tones) actuator.safe = vm::Release::hold;
        }) == vm::Refusal::drives_on);
}
