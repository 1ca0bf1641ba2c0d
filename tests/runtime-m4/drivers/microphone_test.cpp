// The board's microphone: from blocks of sound to readings, blocks that are missing, and when it is on.
#include "runtime-m4/drivers/microphone.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using drivers::Heard;
using test::Rig;

namespace {

using Block = std::array<std::int16_t, boards::kSoundBlock>;

const std::string kRobot = R"({"board": "microbit-v2",
  "sensors": [{"name": "microphone", "device": "microphone"}],
  "algorithms": [{"name": "ear", "module": "sound_events", "input": "microphone"}],
  "actuators": []})";
const char* const kClaps = "WHEN ear EVENT IS clap DO LOG \"clap\" END\n";
const char* const kLoud = "WHEN microphone LOUDNESS > 60dB DO LOG \"loud\" END\n";

Block noise(std::mt19937& draw, double height) {
  std::normal_distribution<double> value(0, height);
  Block block;
  for (std::int16_t& sample : block)
    sample = static_cast<std::int16_t>(std::clamp(value(draw), -32000.0, 32000.0));
  return block;
}

// A room, and what is heard in it at some of its blocks.
struct Room {
  explicit Room(const char* program, const std::string& robot = kRobot) {
    rig.board.sound_of = [this](boards::SoundBlock sound) {
      const unsigned now = calls++;
      if (lost && lost(now)) return false;
      std::ranges::copy(heard && heard(now) ? *heard(now) : noise(draw, 20), sound.begin());
      return true;
    };
    REQUIRE(rig.activate(test::compile(program, robot)).ok());
  }
  std::size_t told(std::string_view what) const {
    std::size_t found = 0;
    for (const std::string& line : rig.lines)
      found += line.find(what) != std::string::npos ? 1U : 0U;
    return found;
  }
  unsigned calls = 0;
  std::mt19937 draw{1};
  std::function<std::optional<Block>(unsigned)> heard;
  std::function<bool(unsigned)> lost;
  Rig rig;
};

}  // namespace

TEST_CASE("microphone: its channels are what the ear hears in the same blocks") {
  test::NotingBoard board;
  std::mt19937 draw(2);
  std::deque<Block> blocks;
  for (int i = 0; i < 8; ++i) {
    Block block = noise(draw, 100);
    for (std::size_t s = 0; s < block.size(); ++s)
      block[s] = static_cast<std::int16_t>(
          block[s] +
          4000 * std::sin(2 * std::numbers::pi * 220 * static_cast<double>(i * block.size() + s) /
                          drivers::kEarRate));
    blocks.push_back(block);
  }
  std::size_t next = 0;
  board.sound_of = [&](boards::SoundBlock sound) {
    std::ranges::copy(blocks.at(next++), sound.begin());
    return true;
  };
  drivers::Ear ear;
  drivers::Microphone microphone;
  for (const Block& block : blocks) {
    const Heard wanted = ear.hear(block);
    const drivers::BandValues bands = ear.bands();
    const std::array values{wanted.loudness, wanted.highs, wanted.pitch, wanted.clarity,
                            bands[0],        bands[1],     bands[2],     bands[3]};
    for (std::uint8_t input = 0; input < values.size(); ++input) {
      vm::Channel channel{};
      channel.input = input;
      vm::Value value = 0;
      REQUIRE(microphone.sample(board, input == 0, channel, value));
      CHECK(value == values[input]);
    }
  }
  CHECK(ear.hear(blocks[0]).pitch != 0);
  vm::Channel none{};
  none.input = 8;
  vm::Value value = 0;
  next = 0;
  CHECK_FALSE(microphone.sample(board, true, none, value));
}

TEST_CASE("microphone: after a gap nothing of the sound before it is heard") {
  test::NotingBoard board;
  std::mt19937 draw(3);
  Block loud;
  loud.fill(20'000);
  Block soft = noise(draw, 20);
  for (std::int16_t& sample : soft)
    sample = static_cast<std::int16_t>(sample + 15'000);  // as it is on
  drivers::Microphone microphone;
  vm::Channel highs{};
  highs.input = 1;
  vm::Value value = 0;
  const auto hear = [&](const Block* block) {
    board.sound_of = [=](boards::SoundBlock sound) {
      if (block != nullptr) std::ranges::copy(*block, sound.begin());
      return block != nullptr;
    };
    return microphone.sample(board, true, highs, value);
  };
  REQUIRE(hear(&loud));
  REQUIRE(hear(&soft));
  CHECK(value > 45 * vm::kScale);  // the step between the two
  REQUIRE(hear(&loud));
  CHECK_FALSE(hear(nullptr));
  REQUIRE(hear(&soft));
  CHECK(value < 35 * vm::kScale);
}

TEST_CASE("microphone: after a gap no pitch is that of the sound before it") {
  const auto tone = [](double hertz) {
    Block block;
    for (std::size_t s = 0; s < block.size(); ++s)
      block[s] =
          static_cast<std::int16_t>(8000 * std::sin(2 * std::numbers::pi * hertz *
                                                    static_cast<double>(s) / drivers::kEarRate));
    return block;
  };
  test::NotingBoard board;
  const Block before = tone(200), after = tone(310);
  const Block* next = &before;
  board.sound_of = [&](boards::SoundBlock sound) {
    if (next != nullptr) std::ranges::copy(*next, sound.begin());
    return next != nullptr;
  };
  drivers::Microphone microphone;
  vm::Channel pitch{};
  pitch.input = 2;
  vm::Value value = 0;
  for (int i = 0; i < 3; ++i)
    REQUIRE(microphone.sample(board, true, pitch, value));
  next = nullptr;
  CHECK_FALSE(microphone.sample(board, true, pitch, value));
  next = &after;
  REQUIRE(microphone.sample(board, true, pitch, value));
  const Heard wanted = drivers::Ear().hear(after);
  CHECK(value == wanted.pitch);
  pitch.input = 3;
  REQUIRE(microphone.sample(board, false, pitch, value));
  CHECK(value == wanted.clarity);
}

TEST_CASE("microphone: a clap is heard, and one block that is lost is none") {
  const auto clap = [](unsigned now) -> std::optional<Block> {
    std::mt19937 draw(now);
    if (now == 60) return noise(draw, 9000);
    if (now == 61) return noise(draw, 1500);
    return std::nullopt;
  };
  Room room(kClaps);
  room.heard = clap;
  room.rig.run(3000);
  CHECK(room.told("clap") > 0);

  Room quiet(kClaps);
  quiet.lost = [](unsigned now) { return now % 7 == 0; };
  quiet.rig.run(3000);
  CHECK(quiet.told("clap") == 0);
}

TEST_CASE("microphone: its first samples are discarded, while its voltage settles") {
  Room room(kLoud);
  room.heard = [](unsigned now) -> std::optional<Block> {
    std::mt19937 draw(now);
    if (now < 6) return noise(draw, 9000);
    return std::nullopt;
  };
  room.rig.run(1000);
  CHECK(room.told("loud") == 0);

  Room later(kLoud);
  later.heard = [](unsigned now) -> std::optional<Block> {
    std::mt19937 draw(now);
    if (now == 6) return noise(draw, 9000);
    return std::nullopt;
  };
  later.rig.run(1000);
  CHECK(later.told("loud") > 0);
}

TEST_CASE("microphone: one that is silent from the start, or later, is told") {
  Room room(kLoud);
  room.lost = [](unsigned now) { return now < 9 || now > 40; };
  room.rig.run(119);
  CHECK(room.told("silent") == 0);
  room.rig.run(125);
  CHECK(room.told("silent") == 1);
  room.rig.run(700);
  CHECK(room.told("answers") == 1);
  room.rig.run(1200);
  CHECK(room.told("silent") == 2);
}

TEST_CASE("microphone: it is on while a program uses it, and only then") {
  Rig rig;
  const std::string fed = R"({"board": "microbit-v2",
    "sensors": [{"name": "microphone", "type": "VIRTUAL", "device": "microphone"}], "actuators": []})";
  const std::string real = R"({"board": "microbit-v2",
    "sensors": [{"name": "microphone", "device": "microphone"}], "actuators": []})";
  REQUIRE(rig.activate(test::compile(kLoud, fed)).ok());
  rig.run(100);
  for (const bool on : rig.board.listened)
    CHECK_FALSE(on);
  REQUIRE(rig.activate(test::compile(kLoud, real)).ok());
  rig.run(200);
  REQUIRE_FALSE(rig.board.listened.empty());
  CHECK(rig.board.listened.back());
  REQUIRE(rig.activate(test::compile(kLoud, fed)).ok());
  rig.run(300);
  CHECK_FALSE(rig.board.listened.back());
  REQUIRE(rig.activate(test::compile(kLoud, real)).ok());
  CHECK(rig.board.listened.back());
  rig.runtime.clear();
  CHECK_FALSE(rig.board.listened.back());
}

TEST_CASE(
    "microphone: where the board has none, and with the type VIRTUAL, the image is that of a fed "
    "sensor") {
  const auto robot = [](const std::string& board, const std::string& type) {
    return R"({"board": ")" + board + R"(", "sensors": [{"name": "microphone", )" + type +
           R"("device": "microphone"}], "actuators": []})";
  };
  const auto driver = [](const std::vector<std::byte>& bytes) {
    vm::Image image;
    REQUIRE(vm::verify(bytes, {}, image).ok());
    return image.sensors[0].driver;
  };
  const std::string is_virtual = R"("type": "VIRTUAL", )";
  CHECK(driver(test::compile(kLoud, robot("microbit-v2", ""))) == vm::DriverId::microphone);
  CHECK(driver(test::compile(kLoud, robot("microbit-v2", is_virtual))) ==
        vm::DriverId::virtual_sensor);
  CHECK(test::compile(kLoud, robot("mps2-an386", "")) ==
        test::compile(kLoud, robot("mps2-an386", is_virtual)));
  CHECK(driver(test::compile(kLoud, robot("mps2-an386", ""))) == vm::DriverId::virtual_sensor);
}
