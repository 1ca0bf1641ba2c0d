// Recordings of sound in scenarios: what the robot hears of them.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "tests/rsc/process.hpp"

using Catch::Contains;
using robosync::test::Folder;
using robosync::test::Outcome;
using robosync::test::rsc;

namespace {

void put(std::string& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i)
    bytes += static_cast<char>(value >> 8 * i);
}

// A WAV file of so many samples a second; `sound` gives that of a time in seconds, from -1 to 1.
template <class Sound>
std::string wav(std::uint32_t rate, std::uint16_t channels, double seconds, Sound sound) {
  const auto frames = static_cast<std::uint32_t>(seconds * rate);
  std::string bytes = "RIFF";
  put(bytes, 36 + frames * channels * 2, 4);
  bytes += "WAVEfmt ";
  put(bytes, 16, 4);
  put(bytes, 1, 2);
  put(bytes, channels, 2);
  put(bytes, rate, 4);
  put(bytes, rate * channels * 2, 4);
  put(bytes, channels * 2U, 2);
  put(bytes, 16, 2);
  bytes += "data";
  put(bytes, frames * channels * 2, 4);
  for (std::uint32_t i = 0; i < frames; ++i)
    for (int c = 0; c < channels; ++c)
      put(bytes, static_cast<std::uint32_t>(static_cast<int>(sound(double(i) / rate) * 32000)), 2);
  return bytes;
}

std::string robot(const Folder& folder) {
  folder.write("robot.json", R"({
    "sensors": [{"name": "microphone", "type": "VIRTUAL", "device": "microphone"}],
    "actuators": [{"name": "voice", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "ear", "module": "sound_events", "input": "microphone"}]})");
  folder.write("play.json", R"({"duration": "5s", "stimuli": [
    {"sound": "room.wav", "sensor": "microphone", "at": "500ms"}]})");
  return folder.write("robot.rsl", R"(WHEN ear EVENT IS clap
DO SAY "clap"
END
WHEN ear EVENT IS speech
DO SAY "speech"
END
)");
}

Outcome play(const Folder& folder) {
  return rsc({"run", robot(folder), "--scenario", folder.path("play.json"), "--all"});
}

// A burst of noise at 1 s, for 30 ms; from 2 s on a buzz that is like a voice.
double room(double at) {
  static std::minstd_rand random(1);
  const double noise = static_cast<double>(random() % 2001) / 1000 - 1;
  if (at >= 1 && at < 1.03) return noise * 0.6;
  if (at >= 2 && at < 3) return std::fmod(at * 150, 1) < 0.1 ? 0.4 : -0.04;
  return noise * 0.001;
}

}  // namespace

TEST_CASE("a robot hears a clap and a voice in a recording, whatever its rate and channels") {
  for (const auto& [rate, channels] : {std::pair{8000, 1}, {16000, 2}, {44100, 1}}) {
    INFO(rate);
    const Folder folder;
    folder.write("room.wav", wav(static_cast<std::uint32_t>(rate),
                                 static_cast<std::uint16_t>(channels), 4, room));
    const Outcome ran = play(folder);
    INFO(ran.out << ran.err);
    CHECK(ran.exit == 0);
    CHECK_THAT(ran.out, Contains("SAY clap") && Contains("SAY speech"));
    CHECK_THAT(ran.out, Contains("4.701 s  microphone LOUDNESS is unknown"));  // it ends at 4.5
    CHECK(play(folder).out == ran.out);
  }
}

TEST_CASE(
    "a microphone on the board hears a recording as a fed one does, but for its first 120 ms") {
  const std::string sound = wav(8000, 1, 4, room);
  const auto heard = [&](const std::string& type, const std::string& at) {
    const Folder folder;
    folder.write("room.wav", sound);
    const std::string program = robot(folder);
    folder.write("robot.json", R"({"board": "microbit-v2",
      "sensors": [{"name": "microphone", )" +
                                   type + R"("device": "microphone"}],
      "actuators": [{"name": "voice", "type": "VIRTUAL", "device": "speaker"}],
      "algorithms": [{"name": "ear", "module": "sound_events", "input": "microphone"}]})");
    folder.write("play.json", R"({"duration": "5s", "stimuli": [
      {"sound": "room.wav", "sensor": "microphone", "at": ")" +
                                  at + R"("}]})");
    const Outcome ran = rsc({"run", program, "--scenario", folder.path("play.json"), "--all"});
    INFO(ran.out << ran.err);
    CHECK(ran.exit == 0);
    return ran.out;
  };
  const std::string is_virtual = R"("type": "VIRTUAL", )";
  const std::string real = heard("", "500ms");
  CHECK_THAT(real, Contains("SAY clap") && Contains("SAY speech"));
  CHECK_THAT(real, Contains("4.701 s  microphone LOUDNESS is unknown"));
  // Afterwards the algorithm goes on with what was fed last, until that is stale.
  const auto while_it_lasts = [](const std::string& out) {
    return out.substr(0, std::min(out.find("   4.6"), out.find("   4.7")));
  };
  CHECK(while_it_lasts(real).size() > 10'000);
  CHECK(while_it_lasts(real) == while_it_lasts(heard(is_virtual, "500ms")));
  CHECK_THAT(heard(is_virtual, "0s"), Contains("0.020 s  microphone LOUDNESS"));
  const std::string early = heard("", "0s");
  CHECK_THAT(early, Contains("0.120 s  microphone LOUDNESS"));
  CHECK_THAT(early, !Contains("0.100 s  microphone"));
}

TEST_CASE("the singing teacher nods to whoever sings its note, and comes for a whistle") {
  // From 4 s on a voice, a G and then an A; at 9 s a whistle that rises by an octave in half a second.
  const auto singing = [](double at) {
    const auto voice = [&](double hertz) {
      double sum = 0;
      for (int n = 1; n <= 6; ++n)
        sum += std::sin(2 * M_PI * hertz * n * at) / n;
      return sum * 0.2;
    };
    if (at >= 4 && at < 5.5) return voice(196);
    if (at >= 6 && at < 7.5) return voice(220);
    if (at >= 9 && at < 9.5) return 0.4 * std::sin(2 * M_PI * (800 + 800 * (at - 9)) * (at - 9));
    return 0.001 * std::sin(at * 1000);
  };
  const Folder folder;
  folder.write("song.wav", wav(16000, 1, 11, singing));
  folder.write("song.json", R"({"duration": "11s", "stimuli": [
    {"sound": "song.wav", "sensor": "microphone"},
    {"at": "0s", "sensor": "hand", "channel": "TOUCH", "value": "no"},
    {"at": "1s", "sensor": "hand", "channel": "TOUCH", "value": "yes"}]})");
  const std::string teacher = EXAMPLES "/singing_teacher/robot.rsl";
  const Outcome ran = rsc({"run", teacher, "--scenario", folder.path("song.json")});
  INFO(ran.out << ran.err);
  CHECK(ran.exit == 0);
  const std::size_t higher = ran.out.find("voice SAY Higher"), nod = ran.out.find("PERFORM nod"),
                    yes = ran.out.find("voice SAY Yes?");
  CHECK(higher < nod);
  CHECK(nod < yes);
  CHECK(yes != std::string::npos);
  CHECK_THAT(ran.out, !Contains("Lower"));
}

TEST_CASE("a file that is no sound, is too coarse or is not there is said to be so") {
  const Folder folder;
  CHECK(play(folder).exit == 3);
  CHECK_THAT(play(folder).err,
             Contains("play.json:2: ") && Contains("room.wav: there is no such file"));
  folder.write("room.wav", "no sound");
  CHECK(play(folder).exit == 1);
  CHECK_THAT(play(folder).err, Contains("room.wav: it is not a sound file: "));
  folder.write("room.wav", wav(4000, 1, 1, [](double) { return 0; }));
  CHECK_THAT(play(folder).err, Contains("it has 4000 samples a second; at least 8000 are needed"));
  folder.write("room.wav", wav(8000, 1, 1, [](double) { return 0; }));
  const std::string program = robot(folder);
  folder.write("play.json", R"({"stimuli": [{"sound": "room.wav", "sensor": "voice"}]})");
  CHECK_THAT(rsc({"run", program, "--scenario", folder.path("play.json")}).err,
             Contains("play.json:1: "));
}
