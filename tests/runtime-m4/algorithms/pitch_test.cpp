// How pitch interprets the pitches that a microphone hears, sample by sample.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/algorithms/modules.hpp"

using robosync::test::Module;

namespace {

enum { kPitch, kNote, kCents, kTone };
const char* const kNotes[] = {"c",       "c_sharp", "d",       "d_sharp", "e",       "f",
                              "f_sharp", "g",       "g_sharp", "a",       "a_sharp", "b"};

struct Song : Module {
  explicit Song(std::vector<std::int32_t> config = {})
      : Module(*pitch_describe(ROBOSYNC_ABI), std::move(config)) {
    (void)quiet(20);
  }

  // Returns the changes of NOTE and TONE, with the time since it began.
  std::string hold(double hertz, int ms, int clarity = 95, int loudness = 60) {
    std::string text;
    for (int at = 0; at < ms; at += 20) {
      const std::string changed =
          put({loudness * 1000, loudness * 1000 - 10'000,
               static_cast<std::int32_t>(hertz * 10) * 100, clarity * 1000});
      for (const std::string name : {"NOTE", "TONE"})
        if (const std::size_t begin = changed.find(name); begin != std::string::npos)
          text += (text.empty() ? "" : ", ") + std::to_string(at) +
                  changed.substr(begin + 4, changed.find(' ', begin + 5) - begin - 4);
    }
    return text;
  }
  std::string quiet(int ms) { return hold(0, ms, 0, 30); }
  double hertz() const { return output(kPitch) / 1000.0; }
  int cents() const { return output(kCents) / 1000; }
};

double note(int semitones_above_a4, int cents = 0, double tuning = 440) {
  return tuning * std::pow(2, (semitones_above_a4 + cents / 100.0) / 12);
}

}  // namespace

TEST_CASE(
    "a tone is one after three samples, and over after three without; then its pitch is unknown") {
  Song song;
  CHECK(song.quiet(100).empty());
  CHECK(song.output(kNote) == 0);
  CHECK(song.output(kTone) == 0);
  CHECK(song.output(kPitch) == ROBOSYNC_UNKNOWN);
  CHECK(song.hold(440, 40).empty());
  CHECK(song.hold(440, 40) == "0 a, 0 steady");
  CHECK(song.hertz() == 440);
  CHECK(song.quiet(40).empty());
  CHECK(song.hold(440, 20).empty());
  CHECK(song.quiet(60) == "40 none, 40 none");
  CHECK(song.output(kPitch) == ROBOSYNC_UNKNOWN);
  CHECK(song.output(kCents) == ROBOSYNC_UNKNOWN);
}

TEST_CASE(
    "every note has its name, in every octave and tuning, and so has what is a little off it") {
  for (const double tuning : {400.0, 415.0, 440.0, 480.0})
    for (int semitones = -26; semitones <= 24; ++semitones)
      for (const int off : {-45, -20, 0, 20, 45}) {
        const double hertz = note(semitones, off, tuning);
        if (hertz < 80 || hertz > 2000) continue;
        CAPTURE(tuning, semitones, off);
        Song song({60'000, 40'000, 80'000, 2'000'000, static_cast<std::int32_t>(tuning) * 1000});
        CHECK(song.hold(hertz, 60) ==
              std::string("40 ") + kNotes[(semitones + 33) % 12] + ", 40 steady");
        CHECK(std::abs(song.cents() - off) <= 3);  // a tenth of 80 Hz are 2 cents
        CHECK(std::abs(song.hertz() - hertz) <= 0.6);
      }
}

TEST_CASE("a note is kept until the tone is 60 cents off") {
  Song song;
  CHECK(song.hold(note(0, 55), 60) == "40 a_sharp, 40 steady");
  CHECK(song.hold(note(0, 45), 200).empty());
  CHECK(std::abs(song.cents() + 55) <= 3);
  CHECK(song.hold(note(0, 20), 200) == "0 a");
  CHECK(song.hold(note(0, 57), 200).empty());
  CHECK(std::abs(song.cents() - 57) <= 3);
  Song low;  // b and c, between which the octaves meet
  CHECK(low.hold(note(2, 45), 60) == "40 b, 40 steady");
  CHECK(low.hold(note(2, 57), 200).empty());
  CHECK(low.hold(note(2, 75), 200) == "0 c");
  CHECK(low.hold(note(2, 43), 200).empty());
  CHECK(std::abs(low.cents() + 57) <= 3);
}

TEST_CASE("an octave that is misheard for a moment does not show, one that lasts does") {
  for (const double wrong : {220.0, 880.0, 1320.0}) {
    Song song;
    CHECK(song.hold(440, 200) == "40 a, 40 steady");
    CHECK(song.hold(wrong, 40).empty());
    CHECK(song.hold(440, 20).empty());
    CHECK(song.hold(wrong, 40).empty());
    CHECK(song.hertz() == 440);
    (void)song.hold(wrong, 20);
    CHECK(song.hertz() == wrong);
  }
}

TEST_CASE("what is too soft, not clear or out of the range is no tone") {
  Song song({60'000, 40'000, 200'000, 1'000'000});
  CHECK(song.hold(440, 200, 59).empty());
  CHECK(song.hold(440, 200, 95, 39).empty());
  CHECK(song.hold(199.9, 200).empty());
  CHECK(song.hold(1000.1, 200).empty());
  CHECK(song.hold(200, 60, 60, 40) == "40 g, 40 steady");
  CHECK(song.hold(1000, 60) == "40 b");
  // Single, unrelated samples are not a tone.
  Song noise;
  for (const double hertz : {100, 300, 120, 700, 90, 1400, 200, 240, 500})
    CHECK_THAT(noise.hold(hertz, 40), !Catch::Contains("steady"));
}

TEST_CASE("what begins again and again is no tone") {
  Song song;
  for (int i = 0; i < 10; ++i) {
    CHECK(song.hold(440, 40).empty());
    CHECK(song.quiet(20).empty());
  }
}

TEST_CASE("a tone that glides rises or falls, a trembling one is steady") {
  Song song;
  CHECK(song.hold(400, 400) == "40 g, 40 steady");
  std::string rising;
  for (int ms = 0; ms < 400; ms += 20)
    rising += song.hold(400 * std::pow(2, ms / 400.0), 20) + " ";
  CHECK_THAT(rising, Catch::Contains("rising") && !Catch::Contains("falling"));
  CHECK_THAT(song.hold(800, 400), Catch::Contains("steady"));
  std::string falling;
  for (int ms = 0; ms < 400; ms += 20)
    falling += song.hold(800 * std::pow(2, ms / -400.0), 20) + " ";
  CHECK_THAT(falling, Catch::Contains("falling") && !Catch::Contains("rising"));
  // A slow one, too, until after its end.
  Song slow;
  (void)slow.hold(note(-3), 400);
  std::string slowly;
  for (int ms = 0; ms < 400; ms += 20)
    slowly += slow.hold(note(-3, ms * 3 / 4), 20) + " ";
  CHECK_THAT(slowly, Catch::Contains("rising"));
  CHECK(slow.hold(note(0), 400) == "100 steady");
  Song vibrato;
  (void)vibrato.hold(440, 200);
  for (int ms = 0; ms < 2000; ms += 20)
    CHECK(vibrato.hold(note(0, static_cast<int>(45 * std::sin(ms * 0.0377))), 20).empty());
  Song melody;  // another note is no slide
  (void)melody.hold(440, 400);
  CHECK(melody.hold(660, 400) == "40 e");
}

TEST_CASE("whatever the microphone says, the outputs lie in their ranges") {
  Song song({20'000, 0, 80'000, 2'000'000, 400'000, 2000});
  const robosync_description& names = *pitch_describe(ROBOSYNC_ABI);
  std::uint32_t random = 1;
  for (int i = 0; i < 20'000; ++i) {
    random = random * 1'664'525 + 1'013'904'223;
    const auto hertz = static_cast<std::int32_t>(i % 50 < 40 ? random % 2'000'001 : random);
    song.put({100'000, 0, i % 3 != 0 ? 1'900'000 : hertz, 100'000});
    for (std::size_t o = 0; o < 4; ++o)
      if (song.output(o) != ROBOSYNC_UNKNOWN) {
        CHECK(song.output(o) >= names.outputs[o].least);
        CHECK(song.output(o) <= names.outputs[o].most);
      }
  }
}
