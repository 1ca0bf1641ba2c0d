// How sound_events interprets loudness, high tones and pitch, with times.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/algorithms/modules.hpp"

using robosync::test::Module;

namespace {

struct Room : Module {
  Room() : Module(*sound_events_describe(ROBOSYNC_ABI)) { hold(30, 27, 0, 0, 400); }

  // Feeds such a sound for `ms`; returns the events that begin, with the time since it began.
  std::string hold(int loudness, int highs, int pitch, int clarity, int ms) {
    std::string text;
    for (int at = 0; at < ms; at += 20) {
      const std::string changed =
          put({loudness * 1000, highs * 1000, pitch * 1000, clarity * 1000});
      if (const std::size_t event = changed.find("EVENT "); event != std::string::npos)
        text += (text.empty() ? "" : ", ") + std::to_string(at) +
                changed.substr(5, changed.find(' ', 6) - 5);
    }
    return text;
  }
  std::string noise(int loudness, int ms) { return hold(loudness, loudness + 3, 0, 0, ms); }
  std::string voice(int loudness, int ms) { return hold(loudness, loudness - 10, 150, 80, ms); }
  std::string quiet(int ms) { return hold(30, 27, 0, 0, ms); }
};

}  // namespace

TEST_CASE("a clap is loud at once, like noise, and over at once") {
  Room room;
  CHECK(room.noise(70, 40) == "0 sound");
  CHECK(room.noise(55, 40) == "0 clap");  // known when it fades
  CHECK(room.quiet(600) == "260 none");   // 300 ms later
}

TEST_CASE("what lasts, what swells and what has no high tones is no clap") {
  Room lasting;
  CHECK(lasting.noise(70, 400) == "0 sound");
  CHECK(lasting.quiet(100) == "0 none");
  Room swelling;
  for (int loudness = 30; loudness < 72; loudness += 3)
    CHECK_THAT(swelling.noise(loudness, 40), !Catch::Contains("clap"));
  CHECK(swelling.quiet(100) == "0 none");
  Room thud;
  CHECK(thud.hold(70, 55, 0, 0, 40) == "0 sound");
  CHECK(thud.quiet(100) == "0 none");
}

TEST_CASE("somebody who speaks has a voice for a fifth of a second, and may pause") {
  Room room;
  CHECK(room.voice(55, 200) == "0 sound, 180 speech");
  CHECK(room.voice(55, 400).empty());
  CHECK(room.noise(45, 100).empty());  // an s
  CHECK(room.voice(55, 200).empty());
  CHECK(room.quiet(2000) == "1180 none");
}

TEST_CASE("a loud sound within others is no clap, nor is one with a voice in it") {
  Room busy;
  (void)busy.noise(45, 100);
  CHECK_THAT(busy.noise(70, 40), !Catch::Contains("clap"));
  CHECK_THAT(busy.noise(45, 40), !Catch::Contains("clap"));
  Room shout;
  CHECK_THAT(shout.voice(70, 80), !Catch::Contains("clap"));
  CHECK_THAT(shout.quiet(200), !Catch::Contains("clap"));
  Room whistle;
  (void)whistle.noise(70, 40);
  CHECK_THAT(whistle.hold(70, 73, 200, 90, 40), !Catch::Contains("clap"));
  CHECK_THAT(whistle.quiet(200), !Catch::Contains("clap"));
}

TEST_CASE("what is always there is no sound any more") {
  Room room;
  CHECK(room.noise(50, 60'000) == "0 sound, 7000 none");
  CHECK(room.noise(75, 40) == "0 sound");
  CHECK(room.noise(50, 40) == "0 clap");
}
