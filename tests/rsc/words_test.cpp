// Words that are taught: the file that they stand in, the channel that has them, and how rsc teach asks the program for it.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "companion/words_file.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using companion::read_words;
using companion::TaughtWord;
using companion::write_words;
using test::Folder;
using test::Outcome;

namespace {

TaughtWord word(const std::string& name, std::size_t samples, std::mt19937& random) {
  TaughtWord result{name, {}, static_cast<std::uint32_t>(random() % 551)};
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t frames =
        companion::kLeastFrames + random() % (companion::kMostFrames - companion::kLeastFrames + 1);
    companion::Sample& sample = result.samples.emplace_back(frames, own_words_frame{});
    for (own_words_frame& frame : sample)
      for (std::uint32_t& value : frame.values)
        value = static_cast<std::uint32_t>(random()) & 0x3FFF'FFFFU;
  }
  return result;
}

std::string file_of(const std::vector<std::string>& names) {
  std::mt19937 random(5);
  std::vector<TaughtWord> words;
  for (const std::string& name : names)
    words.push_back(word(name, 3, random));
  return write_words(words);
}

bool same(const std::vector<TaughtWord>& a, const std::vector<TaughtWord>& b) {
  return std::ranges::equal(a, b, [](const TaughtWord& one, const TaughtWord& other) {
    const auto alike = [](const own_words_frame& a_frame, const own_words_frame& b_frame) {
      return std::ranges::equal(a_frame.values, b_frame.values);
    };
    return one.name == other.name && one.most == other.most &&
           std::ranges::equal(one.samples, other.samples,
                              [&](const companion::Sample& x, const companion::Sample& y) {
                                return std::ranges::equal(x, y, alike);
                              });
  });
}

// Of the words, whatever their text was, what the file promises.
void check_promises(const companion::ReadWords& read) {
  CHECK(read.trouble.empty() != (read.line != 0));
  if (!read.trouble.empty()) CHECK(read.words.empty());
  CHECK(read.words.size() <= companion::kMostWords);
  for (const TaughtWord& one : read.words) {
    CHECK(companion::can_be_word(one.name));
    CHECK((!one.samples.empty() && one.samples.size() <= companion::kMostSamples));
    for (const companion::Sample& sample : one.samples)
      CHECK((sample.size() >= companion::kLeastFrames && sample.size() <= companion::kMostFrames));
  }
}

constexpr const char* kRobot = R"({
  "actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
  "algorithms": [{"name": "voice", "module": "own_words", "input": "microphone",
                  "config": {"words": "my.words", "shown_for": "1s"}}]
})";
constexpr const char* kProgram = "WHEN voice WORD BECOMES hello\nDO SAY \"Hello\"\nEND\n";

// A robot that is taught, and a program of the module that says what it is asked for.
struct Taught : Folder {
  Taught() {
    write("robot.json", kRobot);
    program = write("robot.rsl", kProgram);
    const std::string script =
        write("robosync-own-words", "#!/bin/sh\nfor a in \"$@\"; do echo \"[$a]\"; done\nexit 2\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  }
  Outcome teach(std::vector<std::string> more) const {
    more.insert(more.begin(), "teach");
    more.insert(more.end(), {"--config", path("robot.json"), "--programs", path("")});
    return test::rsc(more);
  }
  std::string program;
};

}  // namespace

// ---- the file

TEST_CASE("words are read as they were written") {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    std::vector<TaughtWord> words;
    for (std::size_t count = random() % 5; words.size() < count;)
      words.push_back(word("w" + std::to_string(words.size()), 1 + random() % 8, random));
    const std::string text = write_words(words);
    const companion::ReadWords read = read_words(text);
    CHECK(read.trouble.empty());
    CHECK(same(read.words, words));
    CHECK(write_words(read.words) == text);
  }
}

TEST_CASE("the largest file of words is not too large") {
  std::mt19937 random(2);
  std::vector<TaughtWord> words;
  while (words.size() < companion::kMostWords) {
    TaughtWord& one = words.emplace_back(
        word(std::string(28, 'x') + std::to_string(100 + words.size()), 8, random));
    for (companion::Sample& sample : one.samples)
      sample.resize(companion::kMostFrames);
  }
  const std::string text = write_words(words);
  CHECK(text.size() <= companion::kLargestFile);
  CHECK(read_words(text).words.size() == companion::kMostWords);
  words.push_back(word("more", 1, random));
  CHECK_THAT(read_words(write_words(words)).trouble, Contains("more words"));
}

TEST_CASE("of a file that was cut off or damaged nothing is used") {
  const std::string text = file_of({"hello"});
  for (std::size_t length = 0; length < text.size(); ++length)
    CHECK(!read_words(std::string_view(text).substr(0, length)).trouble.empty());
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string flipped = text;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (at % 8)));
    const companion::ReadWords read = read_words(flipped);
    CHECK(!read.trouble.empty());
    CHECK(read.words.empty());
  }
}

TEST_CASE("whatever a text is, its words are words") {
  std::mt19937 random(3);
  const std::string text = file_of({"hello", "stop"});
  const std::string body = text.substr(0, text.find("sum "));
  const std::string parts[] = {"word ", "sample ", "sum ", "\n", "8",
                               "92",    "hello",   "o0",   " ",  "robosync words 2\n"};
  int understood = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string changed = body;
    for (std::size_t edits = random() % 3; edits > 0; --edits) {
      const std::size_t at = random() % (changed.size() + 1);
      changed.replace(at, random() % 3 == 0 ? random() % 200 : 0,
                      parts[random() % std::size(parts)]);
    }
    // With its right sum, so that it is not refused for that.
    const std::string with_sum = companion::with_sum(changed);
    check_promises(read_words(with_sum));
    understood += read_words(with_sum).trouble.empty();
  }
  CHECK(understood > 500);
}

TEST_CASE("what can be the name of a word") {
  for (const char* name : {"hello", "_", "a1", "Very_Well", "nones"})
    CHECK(companion::can_be_word(name));
  for (const char* name : {"", "1a", "a b", "a-b", "gr\xC3\xBC", "none", "None", "UNKNOWN", "a\n"})
    CHECK(!companion::can_be_word(name));
  CHECK(companion::can_be_word(std::string(31, 'x')));
  CHECK(!companion::can_be_word(std::string(32, 'x')));
}

// ---- the channel

TEST_CASE("a program may compare with the words that were taught, and with none") {
  const Taught robot;
  robot.write("my.words", file_of({"hello", "stop"}));
  robot.write(
      "robot.rsl",
      std::string(kProgram) +
          "WHEN voice WORD IS none FOR 5s\nDO SAY \"Silence\"\nEND\n"
          "TEST \"it hears\"\n  AT 0s voice WORD = \"none\"\n  AT 1s voice WORD = \"hello\"\n"
          "  EXPECT SAY \"Hello\" WITHIN 20ms\nEND\n");
  const Outcome tested = test::rsc({"test", robot.program});
  INFO(tested.out << tested.err);
  CHECK(tested.exit == 0);
  robot.write("robot.rsl", "WHEN voice WORD BECOMES helo\nDO SAY \"Hello\"\nEND\n");
  const Outcome misspelt = test::rsc({"check", robot.program});
  CHECK(misspelt.exit == 1);
  CHECK_THAT(misspelt.err, Contains("did you mean `hello`?"));
}

TEST_CASE("words that are not there, or no words, are one error") {
  const Taught robot;
  const auto says = [&](const std::string& why) {
    const Outcome outcome = test::rsc({"check", robot.program});
    INFO(outcome.err << outcome.out);
    CHECK(outcome.exit == 1);
    CHECK_THAT(
        outcome.err,
        Contains("error[E0211]: `voice` has no words: " + robot.path("my.words") + " " + why) &&
            Contains("robot.json:4:") && Contains("rsc teach voice WORD"));
    CHECK_THAT(outcome.out, Contains("1 error"));
  };
  says("is not there");
  robot.write("my.words", file_of({"hello"}).substr(0, 500));
  says("cannot be used: line 1: it is broken or cut off");
  robot.write("my.words", std::string(1 << 21, 'x'));
  says("cannot be used: line 1: it is larger");
  std::filesystem::remove(robot.path("my.words"));
  REQUIRE(mkfifo(robot.path("my.words").c_str(), 0600) == 0);
  says("is not a file");
}

TEST_CASE(
    "words that an earlier version was taught are one error, which says to teach them again") {
  const Taught robot;
  robot.write("my.words", companion::with_sum("robosync words 1\nword hello\n"));
  const Outcome outcome = test::rsc({"check", robot.program});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("earlier version of RoboSync: teach them again"));
  CHECK_THAT(outcome.out, Contains("1 error"));
}

// ---- on the board

constexpr const char* kEars = R"({%s
  "sensors": [{"name": "microphone", "type": "VIRTUAL", "device": "microphone"}],
  "actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
  "algorithms": [{"name": "voice", "module": "own_words", "input": "microphone",
                  "config": {"words": "my.words"}%s}]
})";

std::string listens(const std::string& first, const std::string& last = "") {
  std::string text = kEars;
  text.replace(text.find("%s"), 2, first);
  text.replace(text.find("%s"), 2, last);
  return text;
}

TEST_CASE("a robot with a microphone listens itself, unless robot.json says otherwise") {
  const Taught robot;
  robot.write("my.words", file_of({"hello", "stop"}));
  const auto dumped = [&] {
    REQUIRE(test::rsc({"compile", robot.program, "-o", robot.path("robot.rsb")}).exit == 0);
    return test::rsc({"dump", robot.path("robot.rsb")}).out;
  };
  robot.write("robot.json", listens(""));
  CHECK_THAT(dumped(), Contains("voice: own_words of channel 0 on") && Contains("BANDS_4") &&
                           Contains("labels none | hello | stop"));
  CHECK_THAT(robot.teach({"voice", "--list"}).out, Contains("[--list]"));
  CHECK(test::rsc({"companion", "--config", robot.path("robot.json"), "--port", "none"}).exit == 1);
  robot.write("robot.json", listens("", R"(, "on": "companion")"));
  CHECK_THAT(dumped(), !Contains("own_words of channel") && !Contains("BANDS_4"));
}

TEST_CASE("a robot that cannot listen itself, or to so much, is told what can") {
  const Taught robot;
  const std::string elsewhere = "`\"on\": \"companion\"` lets a computer beside the robot listen";
  const auto says = [&](const std::string& why) {
    const Outcome outcome = test::rsc({"check", robot.program});
    INFO(outcome.err << outcome.out);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains(why) && Contains(elsewhere));
    CHECK_THAT(outcome.out, Contains("1 error"));
  };
  robot.write("my.words", file_of({"hello"}));
  robot.write("robot.json", R"({"board": "mps2-an386",
    "actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "voice", "module": "own_words", "input": "microphone",
                    "config": {"words": "my.words"}, "on": "board"}]})");
  says("there is no sensor `microphone`");
  robot.write("robot.json", R"({
    "sensors": [{"name": "pad", "type": "VIRTUAL", "channels": {"FORCE": {"range": [0, 20]}}}],
    "actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "voice", "module": "own_words", "input": "pad",
                    "config": {"words": "my.words"}, "on": "board"}]})");
  says("`own_words` reads the spectrum of a microphone, but `pad` has none");
  std::mt19937 random(4);
  std::vector<TaughtWord> words;
  while (words.size() < 9) {
    words.push_back(word("w" + std::to_string(words.size()), 3, random));
    for (companion::Sample& sample : words.back().samples)
      sample.resize(companion::kMostFrames);
  }
  words.front().name = "hello";
  robot.write("my.words", write_words(words));
  robot.write("robot.json", listens(""));
  says("`voice` was taught 9 words, which take 9963 numbers; the board holds 8192");
}

TEST_CASE("the file is called like the algorithm, unless robot.json says otherwise") {
  const Taught robot;
  robot.write("robot.json",
              R"({"actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "voice", "module": "own_words"}]})");
  robot.write("voice.words", file_of({"hello"}));
  CHECK(test::rsc({"check", robot.program}).exit == 0);
  robot.write("robot.json",
              R"({"actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "voice", "module": "own_words", "config": {"word": "voice.words"}}]})");
  CHECK_THAT(test::rsc({"check", robot.program}).err, Contains("did you mean `words`?"));
}

// ---- rsc teach

TEST_CASE("rsc teach asks the program of the module, and ends as it does") {
  const Taught robot;
  const std::string words = "[--words]\n[" + robot.path("my.words") + "]\n";
  const Outcome outcome = robot.teach({"Voice", "hello", "one.wav", "t w o.wav"});
  CHECK(outcome.exit == 2);
  CHECK(outcome.out ==
        words + "[--teach]\n[hello]\n[--recording]\n[one.wav]\n[--recording]\n[t w o.wav]\n");
  CHECK(robot.teach({"voice", "hello", "--microphone", "default"}).out ==
        words + "[--teach]\n[hello]\n[--source]\n[default]\n");
  CHECK(robot.teach({"voice", "--forget", "hello"}).out == words + "[--forget]\n[hello]\n");
  robot.write("my.words", "broken");  // that is for the program to say
  CHECK(robot.teach({"voice", "--list"}).out == words + "[--list]\n[yes]\n");
}

TEST_CASE("what rsc teach was asked wrongly is said before anything begins") {
  const Taught robot;
  const auto fails = [&](const std::vector<std::string>& how, int exit, const std::string& why) {
    const Outcome outcome = robot.teach(how);
    CHECK(outcome.exit == exit);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains(why));
  };
  fails({"voice"}, 2, "name a word to teach");
  fails({"voice", "hello", "one.wav", "--list"}, 2, "one of the three");
  fails({"voice", "hello", "one.wav", "--forget", "stop"}, 2, "one of the three");
  fails({"voice", "hello"}, 2, "give recordings of the word");
  fails({"voice", "one.wav"}, 2, "`one.wav` is not a word: write rsc teach voice WORD one.wav");
  fails({"voice", "hello", "one.wav", "--microphone", "default"}, 2, "give recordings of the word");
  fails({"voise", "--list"}, 1, "has no `voise` that can be taught words; it has voice");
  std::filesystem::remove(robot.path("robosync-own-words"));
  fails({"voice", "--list"}, 3, "the program for the module own_words is not installed");
  robot.write("robot.json", R"({"algorithms": [{"name": "voice", "module": "command_words"}]})");
  fails({"voice", "--list"}, 1, "has no algorithm that can be taught words");
  robot.write("robot.json", "{");
  fails({"voice", "--list"}, 1, "robot.json:1:");
}
