// rsc completion and rsc help --man: what a shell and man make of the list of verbs.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <unistd.h>

#include "rsc/usage.hpp"
#include "rsc/verb.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using test::Outcome;

namespace {

// What bash would offer when `line` has been typed and the tabulator is pressed, a word a line, in `folder`.
std::string offered(const std::string& folder, const std::vector<std::string>& line) {
  std::string words;
  for (const std::string& word : line)
    words += " '" + word + "'";
  const std::string script = "cd " + folder +
                             " && . <(" RSC_BINARY " completion bash) && COMP_WORDS=(" + words +
                             ") && COMP_CWORD=" + std::to_string(line.size() - 1) +
                             " && _rsc && printf '%s\\n' \"${COMPREPLY[@]}\"";
  const std::string command = "bash -c \"" + [&] {
    std::string quoted;
    for (const char c : script)
      quoted += c == '"' || c == '$' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return quoted;
  }() + "\"";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  REQUIRE(pipe != nullptr);
  std::string text;
  std::array<char, 256> buffer{};
  while (fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr)
    text += buffer.data();
  return text;
}

}  // namespace

TEST_CASE("bash completes verbs, options, the words of an option, and files") {
  const test::Folder folder;
  folder.write("my robot.rsl", "");
  const std::string place = folder.path("");
  CHECK(offered(place, {"rsc", "upl"}) == "upload\n");
  CHECK(offered(place, {"rsc", "run", "--sce"}) == "--scenario\n");
  CHECK(offered(place, {"rsc", "run", "--format", ""}) == "human\njson\n");
  CHECK(offered(place, {"rsc", "new", "--template", "pu"}) == "puppet\n");
  CHECK(offered(place, {"rsc", "run", "my"}) == "my robot.rsl\n");
  CHECK(offered(place, {"rsc", "run", "--scenario", "my"}) == "my robot.rsl\n");
  CHECK(offered(place, {"rsc", "help", "roll"}) == "rollback\n");
  CHECK(offered(place, {"rsc", "nothing", "--x"}) == "\n");
}

TEST_CASE(
    "bash completes the words after a verb, boards, and files where a device may stand, too") {
  const test::Folder folder;
  folder.write("film.avi", "");
  const std::string place = folder.path("");
  CHECK(offered(place, {"rsc", "completion", ""}) == "bash\nfish\nzsh\n");
  CHECK(offered(place, {"rsc", "trace", ""}) == "convert\n");
  CHECK(offered(place, {"rsc", "trace", "convert", ""}) == "film.avi\n");
  CHECK(offered(place, {"rsc", "trace", "--t"}) == "--to\n");
  CHECK(offered(place, {"rsc", "module", ""}) == "check\n");
  CHECK_THAT(offered(place, {"rsc", "flash", "--board", ""}),
             Contains("microbit-v2\n") && !Contains("mps2"));
  for (const char* const option : {"--camera", "--microphone"})
    CHECK(offered(place, {"rsc", "companion", option, ""}) == "film.avi\n");
}

TEST_CASE(
    "fish completes the words after a verb, boards, and files where a device may stand, too") {
  const std::string fish = test::rsc({"completion", "fish"}).out;
  CHECK_THAT(fish, Contains("'__fish_seen_subcommand_from companion' -l camera -r -d"));
  CHECK_THAT(fish,
             Contains("from trace; and not __fish_seen_subcommand_from convert' -a 'convert'"));
  CHECK_THAT(fish, Contains("-a 'bash fish zsh'"));
  CHECK_THAT(fish, Contains("from flash' -l board -x -a 'b-l475e-iot01a "));
}

TEST_CASE("bash completes serial lines, and offers no files where a number is wanted") {
  const test::Folder folder;
  folder.write("7.rsl", "");
  const int line = posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE(unlockpt(line) == 0);
  const std::string name = ptsname(line);
  CHECK_THAT(offered(folder.path(""), {"rsc", "info", "--port", ""}), Contains(name + "\n"));
  CHECK(offered(folder.path(""), {"rsc", "info", "--port", name}) == name + "\n");
  close(line);
  CHECK(offered(folder.path(""), {"rsc", "run", "--seed", ""}).empty());
}

TEST_CASE("fish and the manual page have every verb, and every option of it") {
  const std::string fish = test::rsc({"completion", "fish"}).out;
  const std::string manual = test::rsc({"help", "--man"}).out;
  for (const tool::VerbUsage& verb : tool::all_usage()) {
    CAPTURE(verb.name);
    CHECK_THAT(fish, Contains("-a " + verb.name + " -d "));
    CHECK_THAT(manual, Contains(".SS rsc " + verb.name + "\n"));
    const std::size_t begin = manual.find(".SS rsc " + verb.name + "\n");
    const std::string section = manual.substr(begin, manual.find("\n.S", begin + 1) - begin);
    CHECK(verb.options.size() >= 1);
    for (const tool::OptionUsage& option : verb.options)
      for (std::string name : option.names) {
        CAPTURE(name);
        if (name.starts_with("--"))
          CHECK_THAT(fish, Contains("from " + verb.name + "' -l " + name.substr(2)));
        for (std::size_t at = name.find('-'); at != std::string::npos; at = name.find('-', at + 2))
          name.insert(at, "\\");
        CHECK_THAT(section, Contains(name));
      }
  }
}

TEST_CASE("a shell that rsc does not know is exit 2, and says which it knows") {
  const Outcome outcome = test::rsc({"completion", "csh"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("the shell is bash, fish or zsh, not `csh`"));
}
