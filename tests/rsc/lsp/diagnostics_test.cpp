// What is wrong while somebody types: shown where it is, taken away when it is mended, with what mends it.
#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/rsc/lsp/editor.hpp"

using namespace robosync;
using Catch::Contains;
using test::Editor, test::Json;

namespace {

const Json kRelated = {{"textDocument", {{"publishDiagnostics", {{"relatedInformation", true}}}}}};

constexpr const char* kWrong =
    "% ä🤖🤖\nWHEN touch LEVL > 3 DO PLAY sound \"greeting.wav\"\nEND\n";
constexpr const char* kRight =
    "% ä🤖🤖\nWHEN touch LEVEL > 3 DO PLAY sound \"greeting.wav\"\nEND\n";

Json range(int line, int begin, int end) {
  return {{"start", {{"line", line}, {"character", begin}}},
          {"end", {{"line", line}, {"character", end}}}};
}

Json actions(Editor& editor, const std::string& name, const Json& where,
             Json context = Json::object()) {
  if (!context.contains("diagnostics")) context["diagnostics"] = Json::array();
  return editor.ask(
      "textDocument/codeAction",
      {{"textDocument", {{"uri", editor.uri(name)}}}, {"range", where}, {"context", context}});
}

std::vector<std::string> codes(const Json& diagnostics) {
  std::vector<std::string> result;
  for (const Json& one : diagnostics)
    result.push_back(one.value("code", ""));
  return result;
}

}  // namespace

TEST_CASE("of many fixes of one mistake, those at the place are offered, and all of them at once") {
  Editor editor;
  editor.open("robot.rsl", "WHEN touch LEVEL > 3 DO\n  STOP ALL;\n  WAIT 1s;\nEND;\n");
  CHECK(editor.diagnostics("robot.rsl").size() == 1);
  const Json offered = actions(editor, "robot.rsl", range(1, 10, 11));
  REQUIRE(offered.size() == 2);
  CHECK(offered[0].at("title") == "Remove `;`");
  CHECK(offered[1].at("kind") == "source.fixAll");
  const Json& edits = offered[1].at("edit").at("changes").at(editor.uri("robot.rsl"));
  CHECK(edits.size() == 3);
}

TEST_CASE("a mistake is shown while it is there, with the version of the text") {
  Editor editor;
  editor.open("robot.rsl", kWrong);
  const Json shown = editor.diagnostics("robot.rsl");
  REQUIRE(shown.size() == 1);
  CHECK(shown[0].at("code") == "E0501");
  CHECK(shown[0].at("severity") == 1);
  CHECK(shown[0].at("source") == "rsc");
  CHECK(shown[0].at("range") == range(1, 11, 15));
  CHECK_THAT(shown[0].at("message").get<std::string>(), Contains("did you mean `LEVEL`?"));
  editor.write("robot.rsl", kRight);
  CHECK(editor.diagnostics("robot.rsl").empty());
  CHECK(editor.shown.at(editor.uri("robot.rsl")).at("version") == editor.version);
}

TEST_CASE("a place behind characters outside of the basic plane is counted in UTF-16") {
  Editor editor;
  editor.open("robot.rsl", "WHEN touch LEVEL > 3 DO LOG \"🤖ä🤖\", nobody\nEND\n");
  CHECK(editor.diagnostics("robot.rsl")[0].at("range") == range(0, 37, 43));
  Editor utf8(Json{{"general", {{"positionEncodings", {"utf-8"}}}}});
  utf8.open("robot.rsl", "WHEN touch LEVEL > 3 DO LOG \"🤖ä🤖\", nobody\nEND\n");
  CHECK(utf8.diagnostics("robot.rsl")[0].at("range") == range(0, 42, 48));
}

TEST_CASE(
    "what is wrong in robot.json is shown there, and looked at again when either text changes") {
  Editor editor(kRelated);
  std::string robot = test::kEditorsRobot;
  editor.open("robot.rsl", kRight);
  robot.replace(robot.find("\"VIRTUAL\""), 9, "\"VIRTUEL\"");
  editor.open("robot.json", robot);
  REQUIRE(!editor.diagnostics("robot.json").empty());
  CHECK(editor.diagnostics("robot.json")[0].at("range").at("start").at("line") == 2);
  editor.write("robot.json", test::kEditorsRobot);
  CHECK(editor.diagnostics("robot.json").empty());
  CHECK(editor.diagnostics("robot.rsl").empty());
  editor.write("robot.json", R"({"sensors": []})");
  CHECK(codes(editor.diagnostics("robot.rsl")).front() == "E0501");
  editor.close("robot.json");  // what the disk has counts again
  CHECK(editor.diagnostics("robot.rsl").empty());
}

TEST_CASE("the other place of a mistake is shown too, in the other file") {
  const std::string wrong = "WHEN touch LEVL > 3 DO STOP ALL\nEND\n";
  Editor editor(kRelated);
  editor.open("robot.rsl", wrong);
  const Json related = editor.diagnostics("robot.rsl")[0].at("relatedInformation");
  CHECK(related[0].at("location").at("uri") == editor.uri("robot.json"));
  CHECK(related[0].at("location").at("range").at("start").at("line") == 2);
  CHECK(related[0].at("message") == "the sensor");
  Editor plain;
  plain.open("robot.rsl", wrong);
  CHECK(!plain.diagnostics("robot.rsl")[0].contains("relatedInformation"));
  CHECK_THAT(plain.diagnostics("robot.rsl")[0].at("message").get<std::string>(),
             Contains("robot.json:3: the sensor"));
}

TEST_CASE("a program without a robot.json says so, and what is wrong with how it is written") {
  Editor editor(Json::object(), nullptr);
  editor.open("robot.rsl", "WHEN touch LEVEL > DO STOP ALL\nEND\n");
  const Json shown = editor.diagnostics("robot.rsl");
  REQUIRE(shown.size() == 2);
  CHECK_THAT(shown[0].at("message").get<std::string>(), Contains("no configuration"));
  CHECK(!shown[0].contains("code"));
  editor.open("robot.json", test::kEditorsRobot);  // not on the disk yet
  CHECK(editor.diagnostics("robot.rsl").size() == 1);
}

TEST_CASE("robot.json alone is looked at, for the programs beside it that are not open") {
  Editor editor;
  editor.open("robot.json", R"({"sensor": []})");
  CHECK(codes(editor.diagnostics("robot.json")) == std::vector<std::string>{"E0202"});
  (void)editor.folder.write("robot.rsl", kRight);
  editor.write("robot.json", R"({"sensors": []})");
  CHECK(codes(editor.diagnostics("robot.rsl")).front() == "E0501");
  editor.write("robot.json", test::kEditorsRobot);
  CHECK(editor.diagnostics("robot.rsl").empty());
}

TEST_CASE("two programs with one robot.json show what is wrong with it once") {
  Editor editor;
  editor.open("a.rsl", kRight);
  editor.open("b.rsl", kRight);
  std::string robot = test::kEditorsRobot;
  robot.replace(robot.find("\"VIRTUAL\""), 9, "\"VIRTUEL\"");
  editor.open("robot.json", robot);
  const auto found = codes(editor.diagnostics("robot.json"));
  CHECK(std::ranges::count(found, found.front()) == 1);
}

TEST_CASE("what mends a robot.json that two programs share is offered once, and done once") {
  Editor editor;
  editor.open("a.rsl", kRight);
  editor.open("b.rsl", kRight);
  std::string robot = test::kEditorsRobot;
  robot.replace(robot.find("\"servo\""), 7, "\"servp\"");
  editor.open("robot.json", robot);
  const Json where = editor.diagnostics("robot.json")[0].at("range");
  CHECK(actions(editor, "robot.json", where, {{"only", {"quickfix"}}}).size() == 1);
  const Json all = actions(editor, "robot.json", where, {{"only", {"source.fixAll"}}});
  REQUIRE(all.size() == 1);
  CHECK(all[0].at("edit").at("changes").at(editor.uri("robot.json")).size() == 1);
  editor.apply("robot.json", all[0].at("edit").at("changes").at(editor.uri("robot.json")));
  CHECK(editor.server().workspace().find(editor.uri("robot.json"))->source.text() ==
        test::kEditorsRobot);
}

TEST_CASE("a module is looked at with the program that uses it") {
  Editor editor;
  (void)editor.folder.write("part.rsl", "DEFINE wave\n  MOVE arms TO 30deg OVER 1s\nEND\n");
  editor.open("robot.rsl", "USE \"part.rsl\"\nWHEN touch LEVEL > 3 DO wave\nEND\n");
  CHECK(editor.diagnostics("robot.rsl").empty());
  editor.open("part.rsl", "DEFINE wave\n  MOVE arms TO 30cm OVER 1s\nEND\n");
  CHECK(!editor.diagnostics("part.rsl").empty());
  editor.write("part.rsl", "DEFINE wave\n  MOVE arms TO 30deg OVER 1s\nEND\n");
  CHECK(editor.diagnostics("part.rsl").empty());
  CHECK(editor.diagnostics("robot.rsl").empty());
}

TEST_CASE("what is closed shows nothing any more") {
  Editor editor;
  editor.open("robot.rsl", kWrong);
  editor.close("robot.rsl");
  CHECK(editor.diagnostics("robot.rsl").empty());
}

TEST_CASE("a file that changes on the disk is read again when the editor says so") {
  Editor editor;
  editor.open("robot.rsl", kRight);
  (void)editor.folder.write("robot.json", R"({"sensors": []})");
  editor.tell("workspace/didChangeWatchedFiles", {{"changes", Json::array()}});
  editor.rest();
  CHECK(!editor.diagnostics("robot.rsl").empty());
  const auto registers = [](const Editor& one) {
    return std::ranges::any_of(one.others, [](const Json& message) {
      return message.value("method", "") == "client/registerCapability";
    });
  };
  CHECK(!registers(editor));
  Editor watcher(Json{{"workspace", {{"didChangeWatchedFiles", {{"dynamicRegistration", true}}}}}});
  watcher.rest();
  CHECK(registers(watcher));
}

TEST_CASE("a fix is offered where the mistake is, and what is certain is preferred") {
  Editor editor;
  editor.open("robot.rsl", kWrong);
  const Json offered = actions(editor, "robot.rsl", range(1, 12, 12), {{"only", {"quickfix"}}});
  REQUIRE(offered.size() == 1);
  CHECK(offered[0].at("title") == "Replace `LEVL` with `LEVEL`");
  CHECK(offered[0].at("isPreferred") == true);
  CHECK(offered[0].at("diagnostics") == editor.diagnostics("robot.rsl"));
  CHECK(offered[0].at("edit").at("changes").at(editor.uri("robot.rsl")) ==
        Json::array({{{"range", range(1, 11, 15)}, {"newText", "LEVEL"}}}));
  CHECK(actions(editor, "robot.rsl", range(2, 0, 1), {{"only", {"quickfix"}}}).empty());
  editor.apply("robot.rsl", offered[0].at("edit").at("changes").at(editor.uri("robot.rsl")));
  CHECK(editor.server().workspace().find(editor.uri("robot.rsl"))->source.text() == kRight);
}

TEST_CASE("a fix that is not certain is not preferred, and not part of all that is certain") {
  Editor editor;
  editor.open("robot.rsl", "WHEN touch LEVEL > 3\nDO\n  WAIT UNTIL touch LEVEL < 1\nEND\n");
  const Json offered = actions(editor, "robot.rsl", range(2, 3, 3));
  REQUIRE(offered.size() == 1);
  CHECK(offered[0].at("isPreferred") == false);
  CHECK(offered[0].at("kind") == "quickfix");
}

TEST_CASE("a likely fix is offered as it is, but not among those that are certain") {
  Editor editor;
  editor.open("robot.rsl", "WHEN touch LEVEL > .3\nDO\n  LOG \"a\"\nEND\n");
  const Json offered = actions(editor, "robot.rsl", range(0, 19, 19));
  REQUIRE(offered.size() == 1);
  CHECK(offered[0].at("title") == "Replace `.3` with `0.3`");
  CHECK(offered[0].at("kind") == "quickfix");
  CHECK(offered[0].at("isPreferred") == false);
}

TEST_CASE("a module that has what is missing is offered") {
  Editor editor;
  editor.open("robot.rsl", "% 🤖\nWHEN touch LEVEL > 3 DO PERFORM wave\nEND\n");
  const Json offered = actions(editor, "robot.rsl", range(1, 34, 34));
  REQUIRE(offered.size() == 1);
  CHECK(offered[0].at("title") == "Insert `USE gestures`");
  editor.apply("robot.rsl", offered[0].at("edit").at("changes").at(editor.uri("robot.rsl")));
  CHECK(editor.server().workspace().find(editor.uri("robot.rsl"))->source.text() ==
        "% 🤖\nUSE gestures\nWHEN touch LEVEL > 3 DO PERFORM wave\nEND\n");
  CHECK(actions(editor, "robot.rsl", range(0, 0, 0)).empty());
}

TEST_CASE("all that is certain is mended at once") {
  Editor editor;
  editor.open("robot.rsl",
              "WHEN touch LEVL > 3 DO STOP ALL\nEND\nWHEN touch LEVE > 4 DO STOP ALL\nEND\n"
              "EVERY 5s DO STOP left_arn\nEND\n");
  const Json all = actions(editor, "robot.rsl", range(0, 0, 0), {{"only", {"source.fixAll"}}});
  REQUIRE(all.size() == 1);
  CHECK(all[0].at("edit").at("changes").at(editor.uri("robot.rsl")).size() == 3);
}

TEST_CASE("formatting gives what rsc fmt writes, as a change of whole lines") {
  Editor editor;
  const std::string before =
      "% 🤖\nWHEN touch LEVEL<3 DO LOG \"x\" ELSE LOG \"y\" END\nLET a = 1\n";
  editor.open("robot.rsl", before);
  const Json params = {{"textDocument", {{"uri", editor.uri("robot.rsl")}}}};
  const Json edits = editor.ask("textDocument/formatting", params);
  REQUIRE(edits.size() == 1);
  editor.apply("robot.rsl", edits);
  const std::string file = editor.folder.write("robot.rsl", before);
  CHECK(test::rsc({"fmt", file}).exit == 0);
  CHECK(editor.server().workspace().find(editor.uri("robot.rsl"))->source.text() ==
        editor.folder.read("robot.rsl"));
  CHECK(editor.ask("textDocument/formatting", params).empty());
  editor.write("robot.rsl", "WHEN touch <\n");
  CHECK(editor.ask("textDocument/formatting", params).is_null());
  editor.open("other.json", "{\"name\":\"ada\"}\n");
  const Json of_json = {{"textDocument", {{"uri", editor.uri("other.json")}}}};
  editor.apply("other.json", editor.ask("textDocument/formatting", of_json));
  CHECK(editor.server().workspace().find(editor.uri("other.json"))->source.text() ==
        "{\n  \"name\": \"ada\"\n}\n");
  editor.write("other.json", "{\"name\":\n");
  CHECK(editor.ask("textDocument/formatting", of_json).is_null());
}
