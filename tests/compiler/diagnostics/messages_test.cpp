// Wrong and doubtful programs and configurations, each with everything that is said about it.
//
// A case NAME is golden/NAME.rsl, golden/NAME.json or both; what it does not have comes from
// golden/robot.rsl and golden/robot.json. NAME.txt is what must be said.
#include <set>

#include <catch2/catch.hpp>

#include "rsc/algorithm_modules.hpp"
#include "tests/compiler/compiled.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;
namespace fs = std::filesystem;

namespace {

const fs::path kFolder = messages_folder();

std::set<std::string> case_names() {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(kFolder))
    if (entry.path().extension() != ".txt") names.insert(entry.path().stem().string());
  return names;
}

Input part(const std::string& name, const std::string& extension) {
  fs::path path = kFolder / (name + extension);
  if (!fs::exists(path)) path = kFolder / ("robot" + extension);
  return {path.filename().string(), read_file(path)};
}

Result run(const std::string& name) {
  return compile(part(name, ".rsl"), part(name, ".json"),
                 {.source_lines = false, .algorithms = robosync::tool::algorithm_modules()});
}

// The codes of the back end, as diagnostics.def lists them.
std::set<std::string> back_end_codes() {
  std::set<std::string> codes;
#define DIAGNOSTIC(code, level, title) codes.insert(#code);
#include "compiler/diagnostics/diagnostics.def"
#undef DIAGNOSTIC
  std::erase_if(codes, [](const std::string& code) {
    const bool front_end = code.starts_with("E00") || code.starts_with("W01");
    // rsc refuses its own image: no input may do that; what is too slow, the tool says, of the image
    const bool never = code == "E0499" || code == "E0412";
    return front_end || never;
  });
  return codes;
}

}  // namespace

TEST_CASE("messages", "[golden]") {
  const auto names = case_names();
  CHECK(names.size() >= 80);
  for (const std::string& name : names) {
    INFO(name);
    const Result result = run(name);
    CHECK(result.image.empty() == (result.diagnostics.errors() > 0));
    robosync::testing::expect_golden(kFolder / (name + ".txt"), messages(result));
  }
}

TEST_CASE("every code of the back end is in some golden file", "[golden]") {
  std::set<std::string> fired;
  for (const std::string& name : case_names()) {
    const Result result = run(name);
    for (const Diagnostic& diagnostic : result.diagnostics.all())
      fired.emplace(code_name(diagnostic.code));
  }
  for (const std::string& code : back_end_codes()) {
    INFO(code);
    CHECK(fired.contains(code));
  }
}

TEST_CASE("every message has a place, and a fix mends what it names", "[golden]") {
  for (const std::string& name : case_names()) {
    const Result result = run(name);
    for (const Diagnostic& diagnostic : result.diagnostics.all()) {
      INFO(name << ": " << diagnostic.message);
      CHECK(!diagnostic.labels.empty());
      CHECK(diagnostic.message.find_last_of('.') != diagnostic.message.size() - 1);
      for (const Label& label : diagnostic.labels) {
        CHECK(label.span.begin <= label.span.end);
        CHECK(label.span.end <= result.sources.file(label.span.file).text().size());
      }
    }
  }
}

namespace {

Fix first_fix(const std::string& program) {
  const Result result = compile_text(program, common_robot());
  REQUIRE(result.diagnostics.errors() == 1);
  const Diagnostic& error = result.diagnostics.all().front();
  REQUIRE(!error.fixes.empty());
  return error.fixes.front();
}

}  // namespace

TEST_CASE("the fix of a line as pupils write it gives a whole program, and is never certain") {
  for (const std::string program : {
           "WHEN touch LEVEL > 3 DO\n  LOG \"a\", SHOW face happy\nEND\n",
           "WHEN touch LEVEL > 3 AND < 5 DO\n  LOG \"a\"\nEND\n",
           "WHEN touch LEVEL > 3\nCOOLDOWN\n3s\nDO LOG \"a\"\nEND\n",
           "START\n  LOG \"a\"\nEND\n",
           "AT START DO\n  WAIT UNTIL touch LEVEL > 3 FOR 2s WITHIN 5s\nEND\n",
           "STATE mood: happy sad\nAT START DO\n  SET mood TO sad\n  WAIT 1s\n  SET mood TO happy\n"
           "END\n",
           "AT START DO\n  MOVE left_arm 90 degrees\nEND\n",
       }) {
    INFO(program);
    const Fix fix = first_fix(program);
    CHECK(fix.applicability == Applicability::likely);
    std::string mended = program;
    mended.replace(fix.span.begin, fix.span.end - fix.span.begin, fix.replacement);
    INFO(mended);
    CHECK(compile_text(mended, common_robot()).diagnostics.errors() == 0);
  }
}

TEST_CASE("after TO, a unit apart from its number has one meaning") {
  const Fix fix = first_fix("AT START DO\n  MOVE left_arm TO 90 degrees\nEND\n");
  CHECK(fix.applicability == Applicability::certain);
}

TEST_CASE("a sound that robot.json has and no program uses may be the misspelt one") {
  const std::string wrong = "AT START DO\n  PLAY sound \"greting.wav\"\n";
  CHECK(first_fix(wrong + "END\n").applicability == Applicability::likely);
  CHECK(first_fix(wrong + "  THEN\n  PLAY sound \"greeting.wav\"\nEND\n").applicability ==
        Applicability::certain);
}

TEST_CASE("what a pupil may have meant otherwise is not suggested") {
  const auto said = [](const std::string& program) {
    const Result result = compile_text(program, common_robot());
    CHECK(result.diagnostics.errors() == 1);
    return messages(result);
  };
  const std::string rest = " DO\n  LOG \"a\"\nEND\n", full = "write both conditions in full";
  CHECK_THAT(said("WHEN touch LEVEL > 3 AND < 5" + rest), Catch::Contains(full));
  CHECK_THAT(said("WHEN NOT touch LEVEL > 3 AND < 5" + rest), !Catch::Contains(full));
  const auto loop = [&](const std::string& head) {
    return said("AT START DO\n  " + head + "\n    LOG \"a\"\n  END\nEND\n");
  };
  CHECK_THAT(loop("FOR i = 1 TO 7"), Catch::Contains("write `REPEAT 7 TIMES`"));
  CHECK_THAT(loop("FOR i = 1 TO 7.5"), !Catch::Contains("REPEAT 7 TIMES"));
  // The fix would make the number a part of the comment.
  const Result commented =
      compile_text("WHEN touch LEVEL > 3\nCOOLDOWN # rest\n3s\n" + rest.substr(1), common_robot());
  CHECK_THAT(messages(commented), Catch::Contains("belongs at the end of the line above"));
  CHECK(commented.diagnostics.all().front().fixes.empty());
}

// `arm` may be one of the arms: the fix would move both.
TEST_CASE(
    "a group is never the certain fix of a word that one of its members has, or of the singular") {
  const auto is_certain = [](const std::string& line, const std::string& groups) {
    std::string robot = common_robot();
    const std::string before = R"({"arms": ["left_arm", "right_arm"]})";
    const Result result = compile_text("AT START DO\n  " + line + "\nEND\n",
                                       robot.replace(robot.find(before), before.size(), groups));
    for (const Diagnostic& diagnostic : result.diagnostics.all())
      if (diagnostic.code == Code::E0501 || diagnostic.code == Code::E0502)
        return !diagnostic.fixes.empty() &&
               diagnostic.fixes.front().applicability == Applicability::certain;
    return false;
  };
  const std::string arms = R"({"arms": ["left_arm", "right_arm"]})";
  CHECK_FALSE(is_certain("MOVE arm TO 30deg", arms));
  CHECK_FALSE(is_certain("STOP arm", arms));
  CHECK_FALSE(is_certain("MOVE wing TO 30deg", R"({"wings": ["left_arm", "right_arm"]})"));
  CHECK_FALSE(is_certain("MOVE lef TO 30deg", R"({"left": ["left_arm", "right_arm"]})"));
  CHECK(is_certain("MOVE amrs TO 30deg", arms));
  CHECK(is_certain("MOVE left_amr TO 30deg", arms));
}

// A certain fix would make another chip or board of it.
TEST_CASE("a name with digits is certain only if case and signs alone differ") {
  const auto is_certain = [](const std::string& robot) {
    const Result result = compile_text("AT START DO\n  LOG \"a\"\nEND\n", robot);
    INFO(robot);
    REQUIRE(result.diagnostics.errors() == 1);
    const auto& fixes = result.diagnostics.all().front().fixes;
    REQUIRE(fixes.size() == 1);
    return fixes.front().applicability == Applicability::certain;
  };
  const auto sensor = [](const std::string& device) {
    return R"({"sensors": [{"name": "it", "device": ")" + device + R"("}]})";
  };
  const auto actuator = [](const std::string& device) {
    return R"({"actuators": [{"name": "it", "device": ")" + device + R"("}]})";
  };
  const auto board = [](const std::string& name) { return R"({"board": ")" + name + R"("})"; };
  for (const char* const other : {"tmp102", "vl53l1x", "mpu6500", "lsm6dso", "lis2mdl", "mcp3004",
                                  "tmp422", "hc-sr05", "tmp15", "tpm105"})
    CHECK_FALSE(is_certain(sensor(other)));
  CHECK_FALSE(is_certain(actuator("ws2811")));
  for (const char* const other : {"microbit-v1", "nucleo-l475rg", "nucleo-f476rg", "mps2-an385"})
    CHECK_FALSE(is_certain(board(other)));
  CHECK(is_certain(sensor("TMP-105")));
  CHECK(is_certain(sensor("buton")));
  CHECK(is_certain(actuator("WS 2812")));
  CHECK(is_certain(board("Microbit_V2")));
}
