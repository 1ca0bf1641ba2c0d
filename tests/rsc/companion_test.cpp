// rsc companion: robots that run in this process, and programs of modules that do all that one must not.
#include "rsc/companion/companion.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "companion/words_file.hpp"
#include "compiler/reading.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/companion/outlet.hpp"
#include "rsc/companion/said.hpp"
#include "rsc/companion/worker.hpp"
#include "tests/rsc/device.hpp"

using namespace robosync;
using Catch::Contains;
using test::Device;
using test::Folder;
using test::Outcome;
using test::Running;
using namespace std::chrono_literals;

namespace {

constexpr const char* kHearing = R"({
  "sensors": [{"name": "key", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
  "actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
  "algorithms": [
    {"name": "voice", "module": "command_words", "input": "microphone", "on": "companion", "rate": "20Hz"},
    {"name": "face", "module": "face_detect", "rate": "20Hz", "config": {"view": "90deg"}}
  ]
})";

constexpr const char* kListens = R"(WHEN voice WORD IS hello
DO LOG "heard hello"
END
WHEN voiceWord IS "very_well"
DO LOG "heard well"
END
WHEN voice WORD IS NOT silence AND voice WORD IS Hello
DO LOG "again"
END
WHEN face COUNT > 0
DO LOG "seen"
END
)";

constexpr const char* kSeeing = R"({
  "actuators": [{"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
  "algorithms": [{"name": "eyes", "module": "objects", "config": {"vivid": "40%"}}]
})";

// A robot.json and a program on it, and programs of modules, which are shell scripts.
struct Ears : Device {
  Ears() {
    write("robot.json", kHearing);
    write("robot.rsl", kListens);
    works("command-words", "while sleep 0.05; do echo WORD silence; done");
    works("face-detect", "while sleep 0.05; do echo COUNT 0; done");
  }

  void works(const std::string& module, const std::string& script) const {
    const std::string file = write("robosync-" + module, "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  std::vector<std::string> call(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"companion", "--config", path("robot.json"), "--programs", path(""),
                               "--port", port});
    return more;
  }
  void upload() const {
    const Outcome outcome = run({"upload", program});
    INFO(outcome.err);
    REQUIRE(outcome.exit == 0);
  }
};

// Waits until it has printed `text` on stdout `times` times, for ten seconds.
bool has_put(const Running& running, const std::string& text, std::size_t times = 1) {
  for (int i = 0; i < 1000; ++i) {
    const std::string out = running.out();
    std::size_t count = 0;
    for (std::size_t at = out.find(text); at != std::string::npos; at = out.find(text, at + 1))
      ++count;
    if (count >= times) return true;
    std::this_thread::sleep_for(10ms);
  }
  UNSCOPED_INFO(running.out() << running.err());
  return false;
}

vm::Image view_of(const compiler::Result& result) {
  vm::Image image;
  REQUIRE(vm::view_image(result.image, image));
  return image;
}

compiler::Result compiled(const std::string& program) {
  compiler::Result result =
      compiler::compile({"robot.rsl", program}, {"robot.json", kHearing},
                        {.source_lines = false, .algorithms = tool::algorithm_modules()});
  INFO(compiler::render_human(result.diagnostics, result.sources, false));
  REQUIRE(!result.image.empty());
  return result;
}

std::vector<std::string> labels_of(const vm::Image& image, const vm::Channel& channel) {
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < channel.label_count; ++i)
    labels.emplace_back(image.string(image.labels[channel.first_label + i]));
  return labels;
}

}  // namespace

// ---- for the board they are sensors that are fed

TEST_CASE("the words of a companion's channel are those that the program compares it with") {
  const compiler::Result result = compiled(kListens);
  const vm::Image image = view_of(result);
  REQUIRE(image.channels.size() == 2);
  const vm::Channel& word = image.channels[0];
  CHECK(labels_of(image, word) == std::vector<std::string>{"silence", "hello", "very_well"});
  CHECK(word.min == 0);
  CHECK(word.max == 2 * vm::kScale);
  CHECK(word.stale_ms == 250);
  CHECK(image.sensors[word.sensor].driver == vm::DriverId::virtual_sensor);
  CHECK(image.sensors[word.sensor].period_ms == 0);
  CHECK(image.string(image.channels[1].name) == "COUNT");
}

TEST_CASE("one word, or none, is enough") {
  const compiler::Result quiet = compiled("WHEN voice WORD IS silence\nDO LOG \"q\"\nEND\n");
  CHECK(labels_of(view_of(quiet), view_of(quiet).channels[0]) ==
        std::vector<std::string>{"silence"});
}

TEST_CASE("a channel that is one of some words has all of them, in their order") {
  const Folder folder;
  folder.write("robot.json", kSeeing);
  const std::string program =
      folder.write("robot.rsl",
                   "WHEN eyes COLOR BECOMES red\nDO LOG \"red\"\nEND\n"
                   "TEST \"it sees\"\n  AT 0s eyes COLOR = \"none\"\n  AT 1s eyes COLOR = \"red\"\n"
                   "  EXPECT LOG \"red\" WITHIN 20ms\nEND\n");
  CHECK(test::rsc({"test", program}).exit == 0);
  const auto result = compiler::compile(
      {"robot.rsl", "WHEN eyes COLOR IS green AND eyes MARKER = 7\nDO LOG \"g\"\nEND\n"},
      {"robot.json", kSeeing}, {.source_lines = false, .algorithms = tool::algorithm_modules()});
  const vm::Image image = view_of(result);
  const vm::Channel& color = image.channels[0];
  CHECK(labels_of(image, color) ==
        std::vector<std::string>{"none", "orange", "yellow", "green", "blue", "purple", "red"});
  CHECK(color.max == 6 * vm::kScale);
  CHECK(tool::parse_value(image, color, "red") == 6 * vm::kScale);
  CHECK(!tool::parse_value(image, color, "pink"));
  CHECK(tool::parse_value(image, image.channels[1], "-1.000") == -vm::kScale);
  CHECK(!tool::parse_value(image, image.channels[1], "1000"));
}

TEST_CASE("a colour that there is not, and a parameter out of its range, is one clear error") {
  const Folder folder;
  const auto check = [&](const std::string& config, const std::string& program) {
    folder.write("robot.json", config);
    return test::rsc({"check", folder.write("robot.rsl", program)});
  };
  const std::string red = "WHEN eyes COLOR IS red\nDO LOG \"red\"\nEND\n";
  CHECK(check(kSeeing, red).exit == 0);
  const Outcome color = check(kSeeing, "WHEN eyes COLOR IS gren\nDO LOG \"red\"\nEND\n");
  CHECK(color.exit == 1);
  CHECK_THAT(color.err, Contains("gren") && Contains("did you mean `green`?"));
  std::string pale = kSeeing;
  pale.replace(pale.find("40%"), 3, "5%");
  const Outcome vivid = check(pale, red);
  CHECK(vivid.exit == 1);
  CHECK_THAT(vivid.err, Contains("this must be from 10% to 100%"));
}

TEST_CASE("TESTs and scenarios feed a companion's channels as any sensor's") {
  const Folder folder;
  folder.write("robot.json", kHearing);
  const std::string program = folder.write(
      "robot.rsl",
      std::string(kListens) +
          "TEST \"it hears\"\n  AT 0s voice WORD = \"silence\"\n"
          "  AT 1s voice WORD = \"hello\"\n  EXPECT LOG \"heard hello\" WITHIN 20ms\nEND\n");
  const Outcome tested = test::rsc({"test", program});
  INFO(tested.out << tested.err);
  CHECK(tested.exit == 0);
  const std::string scenario = folder.write(
      "s.json",
      R"({"duration": "2s", "stimuli": [{"at": "1s", "sensor": "voice", "value": "very_well"}]})");
  const Outcome run = test::rsc({"run", program, "--scenario", scenario});
  CHECK(run.exit == 0);
  CHECK_THAT(run.out, Contains("heard well"));
  CHECK_THAT(run.out, !Contains("heard hello"));
  folder.write("s.json", R"({"stimuli": [
    {"from": "1s", "to": "2s", "sensor": "voice", "ramp": ["silence", "very_well"]}]})");
  const Outcome ramp = test::rsc({"run", program, "--scenario", scenario});
  CHECK(ramp.exit == 1);
  CHECK_THAT(ramp.err, Contains("s.json:2: WORD has words, and nothing lies between two words: "
                                "write a stimulus with `at` and `value` for each"));
}

// ---- what is said

TEST_CASE("only words of the channel and numbers in its range are readings") {
  const compiler::Result result =
      compiled(std::string(kListens) + "WHEN face ANGLE > 3deg\nDO LOG \"left\"\nEND\n");
  const vm::Image image = view_of(result);
  const auto value = [&](std::size_t channel, std::string_view text) {
    return tool::parse_value(image, image.channels[channel], text);
  };
  CHECK(value(0, "hello") == vm::kScale);
  for (const char* wrong : {"Hello", "1", "hello ", "", "hell", "nan"})
    CHECK(!value(0, wrong));
  CHECK(value(1, "3") == 3 * vm::kScale);
  CHECK(value(1, "20.000") == 20 * vm::kScale);
  for (const char* wrong : {"21", "-1", "nan", "inf", "1e1", "0x1", "3 ", " 3", "", "+3", "3m",
                            "99999999999999999999999999", "20.001"})
    CHECK(!value(1, wrong));
  CHECK(value(2, "-12.3456") == -12'346);
  CHECK(tool::parse_said("WORD hello")->value == "hello");
  for (const char* wrong : {"", " ", "WORD", "WORD ", " hello"})
    CHECK(!tool::parse_said(wrong));
}

TEST_CASE("what changes is fed, and what stays the same before it grows stale") {
  using Clock = tool::Outlet::Clock;
  const Clock::time_point start{};
  tool::Outlet outlet(false, 300ms);
  CHECK(!outlet.next(start));
  outlet.said(5);
  CHECK(outlet.next(start) == 5);
  outlet.said(5);
  CHECK(!outlet.next(start + 99ms));
  CHECK(!outlet.next(start + 100ms));  // nobody has said it again
  outlet.said(5);
  CHECK(outlet.next(start + 100ms) == 5);
  outlet.said(6);
  outlet.said(7);
  CHECK(outlet.next(start + 110ms) == 7);
  CHECK(!outlet.next(start + 110ms));
  outlet.said(7);
  outlet.forget();
  CHECK(!outlet.next(start + 120ms));
  outlet.said(7);
  CHECK(outlet.next(start + 120ms) == 7);
}

TEST_CASE("no word is lost, and not more are kept than there is room for") {
  const tool::Outlet::Clock::time_point now{};
  tool::Outlet outlet(true, 300ms);
  for (const vm::Value word : {1, 0, 0, 2, 0})
    outlet.said(word);
  for (const vm::Value word : {1, 0, 2, 0})
    CHECK(outlet.next(now) == word);
  CHECK(!outlet.next(now));
  for (vm::Value word = 1; word <= 1000; ++word)
    outlet.said(word);
  int kept = 0;
  while (outlet.next(now))
    ++kept;
  CHECK(kept == 16);
}

// ---- the programs of modules

namespace {

// Looks at a program until it has said `count` lines, or is no more, or for ten seconds.
struct Watched {
  explicit Watched(const std::string& script)
      : worker({"ear", "/bin/sh", {"-c", script}, 50ms},
               [this](const std::string& what) { reports += what + "\n"; }) {}

  template <typename Until>
  bool until(const Until& done) {
    for (int i = 0; i < 2000 && !done(); ++i) {
      worker.look(tool::Worker::Clock::now(), [this](const std::string& line) {
        lines.push_back(line);
        return line.starts_with("WORD ");
      });
      std::this_thread::sleep_for(5ms);
    }
    return done();
  }
  bool reports_contain(const std::string& text) {
    return until([&] { return reports.find(text) != std::string::npos; });
  }

  std::string reports;
  std::vector<std::string> lines;
  tool::Worker worker;
};

}  // namespace

TEST_CASE("a program that ends well is over, one that was asked wrongly is given up") {
  Watched over("echo WORD a; echo WORD b");
  CHECK(over.until([&] { return over.worker.is_over(); }));
  CHECK(over.lines == std::vector<std::string>{"WORD a", "WORD b"});
  Watched wrong("echo no such word >&2; exit 2");
  CHECK(wrong.until([&] { return wrong.worker.is_given_up(); }));
  CHECK(wrong.reports == "no such word\n");
}

TEST_CASE("a program that dies is started again, each time later") {
  Watched dies("echo WORD a; echo 'it is\tgone' >&2; exit 3");
  CHECK(dies.reports_contain("restarting it in 1 s"));
  CHECK_THAT(dies.reports, Contains("has ended (exit 3): it is?gone; restarting it in 0.5 s"));
  CHECK(dies.lines.size() == 2);
  Watched crashes("kill -SEGV $$");
  CHECK(crashes.reports_contain("signal 11"));
  Watched missing("exec /nobody/is/here");
  CHECK(missing.reports_contain("exit 127"));
}

TEST_CASE("a program that says nothing any more hangs, and is ended") {
  const auto start = tool::Worker::Clock::now();
  Watched hangs("echo WORD a; sleep 1000");
  CHECK(hangs.reports_contain("it hangs; restarting it"));
  CHECK(tool::Worker::Clock::now() - start < 5s);
  Watched babbles("echo WORD a; while sleep 0.01; do echo garbage; done");
  CHECK(babbles.reports_contain("it hangs; restarting it"));
  CHECK_THAT(babbles.reports, Contains("sent something that is not a reading: garbage"));
}

TEST_CASE("nothing that a program says takes more room, or time, than there is") {
  Watched floods("echo WORD a; yes | tr -d '\\n'");
  CHECK(floods.reports_contain("it hangs"));
  CHECK(floods.lines.size() == 1);
  Watched long_line("head -c 100000 /dev/zero | tr '\\0' x; echo; echo WORD a; exit 3");
  CHECK(long_line.reports_contain("exit 3"));
  REQUIRE(long_line.lines.size() >= 2);
  CHECK(long_line.lines[0] == std::string(200, 'x'));
  CHECK(long_line.lines[1] == "WORD a");
  Watched errors("yes >&2 & echo WORD a; sleep 1000");
  CHECK(errors.reports_contain("it hangs"));
  Watched bytes("printf 'WORD \\033[2J\\377\\0\\n'; printf '\\033[31m\\n'; exit 3");
  CHECK(bytes.reports_contain("exit 3"));
  CHECK_THAT(bytes.reports, Contains("?[31m") && !Contains("\033"));
}

TEST_CASE("what a program has started ends with it") {
  const Folder folder;
  {
    Watched parent("sleep 1000 & echo $! > " + folder.path("child") + "; echo WORD a; wait");
    CHECK(parent.until([&] { return !parent.lines.empty(); }));
  }
  const pid_t child = std::stoi(folder.read("child"));
  for (int i = 0; i < 400 && kill(child, 0) == 0; ++i) {
    const std::string stat = [&] {
      std::ifstream file("/proc/" + std::to_string(child) + "/stat");
      return std::string(std::istreambuf_iterator<char>(file), {});
    }();
    if (stat.find(") Z") != std::string::npos) break;
    std::this_thread::sleep_for(5ms);
    CHECK(i < 399);
  }
}

// ---- all of it

TEST_CASE("what programs say reaches the robot, and stays known while they say it") {
  const Ears ears;
  ears.upload();
  ears.works("command-words",
             "echo \"$@\" > " + ears.path("asked") +
                 "; echo WORD silence; sleep 0.4; echo WORD hello; sleep 0.05; echo WORD silence; "
                 "while sleep 0.05; do echo WORD silence; done");
  ears.works("face-detect",
             "echo COUNT 0; sleep 1; while sleep 0.05; do echo COUNT 1; echo ANGLE 3; done");
  Running companion(ears.call({"--microphone", "hw:3"}));
  REQUIRE(has_put(companion, "face COUNT 1.000", 1));
  const Outcome outcome = companion.end(SIGINT);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("voice WORD hello\n"));
  CHECK_THAT(outcome.out, !Contains("ANGLE"));  // the program does not read it
  CHECK(ears.read("asked") ==
        "--source hw:3 --period 50 --strict 47.000 --shown_for 0.500 --word silence --word hello "
        "--word very_well\n");
}

TEST_CASE("a program whose words were taught is told where they stand") {
  const Ears ears;
  ears.write("robot.json",
             R"({"algorithms": [{"name": "voice", "module": "own_words", "rate": "20Hz"}]})");
  ears.write("robot.rsl", "WHEN voice WORD IS hello\nDO LOG \"heard hello\"\nEND\n");
  const companion::TaughtWord word{"hello", {companion::Sample(8, own_words_frame{})}, 0};
  ears.write("voice.words", companion::write_words({word}));
  ears.upload();
  ears.works("own-words",
             "echo \"$@\" > " + ears.path("asked") +
                 "; echo WORD none; sleep 0.4; while sleep 0.05; do echo WORD hello; done");
  Running companion(ears.call());
  REQUIRE(has_put(companion, "voice WORD hello"));
  CHECK(companion.end(SIGINT).exit == 0);
  CHECK(ears.read("asked") ==
        "--source default --period 50 --strict 50.000 --shown_for 0.500 --words " +
            ears.path("voice.words") + " --word none --word hello\n");
}

TEST_CASE("what the robot does about it can be shown and written down") {
  const Ears ears;
  ears.works("command-words",
             "echo WORD silence; sleep 0.4; echo WORD hello; while sleep 0.05; do echo WORD "
             "silence; done");
  ears.upload();
  const Running companion(
      ears.call({"--monitor", "--format", "json", "--record", ears.path("day.jsonl")}));
  REQUIRE(has_put(companion, "heard hello"));
  std::this_thread::sleep_for(2s);  // eight times as long as a word stays known
  const std::string seen = companion.out();
  CHECK_THAT(seen.substr(seen.find("heard hello")), !Contains("\"stale\",\"sensor\":\"voice\""));
  CHECK_THAT(ears.read("day.jsonl"), Contains("heard hello"));
}

TEST_CASE("a program that dies does no harm to the others, and what it said grows unknown") {
  const Ears ears;
  ears.upload();
  ears.works("command-words", "echo WORD silence; sleep 0.2; exit 3");
  Running companion(ears.call({"--monitor"}));
  REQUIRE(companion.has_said("voice: has ended (exit 3)", 2));
  REQUIRE(has_put(companion, "voice WORD is unknown", 2));
  CHECK_THAT(companion.end(SIGINT).err, !Contains("face: "));
}

TEST_CASE("values that are none of the channel's are said, and never fed") {
  const Ears ears;
  ears.upload();
  ears.works("command-words", "while sleep 0.05; do echo WORD bye; done");
  ears.works("face-detect",
             "while sleep 0.05; do echo COUNT 21; echo COUNT -1; echo COUNT nan; done");
  Running companion(ears.call());
  REQUIRE(companion.has_said("voice: sent something that is not a reading: WORD bye", 1));
  REQUIRE(companion.has_said("face: sent something that is not a reading: COUNT 21", 1));
  CHECK(companion.end(SIGINT).out.empty());
}

TEST_CASE("a robot that goes away and comes back is fed again") {
  Ears ears;
  ears.upload();
  Running companion(ears.call());
  REQUIRE(has_put(companion, "face COUNT 0.000"));
  ears.bridge.hang_up();
  REQUIRE(companion.has_said("the line is back", 1));
  CHECK(has_put(companion, "face COUNT 0.000", 2));
  CHECK(companion.end(SIGINT).exit == 0);
}

TEST_CASE("another program of the robot is listened for with its own words") {
  const Ears ears;
  ears.works("command-words", "echo \"$@\" >> " + ears.path("asked") +
                                  "; while sleep 0.05; do echo WORD silence; done");
  const compiler::Result first = compiled(kListens);
  const compiler::Result other = compiled("WHEN voice WORD IS stop\nDO LOG \"x\"\nEND\n");
  const vm::Image images[] = {view_of(first), view_of(other)};
  std::vector<compiler::SensorConfig> algorithms;
  for (const compiler::SensorConfig& sensor : first.reading->robot->sensors)
    if (sensor.companion) algorithms.push_back(sensor);
  tool::Companion companion(algorithms, {"", "", "", ears.path("")}, false);
  const auto goes_on_until = [&](const std::string& words) {
    for (int i = 0; i < 1000; ++i) {
      if (!companion.work(nullptr)) return false;
      std::this_thread::sleep_for(5ms);
      if (i > 50 && ears.has("asked") && ears.read("asked").ends_with(words + "\n")) return true;
    }
    return false;
  };
  for (int i = 0; i < 2; ++i) {
    companion.program({&images[0], {}}, {});
    CHECK(goes_on_until("--word silence --word hello --word very_well"));
  }
  companion.program({&images[1], {}}, {});
  CHECK(goes_on_until("--word silence --word stop"));
  companion.program({nullptr, {}}, {});
  CHECK(companion.work(nullptr));
  const std::string asked = ears.read("asked");
  CHECK(std::ranges::count(asked, '\n') == 2);  // the same again is no reason to start it again
}

TEST_CASE("who writes UNKNOWN means no word") {
  const compiler::Result result = compiler::compile(
      {"robot.rsl", "WHEN voice WORD IS UNKNOWN\nDO LOG \"x\"\nEND\n"}, {"robot.json", kHearing},
      {.source_lines = false, .algorithms = tool::algorithm_modules()});
  CHECK(result.image.empty());
}

TEST_CASE("recordings that are over end it; programs that cannot work are a failure") {
  const Ears ears;
  ears.upload();
  ears.works("command-words", "echo WORD silence");
  ears.works("face-detect", "echo COUNT 0");
  const Outcome over = test::rsc(ears.call());
  CHECK(over.exit == 0);
  CHECK_THAT(over.out, Contains("voice WORD silence") && Contains("face COUNT 0.000"));
  ears.works("command-words", "echo '`helo` is no word' >&2; exit 2");
  ears.works("face-detect", "exit 2");
  const Outcome failed = test::rsc(ears.call());
  CHECK(failed.exit == 3);
  CHECK_THAT(failed.err,
             Contains("rsc: voice: `helo` is no word") && Contains("rsc: face: cannot work"));
}

TEST_CASE("what is missing is said before anything begins") {
  const Ears ears;
  const auto fails = [&](std::vector<std::string> how, int exit, const std::string& why) {
    const Outcome outcome = test::rsc(std::move(how));
    CHECK(outcome.exit == exit);
    CHECK_THAT(outcome.err, Contains(why));
  };
  fails(ears.call({"--camera", "/dev/video99"}), 3, "there is no file or device /dev/video99");
  fails(ears.call({"--microphone", ears.path("no.wav")}), 3, "there is no file or device");
  std::filesystem::remove(ears.path("robosync-face-detect"));
  fails(ears.call(), 3, "face: the program for the module face_detect is not installed");
  fails({"companion"}, 2, "--port");
  ears.write("robot.json", test::kRobot);
  fails(ears.call(), 1, "has no algorithm that runs on a companion computer");
  ears.write("robot.json", R"({"algorithms": [{"name": "a", "module": "command_word"}]})");
  fails(ears.call(), 1, "did you mean `command_words`?");
  std::filesystem::remove(ears.path("robot.json"));
  fails(ears.call(), 3, "robot.json");
}

TEST_CASE("companion --list says which modules there are, and which are installed") {
  const Ears ears;
  std::filesystem::remove(ears.path("robosync-face-detect"));
  const Outcome outcome = test::rsc({"companion", "--list", "--programs", ears.path("")});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("command_words") &&
                              Contains("WORD · " + ears.path("robosync-command-words")));
  CHECK_THAT(outcome.out, Contains("COUNT ANGLE NEARNESS · is not installed"));
  const nlohmann::json list = nlohmann::json::parse(
      test::rsc({"companion", "--list", "--programs", ears.path(""), "--format", "json"}).out);
  const auto of = [&](const std::string& name) {
    return *std::ranges::find_if(list, [&](const auto& one) { return one.at("module") == name; });
  };
  CHECK(of("command_words").at("program") == ears.path("robosync-command-words"));
  CHECK(of("face_detect").at("program").is_null());
  CHECK(of("face_detect").at("device") == "camera");
  CHECK(of("face_detect").at("outputs") == nlohmann::json({"COUNT", "ANGLE", "NEARNESS"}));
}
