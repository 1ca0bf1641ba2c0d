// What verbs write: never onto what they read, never half, and into devices and pipes as they are.
#include "rsc/output.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "companion/words_file.hpp"
#include "rsc/failure.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using test::Folder;
using test::Outcome;
using test::RobotFolder;

namespace fs = std::filesystem;

namespace {

constexpr const char* kMagic = "RSB";

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Refused, and the folder as it was.
void refuses(const Folder& folder, const std::vector<std::string>& arguments, int exit,
             const std::string& reason) {
  const std::size_t before = folder.files();
  const std::string program = folder.read("robot.rsl");
  const std::string config = folder.read("robot.json");
  const Outcome outcome = test::rsc(arguments);
  CAPTURE(arguments, outcome.err);
  CHECK(outcome.exit == exit);
  CHECK_THAT(outcome.err, Contains(reason));
  CHECK(folder.read("robot.rsl") == program);
  CHECK(folder.read("robot.json") == config);
  CHECK(folder.files() == before);
}

}  // namespace

TEST_CASE("an output that is an input is refused, by whatever name") {
  const RobotFolder robot;
  const std::string config = robot.path("robot.json");
  robot.write("visit.json", R"({"duration": "1s"})");
  const std::string by_link = robot.path("link.rsb");
  const std::string by_hard_link = robot.path("hard.rsb");
  const std::string by_folder = robot.path("./robot.rsl");
  fs::create_symlink(robot.program, by_link);
  fs::create_hard_link(config, by_hard_link);
  const std::string is_input = "is an input; nothing was written";
  const std::string same_as = "is the same file as";
  refuses(robot, {"compile", robot.program, "-o", robot.program}, 2, is_input);
  refuses(robot, {"compile", robot.program, "-o", config}, 2, is_input);
  refuses(robot, {"compile", robot.program, "-o", by_link}, 2, same_as);
  refuses(robot, {"compile", robot.program, "-o", by_hard_link}, 2, same_as);
  refuses(robot, {"compile", robot.program, "-o", by_folder}, 2, same_as);
  const std::string scenario = robot.path("visit.json");
  for (const std::string& file : {robot.program, config, by_link, by_hard_link, scenario}) {
    refuses(robot, {"run", robot.program, "--scenario", scenario, "--trace", file}, 2,
            "nothing was written");
  }
  CHECK(robot.read("visit.json") == R"({"duration": "1s"})");
}

TEST_CASE("a module and an image that is run are inputs too") {
  const RobotFolder robot;
  robot.write("more.rsl", "AT START DO\n  LOG \"more\"\nEND\n");
  const std::string user =
      robot.write("user.rsl", "USE \"more.rsl\"\nAT START DO\n  LOG \"x\"\nEND\n");
  refuses(robot, {"compile", user, "-o", robot.path("more.rsl")}, 2, "more.rsl is an input");
  const std::string image = robot.path("robot.rsb");
  REQUIRE(test::rsc({"compile", robot.program}).exit == 0);
  const std::string before = read_all(image);
  refuses(robot, {"run", image, "--trace", image}, 2, "robot.rsb is an input");
  CHECK(read_all(image) == before);
}

TEST_CASE("what a person has written is no output, whatever verb is asked") {
  const RobotFolder robot;
  const std::string trace = robot.path("t.jsonl");
  REQUIRE(test::rsc({"run", robot.program, "--trace", trace}).exit == 0);
  const std::vector<std::array<std::string, 3>> kept = {
      {"visit.json", R"({"duration": "1s", "stimuli": []})", "a scenario"},
      {"visit.csv", "\xEF\xBB\xBFtime (s),touch.LEVEL\n0,1\n", "a recording in CSV"},
      {"old.kept.json", R"({"kept": {"visits": "4"}})", "a file of kept numbers"},
      {"old.json", R"({"actuators": []})", "the configuration of a robot"},
      {"old.rsl", "# mine\n", "a program"},
      {"pet.words", companion::write_words({}), "a file of taught words"},
      {"heart.c", "", "a source in C"},
      {"heart.so",
       "\x7F"
       "ELF\2",
       "a compiled module"},
      {"hello.wav", "RIFF", "a sound"}};
  for (const auto& [name, text, what] : kept) {
    const std::string file = robot.write(name, text);
    refuses(robot, {"trace", "convert", trace, "--to", "perfetto", "-o", file}, 2, what);
    refuses(robot, {"run", robot.program, "--html", file}, 2, "nothing was written");
    CHECK(robot.read(name) == text);
    fs::remove(file);
  }
  // What rsc has made it makes again.
  for (const char* const name : {"a.json", "a.jsonl", "a.csv"})
    for (const char* const to : {"perfetto", "csv", "vcd"})
      CHECK(test::rsc({"trace", "convert", trace, "--to", to, "-o", robot.path(name)}).exit == 0);
  for (int i = 0; i < 2; ++i)
    CHECK(test::rsc({"run", robot.program, "--trace", robot.path("b.json")}).exit == 0);
}

TEST_CASE("the key of an owner is no output") {
  const RobotFolder robot;
  REQUIRE(test::rsc({"keygen", "--key", robot.path("key")}).exit == 0);
  const std::string key = robot.read("key");
  for (const char* const option : {"--trace", "--record", "--html"})
    refuses(robot, {"run", robot.program, option, robot.path("key")}, 2,
            "already exists, and is the key of a robot's owner; nothing was written");
  CHECK(robot.read("key") == key);
}

TEST_CASE("a recording is replaced only by a recording") {
  const RobotFolder robot;
  const std::string day = robot.path("day.jsonl");
  for (int i = 0; i < 2; ++i)
    REQUIRE(test::rsc({"run", robot.program, "--record", day}).exit == 0);
  const std::string recorded = robot.read("day.jsonl");
  for (const char* const option : {"--trace", "--html"})
    refuses(robot, {"run", robot.program, option, day}, 2, "is a recording for rsc replay");
  refuses(robot, {"compile", robot.program, "-o", day}, 2, "is a recording for rsc replay");
  CHECK(robot.read("day.jsonl") == recorded);
}

TEST_CASE("the picture of a companion replaces nothing that matters") {
  const RobotFolder robot;
  robot.write("robot.json", R"({"algorithms": [{"name": "people", "module": "face_detect"}]})");
  const std::string film = robot.write("film.avi", "film");
  const auto call = [&](const std::string& preview) {
    refuses(robot,
            {"companion", "--port", "unix:none", "--config", robot.path("robot.json"), "--camera",
             film, "--preview", preview},
            2, "nothing was written");
  };
  call(film);
  call(robot.program);
}

TEST_CASE("nothing is written where it would be taken for a configuration") {
  const RobotFolder robot;
  const std::string quiz = robot.write("quiz.rsl", "AT START DO\n  LOG \"x\"\nEND\n");
  const std::string taken = "because of its name";
  for (const char* const option : {"--trace", "--record", "--html"})
    refuses(robot, {"run", quiz, option, robot.path("quiz.json")}, 2, taken);
  refuses(robot, {"compile", quiz, "-o", robot.path("quiz.json")}, 2, taken);
  fs::create_directory(robot.path("other"));
  refuses(robot, {"run", quiz, "--trace", robot.path("other/robot.json")}, 2, taken);
  CHECK(test::rsc({"check", quiz}).exit == 0);
}

TEST_CASE("two outputs are two files") {
  const RobotFolder robot;
  const std::string file = robot.path("same.jsonl");
  refuses(robot, {"run", robot.program, "--trace", file, "--record", robot.path("./same.jsonl")}, 2,
          "is given for two outputs");
  CHECK(test::rsc({"run", robot.program, "--trace", "/dev/null", "--record", "/dev/null"}).exit ==
        0);
  refuses(robot, {"run", robot.program, "--trace", "-"}, 2, "is not an output, /dev/stdout is");
}

TEST_CASE("a folder is no output") {
  const RobotFolder robot;
  const std::string folder = robot.path("folder");
  fs::create_directory(folder);
  fs::create_symlink(folder, robot.path("to_folder"));
  refuses(robot, {"compile", robot.program, "-o", folder}, 3, "Is a directory");
  refuses(robot, {"compile", robot.program, "-o", robot.path("to_folder")}, 3, "Is a directory");
  refuses(robot, {"run", robot.program, "--trace", folder}, 3, "Is a directory");
  CHECK(fs::is_empty(folder));
}

TEST_CASE("an image on stdout is alone there") {
  const RobotFolder robot;
  REQUIRE(test::rsc({"compile", robot.program}).exit == 0);
  const std::string image = read_all(robot.path("robot.rsb"));
  REQUIRE_THAT(image, Catch::StartsWith(kMagic));
  const Outcome outcome = test::rsc({"compile", robot.program, "-o", "/dev/stdout"});
  CHECK(outcome.exit == 0);
  CHECK(outcome.out == image);
  CHECK_THAT(outcome.err, Contains("a step costs up to"));
  CHECK(fs::is_symlink("/dev/stdout"));
}

TEST_CASE("a device takes what it is given and stays a device") {
  const RobotFolder robot;
  Outcome outcome = test::rsc({"compile", robot.program, "-o", "/dev/null"});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("/dev/null: "));
  CHECK(fs::is_character_file("/dev/null"));
  fs::create_symlink("/dev/null", robot.path("nothing"));
  CHECK(test::rsc({"run", robot.program, "--trace", robot.path("nothing")}).exit == 0);
  CHECK(fs::is_symlink(robot.path("nothing")));
  outcome = test::rsc({"compile", robot.program, "-o", "/dev/full"});
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("No space left on device"));
}

TEST_CASE("a pipe gets the bytes") {
  const RobotFolder robot;
  REQUIRE(test::rsc({"compile", robot.program}).exit == 0);
  const std::string pipe = robot.path("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string received;
  std::thread reader([&] { received = read_all(pipe); });
  const Outcome outcome = test::rsc({"compile", robot.program, "-o", pipe});
  reader.join();
  CHECK(outcome.exit == 0);
  CHECK(received == read_all(robot.path("robot.rsb")));
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("links: one to a file is replaced, one that dangles is followed") {
  const Folder folder;
  const std::string text = "new";
  const std::string target = folder.write("target", "old");
  fs::create_symlink(target, folder.path("link"));
  tool::write_output(folder.path("link"), bytes_of(text));
  CHECK(folder.read("target") == "old");
  CHECK(folder.read("link") == "new");
  CHECK_FALSE(fs::is_symlink(folder.path("link")));

  fs::create_symlink(folder.path("later"), folder.path("dangling"));
  tool::write_output(folder.path("dangling"), bytes_of(text));
  CHECK(folder.read("later") == "new");
  CHECK(fs::is_symlink(folder.path("dangling")));
}

TEST_CASE("a file keeps its permissions, and nothing is left of a write that fails") {
  const Folder folder;
  const std::string text = "new";
  const std::string file = folder.write("file", "old");
  fs::permissions(file, fs::perms{0640});
  tool::write_output(file, bytes_of(text));
  CHECK(folder.read("file") == "new");
  CHECK((fs::status(file).permissions() == fs::perms{0640}));
  CHECK(folder.files() == 1);
  CHECK_THROWS_AS(tool::write_output(folder.path("none/file"), bytes_of(text)), tool::Failure);
  CHECK(folder.files() == 1);
}

// The mask is read by changing it: what one thread reads meanwhile must not be what stays.
TEST_CASE("threads that write at the same time give every new file its permissions") {
  const Folder folder;
  const std::string text = "new";
  const mode_t before = umask(022);
  const auto write_many = [&](const std::string& name) {
    for (int i = 0; i < 300; ++i)
      tool::write_output(folder.path(name + std::to_string(i)), bytes_of(text));
  };
  std::vector<std::thread> threads;
  for (const char* name : {"a", "b", "c", "d"})
    threads.emplace_back(write_many, name);
  for (std::thread& thread : threads)
    thread.join();
  CHECK(umask(before) == 022);
  for (const auto& entry : fs::directory_iterator(folder.path(".")))
    if (entry.status().permissions() != fs::perms{0644}) FAIL_CHECK(entry.path());
}
