// Which of the words that it was taught own_words hears, frame by frame. The words are synthetic: two loud bands that move.
#include "runtime-m4/algorithms/own_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/algorithms/modules.hpp"
#include "runtime-m4/algorithms/own_words_distance.h"

namespace {

using Frames = std::vector<own_words_frame>;

constexpr int kPeriodMs = 20, kQuiet = 6, kLoudest = 45;

own_words_frame frame_of(const std::function<double(int band)>& level) {
  own_words_frame frame{};
  for (int band = 0; band < OWN_WORDS_BANDS; ++band) {
    const int value = std::clamp(static_cast<int>(std::lround(level(band))), 0, 63);
    frame.values[band / 5] |= static_cast<std::uint32_t>(value) << (band % 5 * 6);
  }
  return frame;
}

double together(double a, double b) {
  return 2 * std::log2(std::exp2(a / 2) + std::exp2(b / 2));
}

// A word: where its two bands go, from its beginning to its end.
struct Word {
  std::array<double, 4> low, high;

  own_words_frame at(double part, double loud, double noise) const {
    const auto along = [&](const std::array<double, 4>& way) {
      const double place = part * 2.999;
      const auto i = static_cast<std::size_t>(place);
      return way[i] + (way[i + 1] - way[i]) * (place - static_cast<double>(i));
    };
    return frame_of([&](int band) {
      const double first = band - along(low), second = band - along(high);
      const double tone = loud - std::min(first * first * 2, second * second * 2 + 6);
      return together(tone, noise);
    });
  }
  Frames said(int frames, double loud = kLoudest, double noise = kQuiet) const {
    Frames result;
    for (int i = 0; i < frames; ++i)
      result.push_back(at(i / (frames - 1.0), loud, noise));
    return result;
  }
};

const Word kHello{{2, 4, 6, 5}, {11, 12, 16, 10}};
const Word kStop{{7, 6, 3, 3}, {18, 17, 12, 9}};
const Word kOther{{3, 3, 9, 4}, {15, 9, 14, 18}};

Frames sample_of(const Word& word, int frames) {
  Frames sample = word.said(frames, kLoudest, 0);
  for (own_words_frame& frame : sample) {
    own_words_frame below{};
    for (int band = 0; band < OWN_WORDS_BANDS; ++band) {
      const std::uint32_t level = frame.values[band / 5] >> (band % 5 * 6) & 63;
      below.values[band / 5] |= (kLoudest + 1 - std::min(level, kLoudest + 1U)) << (band % 5 * 6);
    }
    frame = below;
  }
  return sample;
}

struct Listener {
  explicit Listener(std::vector<std::int32_t> taught, int strict = 50)
      : constants(std::move(taught)) {
    config[0] = strict * 1000;
    state.resize(module.state_bytes(config.data()) / 8 + 1);
    module.init(state.data(), config.data(), kPeriodMs);
    (void)hear(Word{}.said(60, 0));
  }

  void hear(const own_words_frame& frame) {
    std::array<std::int32_t, 4> inputs;
    std::ranges::transform(frame.values, inputs.begin(),
                           [](std::uint32_t value) { return static_cast<std::int32_t>(value); });
    const robosync_block block = {inputs.data(), &word, config.data()};
    show();
    module.process(state.data(), nullptr, &block);
    while (at_once && own_words_is_busy(state.data()) != 0) {
      show();
      word = static_cast<std::int32_t>(own_words_go_on(state.data(), &block)) * 1000;
    }
  }
  // The words that are shown one after the other, "1 0", with how many frames after the first one each begins.
  std::string hear(const Frames& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::int32_t before = word;
      hear(frames[i]);
      if (word == before || before < 0) continue;
      text += (text.empty() ? "" : " ") + std::to_string(word / 1000);
      since.push_back(static_cast<int>(i));
    }
    return text;
  }
  std::string hear(const Word& said, int frames, double loud = kLoudest, double noise = kQuiet,
                   int pause = 60) {
    since.clear();
    Frames all = said.said(frames, loud, noise);
    const Frames after = Word{}.said(pause, 0, noise);
    all.insert(all.end(), after.begin(), after.end());
    return hear(all);
  }
  void show() {
    robosync_show(reinterpret_cast<robosync_taught*>(state.data()), constants.data(),
                  static_cast<std::uint32_t>(constants.size()));
  }

  const robosync_module& module = own_words_module;
  std::vector<std::int32_t> constants;
  std::array<std::int32_t, 2> config{50'000, 500};
  std::vector<std::uint64_t> state;
  std::int32_t word = ROBOSYNC_UNKNOWN;
  bool at_once = false;
  std::vector<int> since;
};

void teach(std::vector<std::int32_t>& constants, std::uint32_t number, const Word& word,
           std::uint32_t most = 400) {
  for (const int frames : {28, 33, 39}) {
    const Frames sample = sample_of(word, frames);
    constants.push_back(own_words_header(number, static_cast<std::uint32_t>(frames), most));
    for (const own_words_frame& frame : sample)
      constants.insert(constants.end(), std::begin(frame.values), std::end(frame.values));
  }
}

std::vector<std::int32_t> two_words() {
  std::vector<std::int32_t> constants;
  teach(constants, 0, kHello);
  teach(constants, 1, kStop);
  return constants;
}

}  // namespace

TEST_CASE(
    "a word that was taught is heard 0.3 s after its end, at any of its speeds, and shown for a "
    "while") {
  for (const int frames : {26, 30, 36, 44}) {
    Listener robot(two_words());
    CHECK(robot.hear(kHello, frames) == "1 0");
    REQUIRE(robot.since.size() == 2);
    CHECK(robot.since[0] > frames + 10);
    CHECK(robot.since[0] < frames + 32);
    CHECK(robot.since[1] - robot.since[0] == 25);
    CHECK(robot.hear(kStop, frames) == "2 0");
  }
}

TEST_CASE(
    "a softer voice and a noisy room make no difference, and a word that was not taught is none") {
  Listener robot(two_words());
  CHECK(robot.hear(kStop, 32, 34) == "2 0");
  CHECK(robot.hear(kOther, 32).empty());
  Listener noisy(two_words());
  (void)noisy.hear(Word{}.said(200, 0, 22));
  CHECK(noisy.hear(kHello, 32, kLoudest, 22) == "1 0");
  CHECK(noisy.hear(kOther, 32, kLoudest, 22).empty());
}

TEST_CASE("what is too far from a word is not it: its own limit, and how strict the robot is") {
  std::vector<std::int32_t> narrow;
  teach(narrow, 0, kHello, 0);
  CHECK(Listener(narrow).hear(kHello, 30).empty());
  Word near = kHello;
  near.high[1] -= 3;
  near.low[2] += 2;
  CHECK(Listener(two_words(), 10).hear(near, 30) == "1 0");
  CHECK(Listener(two_words(), 200).hear(near, 30).empty());
  CHECK(Listener(two_words(), 200).hear(kHello, 33) == "1 0");
}

TEST_CASE("what is shorter or longer than a word is none, and no word breaks what follows") {
  Listener robot(two_words());
  CHECK(robot.hear(kHello, 3).empty());
  CHECK(robot.hear(kHello, 150).empty());
  CHECK(robot.hear(kHello, 30) == "1 0");
}

TEST_CASE("with many words the work takes many blocks, and what is said meanwhile is heard, too") {
  std::vector<std::int32_t> many;
  for (std::uint32_t number = 0; number < 16; ++number)
    teach(many, number,
          number == 15   ? kStop
          : number == 14 ? kHello
                         : kOther,
          number < 14 ? 0 : 400);
  Listener robot(many);
  Listener computer(many);
  computer.at_once = true;
  CHECK(robot.hear(kHello, 34, kLoudest, kQuiet, 140) == "15 0");
  CHECK(computer.hear(kHello, 34, kLoudest, kQuiet, 140) == "15 0");
  CHECK(robot.since[0] > computer.since[0] + 5);
  CHECK(robot.hear(kHello, 34, kLoudest, kQuiet, 17).empty());
  CHECK(robot.hear(kStop, 34, kLoudest, kQuiet, 160) == "15 0 16 0");
}

TEST_CASE("it is taught up to 24 words; a sample that cannot be one, and all behind it, is none") {
  std::vector<std::int32_t> last;
  teach(last, 23, kHello);
  CHECK(Listener(last).hear(kHello, 33) == "24 0");
  const std::int32_t long_one = own_words_header(0, OWN_WORDS_MOST_FRAMES + 1, 400);
  for (const std::int32_t header :
       {own_words_header(24, 33, 400), own_words_header(0, 0, 400), long_one}) {
    std::vector<std::int32_t> constants = two_words();
    std::vector<std::int32_t> broken{header};
    broken.resize(1 + std::size_t{OWN_WORDS_VALUES} * (header >> 8 & 0xFF));
    constants.insert(constants.end(), broken.begin(), broken.end());
    teach(constants, 2, kOther);
    Listener robot(constants);
    CHECK(robot.hear(kStop, 33) == "2 0");
    CHECK(robot.hear(kOther, 33).empty());
    CHECK(robot.hear(kStop, 33) == "2 0");
  }
  std::vector<std::int32_t> cut = two_words();
  cut.pop_back();
  Listener robot(cut);
  for (int times = 0; times < 2; ++times)
    CHECK(robot.hear(kStop, 33) == "2 0");
}

TEST_CASE("it begins anew when it is told to, also in the middle of its work") {
  std::vector<std::int32_t> many;
  for (std::uint32_t number = 0; number < 16; ++number)
    teach(many, number, number == 0 ? kHello : kOther, number == 0 ? 400 : 0);
  Listener robot(many);
  const auto begin = [&] { robot.module.init(robot.state.data(), robot.config.data(), kPeriodMs); };
  (void)robot.hear(kHello, 33, kLoudest, kQuiet, 20);
  REQUIRE(own_words_is_busy(robot.state.data()) != 0);
  begin();
  CHECK(own_words_is_busy(robot.state.data()) == 0);
  CHECK(robot.hear(Word{}.said(60, 0)).empty());
  const own_words_frame silence = Word{}.said(2, 0).front();
  (void)robot.hear(kHello.said(33));
  for (int frames = 0; frames < 100 && robot.word != 1000; ++frames)
    robot.hear(silence);
  CHECK(robot.word == 1000);
  begin();
  robot.hear(silence);
  CHECK(robot.word == 0);
}

TEST_CASE("a word that is soft is heard after one that is loud") {
  Listener robot(two_words());
  CHECK(robot.hear(kHello, 33, 58) == "1 0");
  CHECK(robot.hear(kStop, 33, 30) == "2 0");
}

TEST_CASE("whatever it was taught, and hears, it stays within its state and goes on") {
  std::mt19937 draw(3);
  for (int round = 0; round < 40; ++round) {
    std::vector<std::int32_t> constants(draw() % 3000);
    for (std::int32_t& one : constants)
      one = static_cast<std::int32_t>(draw() % 4 == 0 ? draw() % 0x60 << 8 | draw() % 30 : draw());
    Listener robot(constants);
    CHECK(robot.hear(kHello, 30).find('-') == std::string::npos);
    for (int i = 0; i < 300; ++i) {
      own_words_frame frame{};
      for (std::uint32_t& value : frame.values)
        value = i / 40 % 2 == 0 ? static_cast<std::uint32_t>(draw()) : 0;
      robot.hear(frame);
      CHECK((robot.word >= 0 && robot.word <= 24'000));
    }
  }
}

TEST_CASE("the distance of samples") {
  const Frames a = sample_of(kHello, 30), b = sample_of(kHello, 36), c = sample_of(kStop, 32);
  const auto distance = [](const Frames& one, const Frames& other) {
    return own_words_distance(one.data(), static_cast<std::uint32_t>(one.size()), other.data(),
                              static_cast<std::uint32_t>(other.size()));
  };
  CHECK(distance(a, a) == 0);
  CHECK(distance(a, b) < 200);
  CHECK(distance(a, c) > 600);
  const Frames silence(30, frame_of([](int) { return 63; }));
  CHECK(distance(silence, a) == OWN_WORDS_APART);
  CHECK(distance(sample_of(kHello, 12), sample_of(kHello, 60)) == OWN_WORDS_APART);
}
