// The command line as a whole: help with working examples, did-you-mean, exit codes, streams.
#include "rsc/cli.hpp"

#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "rsc/verb.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using test::Outcome;

namespace {

std::vector<std::string> words(std::string_view line) {
  std::istringstream stream{std::string(line)};
  return {std::istream_iterator<std::string>(stream), {}};
}

// Runs what follows in a folder of its own.
struct InFolder : test::Folder {
  InFolder() { std::filesystem::current_path(path(".")); }
  ~InFolder() { std::filesystem::current_path(before); }
  InFolder(const InFolder&) = delete;
  InFolder& operator=(const InFolder&) = delete;
  std::filesystem::path before = std::filesystem::current_path();
};

}  // namespace

TEST_CASE("every verb explains itself, with an example of its own") {
  const Outcome all = test::rsc({"help"});
  CHECK(all.exit == 0);
  CHECK(all.err.empty());
  for (const tool::Verb& verb : tool::kVerbs) {
    INFO(verb.name);
    CHECK_THAT(all.out, Contains(std::string(verb.name)) && Contains(std::string(verb.summary)));
    const Outcome help = test::rsc({"help", std::string(verb.name)});
    CHECK(help.exit == 0);
    CHECK_THAT(help.out, Contains(std::string(verb.example)));
    CHECK(verb.example.starts_with("rsc " + std::string(verb.name)));
    const Outcome option = test::rsc({std::string(verb.name), "--help"});
    CHECK(option.exit == 0);
    CHECK(option.out == help.out);
  }
}

TEST_CASE("every example is understood by the parser") {
  const InFolder here;  // what an example makes goes with it
  for (const tool::Verb& verb : tool::kVerbs) {
    INFO(verb.example);
    std::vector<std::string> arguments = words(verb.example);
    arguments.erase(arguments.begin());
    // Nothing it names exists here, so it may fail, but not by its usage.
    const Outcome outcome = test::rsc(arguments);
    CHECK((outcome.exit == 0 || outcome.exit == 3));
  }
}

TEST_CASE("a misspelt verb or option gets a suggestion, and exit 2") {
  Outcome outcome = test::rsc({"chekc", "robot.rsl"});
  CHECK(outcome.exit == 2);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, Contains("there is no verb `chekc`; did you mean `check`?"));

  outcome = test::rsc({"compile", "robot.rsl", "--stirp"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("there is no option `--stirp`; did you mean `--strip`?") &&
                              Contains("rsc help compile"));

  // Without a file, too: the word that is wrong is what the user can mend.
  outcome = test::rsc({"check", "--formt"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("there is no option `--formt`; did you mean `--format`?"));

  outcome = test::rsc({"help", "uplaod"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("did you mean `upload`?"));
}

TEST_CASE("words of other tools are answered with what to write") {
  struct Word {
    std::vector<std::string> arguments;
    const char* answer;
  };
  for (const auto& [arguments, answer] : std::vector<Word>{
           {{"-c", "robot.rsl"}, "write `rsc compile FILE`"},
           {{"-v"}, "write `rsc --version`"},
           {{"build", "robot.rsl"}, "write `rsc compile FILE`"},
           {{"robot.rsl"}, "write `rsc check robot.rsl` to look for mistakes, `rsc run robot.rsl`"},
           {{"compile", "-c", "robot.rsl"}, "there is no option `-c`; write rsc compile FILE"},
           {{"check", "robot.rsl", "--json"}, "; write --format json"},
           {{"dump", "robot.rsl", "-Werror"}, "; write --deny warnings"},
           {{"fmt", "-w", "robot.rsl"}, "rsc fmt rewrites the files"},
           {{"run", "robot.rsl", "-d", "5s"}, "did you mean `--duration` or `--deny`?"},
           {{"run", "robot.rsl", "--scen", "a.json"}, "did you mean `--scenario`?"},
           {{"info", "--xyz"}, "there are --port, "},
       }) {
    const Outcome outcome = test::rsc(arguments);
    CAPTURE(arguments, outcome.err);
    CHECK(outcome.exit == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains(answer));
  }
  // What does not go with the verb is not offered.
  CHECK_THAT(test::rsc({"ports", "--sarif"}).err, !Contains("--format sarif"));
}

TEST_CASE("with --quiet a verb says nothing when all is well") {
  const test::RobotFolder robot;
  const std::string good =
      robot.write("robot.rsl", "LET spare = 3\nAT START DO\n  LOG \"x\"\nEND\n");  // a warning
  const std::string wrong = robot.write("wrong.rsl", "AT START DO\n  LGO \"x\"\nEND\n");
  const std::string image = robot.path("robot.rsb");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"check", "--quiet", good},
                                             {"check", "-q", good},
                                             {"compile", "-q", good, "-o", image},
                                             {"fix", "-q", good},
                                             {"fmt", "-q", good},
                                             {"test", "-q", good}}) {
    const Outcome outcome = test::rsc(arguments);
    CAPTURE(arguments, outcome.out, outcome.err);
    CHECK(outcome.exit == 0);
    CHECK(outcome.out.empty());
    if (arguments.front() != "test") CHECK(outcome.err.empty());  // that there is no TEST
  }
  CHECK(std::filesystem::exists(image));
  for (const char* const verb : {"check", "compile", "test"}) {
    const Outcome outcome = test::rsc({verb, "-q", wrong});
    CAPTURE(verb, outcome.out);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("error["));
    CHECK(outcome.out.empty());
  }
  CHECK(test::rsc({"check", "-q", "--timing", good}).exit == 2);
  CHECK_THAT(test::rsc({"check", "--timing", "--format", "sarif", good}).err,
             Contains("--timing and --format sarif do not go together"));
  CHECK(test::rsc({"check", "-q", "--format", "json", good}).exit == 2);
}

TEST_CASE("wrong usage is exit 2 and says how it goes") {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"check"},
                                             {"upload", "robot.rsl"},
                                             {"check", "robot.rsl", "--format", "yaml"},
                                             {"monitor", "--port", "unix:/x", "--duration", "5"},
                                             {"monitor", "--port", "unix:/x", "--duration", "5cm"},
                                             {"monitor", "--port", "unix:/x", "--config", "r.json"},
                                             {"dump", "a.rsb", "b.rsb"},
                                             {"--nonsense"},
                                             {"info", "--port", "tcp:nowhere"}}) {
    const Outcome outcome = test::rsc(arguments);
    CAPTURE(arguments, outcome.err);
    CHECK(outcome.exit == 2);
    CHECK(outcome.out.empty());
    CHECK_FALSE(outcome.err.empty());
  }
}

TEST_CASE("an option that does not know a word says what it knows") {
  CHECK_THAT(test::rsc({"check", "robot.rsl", "--format", "yaml"}).err,
             Contains("--format is human or json or sarif, not `yaml`"));
  CHECK_THAT(test::rsc({"dump", "robot.rsl", "-O3"}).err, Contains("-O is 0 or 1, not `3`"));
  CHECK_THAT(test::rsc({"upload", "robot.rsl", "--port"}).err,
             Contains("--port needs PORT after it"));
  CHECK_THAT(test::rsc({"run", "robot.rsl", "--seed", "1", "--seed", "2"}).err,
             Contains("--seed may be given only once"));
}

TEST_CASE("an option that lacks its value does not take the next option") {
  for (const auto& [option, value] :
       {std::pair{"--duration", "TIME"}, {"--config", "FILE"}, {"--allow", "CODE"}}) {
    for (const char* const next : {"--trace", "--html=x.html", "-O"}) {
      const Outcome outcome = test::rsc({"run", option, next, "x", "robot.rsl"});
      CAPTURE(option, next, outcome.err);
      CHECK(outcome.exit == 2);
      CHECK_THAT(outcome.err, Contains(std::string(option) + " needs " + value + " after it"));
    }
  }
}

TEST_CASE("names of files that begin with -") {
  const InFolder here;
  here.write("robot.json", test::kRobot);
  here.write("robot.rsl", test::kProgram);
  here.write("-dash.rsl", test::kProgram);
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"check", "--", "-dash.rsl"},
                                             {"check", "robot.rsl", "--", "-dash.rsl"},
                                             {"compile", "-o", "x.rsb", "--", "-dash.rsl"},
                                             {"check", "./-dash.rsl"}}) {
    const Outcome outcome = test::rsc(arguments);
    CAPTURE(arguments, outcome.err);
    CHECK(outcome.exit == 0);
  }
  CHECK_THAT(
      test::rsc({"check", "-dash.rsl"}).err,
      Contains("there is no option `-dash.rsl`; a file of this name is written ./-dash.rsl"));
  CHECK_THAT(test::rsc({"compile", "--", "-dash.rsl", "-o", "x.rsb"}).err,
             Contains("`-o` is one argument too many; after `--` all are names of files, so "
                      "options go before it"));
}

TEST_CASE("an option in front of the verb is told where it belongs") {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--format", "json", "check", "robot.rsl"}, {"-v"}}) {
    const Outcome outcome = test::rsc(arguments);
    CHECK(outcome.exit == 2);
    CHECK_THAT(outcome.err, Contains("`" + arguments[0] + "` is not a verb"));
  }
  CHECK(test::rsc({"--version"}).exit == 0);
  CHECK(test::rsc({"--help"}).exit == 0);
}

TEST_CASE("an option that is given nothing is refused") {
  const InFolder here;
  for (const char* option : {"--record", "--trace", "--html", "--scenario", "--config"}) {
    const Outcome outcome = test::rsc({"run", "robot.rsl", option, ""});
    CAPTURE(option, outcome.err);
    CHECK(outcome.exit == 2);
    CHECK_THAT(outcome.err, Contains(std::string(option) + ": it is empty"));
  }
}

TEST_CASE("an option that would do nothing is refused, with the reason") {
  const test::Folder folder;
  const std::string program = folder.write("robot.rsl", "AT START DO\n  LOG \"a\"\nEND\n");
  const std::string config = folder.write("robot.json", "{}");
  const std::string image = folder.path("robot.rsb");
  REQUIRE(test::rsc({"compile", program, "-o", image}).exit == 0);
  struct Case {
    std::vector<std::string> arguments;
    const char* why;
  };
  const std::vector<Case> cases = {
      {{"run", image, "--config", config}, "--config says how to compile"},
      {{"dump", image, "-O0"}, "-O0 says how to compile"},
      {{"run", image, "--deny", "warnings"}, "--allow, --warn or --deny says how to compile"},
      {{"upload", image, "--config", config, "--port", "unix:/nowhere"}, "name the program"},
      {{"upload", image, "--seed", "3", "--port", "unix:/nowhere"}, "--seed says how to compile"},
      {{"feed", "a=1", "--fresh", "--port", "unix:/nowhere"}, "--fresh goes with --upload FILE"},
      {{"feed", "a=1", "--anyway", "--port", "unix:/nowhere"}, "--anyway goes with --upload FILE"},
      {{"feed", "a=1", "--config", config, "--port", "unix:/nowhere"},
       "--config goes with --upload FILE"},
      {{"monitor", "--config", config, "--port", "unix:/nowhere"},
       "--config goes with --upload FILE"},
      {{"replay", "day.jsonl", "--config", config}, "--config goes with --program FILE"},
      {{"help", "--man", "run"}, "--man prints one page about all verbs: leave out `run`"}};
  for (const Case& one : cases) {
    const Outcome outcome = test::rsc(one.arguments);
    CAPTURE(one.why, outcome.err);
    CHECK(outcome.exit == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains(one.why));
  }
}

TEST_CASE("- is stdin for the verbs that say so, and no output") {
  const InFolder here;
  for (const char* verb : {"run", "test", "explain", "compile", "dump", "fix"}) {
    const Outcome outcome = test::rsc({verb, "-"});
    CAPTURE(verb, outcome.err);
    CHECK(outcome.exit == 3);
    CHECK_THAT(outcome.err, Contains("only rsc check and rsc fmt read stdin"));
  }
}

TEST_CASE("a file that is missing is exit 3 and named") {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"check", "missing.rsl"},
           {"compile", "missing.rsl"},
           {"dump", "missing.rsb"},
           {"run", "missing.rsl"},
           {"upload", "missing.rsb", "--port", "unix:/nowhere"}}) {
    const Outcome outcome = test::rsc(arguments);
    CAPTURE(arguments, outcome.err);
    CHECK(outcome.exit == 3);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains("cannot read missing.rs"));
  }
}

TEST_CASE("a folder is not a program") {
  const test::Folder folder;
  const Outcome outcome = test::rsc({"check", folder.path(".")});
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("Is a directory"));
}
