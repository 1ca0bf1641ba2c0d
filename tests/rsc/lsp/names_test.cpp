// Completion, and what is asked about a name.
#include <algorithm>
#include <cstdlib>

#include <catch2/catch.hpp>

#include "tests/rsc/lsp/editor.hpp"

using namespace robosync;
using Catch::Contains;
using test::Editor, test::Json, test::Marked, test::Words, test::has, test::has_all;

namespace {

constexpr const char* kBefore =
    "STATE mood: calm, very wild\nFEELING joy FROM 0% TO 100% START 0%\nREMEMBER total = 0\n";
constexpr const char* kAfter = "\nWHEN proximity DISTANCE < 1m DO SET mood TO calm\nEND\n";

Words offered(const std::string& marked) {
  Editor editor;
  return editor.offered(kBefore + marked + kAfter);
}

std::string hover(const std::string& marked) {
  Editor editor;
  const Json said = editor.at("hover", marked);
  return said.is_null() ? "" : said.at("contents").at("value").get<std::string>();
}

// "robot.json:3:20" of each location, as lines and characters from 1.
Words places(const Json& locations) {
  Words result;
  for (const Json& one : locations) {
    const std::string uri = one.at("uri");
    const Json& start = one.at("range").at("start");
    result.push_back(uri.substr(uri.rfind('/') + 1) + ":" +
                     std::to_string(start.at("line").get<int>() + 1) + ":" +
                     std::to_string(start.at("character").get<int>() + 1));
  }
  return result;
}

}  // namespace

TEST_CASE("words are offered that the grammar takes there") {
  CHECK(has_all(offered("|"), {"WHEN", "EVERY", "LET", "BEHAVIOR", "TEST", "SAFETY", "USE"}));
  CHECK(!has(offered("|"), "THEN"));
  CHECK(has_all(offered("WHEN touch LEVEL > 3 |"), {"DO", "AND", "FOR", "COOLDOWN"}));
  CHECK(!has(offered("WHEN touch LEVEL > 3 |"), "WHEN"));
  CHECK(has_all(offered("WHEN touch LEVEL > 3\nDO\n  STOP ALL\n  |"),
                {"IF", "WAIT", "ELSE", "END", "MOVE"}));
  CHECK(!has(offered("WHEN touch LEVEL > 3\n|"), "MOVE"));
  CHECK(has(offered("WHEN touch LEVEL > 3\n|"), "DO"));
  CHECK(has_all(offered("BEHAVIOR b PRIORITY 5\n  |"), {"WHEN", "REMEMBER"}));
  CHECK(!has(offered("BEHAVIOR b PRIORITY 5\n  |"), "DEFINE"));
  const Words told = offered("WHEN touch LEVEL > 3 DO MOVE left_arm |");
  CHECK(has_all(told, {"TO", "BY", "OVER", "AT"}));
  CHECK((!has(told, "START") && !has(told, "FOREVER")));
  const Words value = offered("WHEN touch LEVEL > 3 DO MOVE left_arm TO |");
  CHECK((!has(value, "START") && !has(value, "LOG") && !has(value, "RESUME")));
}

TEST_CASE("a mistake in front of the place does not hide what fits there") {
  CHECK(has(offered("WHEN touch LEVEL >> 3 DO\n  MOVE |"), "left_arm"));
  CHECK(has(offered("WHEN touch LEVEL > 3 DO\n  MOVE arms TO TO 3deg\n  PLAY |"), "sound"));
}

TEST_CASE("names are offered that fit where they stand") {
  CHECK(has_all(offered("WHEN |"), {"touch", "proximity", "mood", "joy", "total", "ABS"}));
  CHECK(!has(offered("WHEN |"), "left_arm"));
  CHECK(has(offered("WHEN proximity |"), "DISTANCE"));
  CHECK(!has(offered("WHEN proximity |"), "LEVEL"));
  CHECK(has_all(offered("WHEN touch LEVEL > 3 DO |"), {"MOVE", "PLAY", "PERFORM"}));
  CHECK(has_all(offered("WHEN touch LEVEL > 3 DO MOVE |"), {"left_arm", "arms", "SLOWLY"}));
  CHECK(!has(offered("WHEN touch LEVEL > 3 DO MOVE |"), "sound"));
  CHECK(!has(offered("WHEN touch LEVEL > 3 DO MOVE left_arm |"), "right_arm"));
  CHECK(has(offered("WHEN touch LEVEL > 3 DO SET |"), "total"));
  CHECK(has(offered("WHEN touch LEVEL > 3 DO RAISE |"), "joy"));
  CHECK(has(offered("WHEN touch LEVEL > 3 DO STOP |"), "arms"));
  CHECK(has(offered("TEST \"t\"\n  AT 1s |"), "touch"));
  CHECK(has(offered("TEST \"t\"\n  EXPECT |"), "MOVE"));
  CHECK(has(offered("LIMIT |"), "arms"));
  CHECK(has(offered("LIMIT arms |"), "SPEED"));
  CHECK(offered("LET |").empty());
  CHECK(offered("% WHEN |").empty());
}

TEST_CASE("the words of a STATE and of a sensor are offered behind it") {
  CHECK(has_all(offered("WHEN mood IS |"), {"calm", "very wild"}));
  CHECK(has_all(offered("WHEN mood IS NOT |"), {"calm", "very wild"}));
  CHECK(has_all(offered("WHEN button POSITION IS |"), {"released", "pressed"}));
  CHECK(has_all(offered("WHEN button IS |"), {"released", "pressed"}));
  CHECK(has(offered("WHEN touch LEVEL > 3 DO SET mood TO |"), "very wild"));
  CHECK(has(offered("TEST \"t\"\n  AT 1s button POSITION = |"), "pressed"));
  CHECK(!has(offered("WHEN touch LEVEL IS |"), "calm"));
}

TEST_CASE("what a block declares is offered in it only") {
  const std::string define = "DEFINE greet WITH how\n  MOVE arms TO (|)\nEND\n";
  CHECK(has(offered(define), "how"));
  CHECK(!has(offered("DEFINE greet WITH how\n  MOVE arms TO how\nEND\nWHEN |"), "how"));
  CHECK(has(offered("BEHAVIOR b PRIORITY 5\n  REMEMBER mine = 0\n  WHEN |"), "mine"));
  CHECK(!has(offered("BEHAVIOR b PRIORITY 5\n  REMEMBER mine = 0\n  WHEN touch LEVEL > 3 DO STOP "
                     "ALL\n  END\nEND\nWHEN |"),
             "mine"));
}

TEST_CASE("modules and sounds are offered, in quotes where they need them") {
  CHECK(has_all(offered("USE |"), {"gestures", "safety_basics"}));
  Editor editor;
  const Json item =
      editor.at("completion", "% 🤖\nWHEN touch LEVEL > 3 DO PLAY sound \"gr|\"\nEND\n")
          .at("items")[0];
  CHECK(item.at("textEdit").at("newText") == "\"greeting.wav\"");
  CHECK(item.at("textEdit").at("range").at("start").at("character") == 35);
  CHECK(item.at("textEdit").at("range").at("end").at("character") == 39);
}

TEST_CASE("a completion replaces the word that is begun, and says what it is") {
  Editor editor;
  const Json items = editor.at("completion", "WHEN proximity DIS|\n").at("items");
  const auto found =
      std::ranges::find_if(items, [](const Json& one) { return one.at("label") == "DISTANCE"; });
  REQUIRE(found != items.end());
  CHECK(found->at("textEdit").at("range").at("start").at("character") == 15);
  CHECK_THAT(found->at("detail").get<std::string>(), Contains("from 2cm to 400cm"));
  CHECK_THAT(found->at("documentation").at("value").get<std::string>(), Contains("Device: "));
}

TEST_CASE("hover says how fast the LIMITs of the program let an actuator move") {
  const std::string rule = "AT START DO MOVE left_|arm SLOWLY\nEND\n";
  CHECK_THAT(hover(rule), !Contains("10deg/s"));
  CHECK_THAT(hover("LIMIT left_arm SPEED TO 10deg/s\n" + rule), Contains("10deg/s"));
}

TEST_CASE("hover says what a name is") {
  CHECK_THAT(hover("WHEN proximity DIST|ANCE < 1m DO STOP ALL\nEND\n"),
             Contains("a channel of the sensor `proximity`") && Contains("from 2cm to 400cm") &&
                 Contains("when it is fed"));
  CHECK_THAT(hover("WHEN touch LEVEL > 3 DO MOVE left_|arm SLOWLY\nEND\n"),
             Contains("an actuator") && Contains("Device: servo") && Contains("`MOVE`") &&
                 Contains("from 0deg to 120deg"));
  CHECK_THAT(hover("WHEN touch LEVEL > 3 DO MO|VE left_arm SLOWLY\nEND\n"),
             Contains("a verb") && Contains("MOVE left_arm takes TO, BY, AT, OVER"));
  CHECK_THAT(hover("WHEN touch LEVEL > 3 DO MOVE left_arm SLO|WLY\nEND\n"),
             Contains("left_arm: 30deg/s"));
  CHECK_THAT(
      hover("% What a 🤖 may take.\nLET most = 7\nWHEN touch LEVEL > mo|st DO STOP ALL\nEND\n"),
      Contains("a LET") && Contains("LET most = 7") && Contains("What a 🤖 may take."));
  CHECK_THAT(hover("STATE mood: calm, wild\nWHEN mood IS wi|ld DO STOP ALL\nEND\n"),
             Contains("a word of `mood`"));
  CHECK(hover("WHEN touch LEVEL > 3 DO STOP ALL\nEND\n|").empty());
}

TEST_CASE("hover over the beginning of a rule says it in English") {
  CHECK_THAT(hover("W|HEN touch LEVEL > 3 DO STOP ALL\nEND\n"),
             Contains("As soon as touch LEVEL becomes more than 3"));
  CHECK(hover("WHEN touch LEVEL > 3\nD|O STOP ALL\nEND\n").empty());
}

TEST_CASE("a definition is found in the program, in robot.json and in the library") {
  Editor editor;
  CHECK(places(Json::array({editor.at(
            "definition", "LET most = 7\nWHEN touch LEVEL > mo|st DO STOP ALL\nEND\n")})) ==
        Words{"robot.rsl:1:5"});
  CHECK(
      places(Json::array({editor.at("definition", "WHEN touch LEV|EL > 3 DO STOP ALL\nEND\n")})) ==
      Words{"robot.json:3:56"});
  CHECK(places(Json::array({editor.at("definition", "WHEN touchLev|el > 3 DO STOP ALL\nEND\n")})) ==
        Words{"robot.json:3:56"});
  CHECK(
      places(Json::array({editor.at("definition", "WHEN touch LEVEL > 3 DO STOP ar|ms\nEND\n")})) ==
      Words{"robot.json:12:15"});
  CHECK(editor.at("definition", "WHEN AB|S(touch LEVEL) > 3 DO STOP ALL\nEND\n").is_null());
}

TEST_CASE("a definition in the library is a file that can be opened, and is not looked at") {
  Editor editor;
  const std::string cache = editor.folder.path("cache");
  const char* const before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before == nullptr ? "" : before;
  setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  const Json place =
      editor.at("definition", "USE gestures\nWHEN touch LEVEL > 3 DO PERFORM wa|ve\nEND\n");
  const auto path = tool::lsp::path_of(place.at("uri").get<std::string>());
  CHECK(path->string().starts_with(cache));
  CHECK(std::filesystem::exists(*path));
  editor.tell(
      "textDocument/didOpen",
      {{"textDocument",
        {{"uri", place.at("uri")}, {"languageId", "rsl"}, {"version", 1}, {"text", "WHEN"}}}});
  editor.rest();
  CHECK(editor.shown.at(place.at("uri")).at("diagnostics").empty());
  if (kept.empty())
    unsetenv("XDG_CACHE_HOME");
  else
    setenv("XDG_CACHE_HOME", kept.c_str(), 1);
}

TEST_CASE("references are all places of a name, and of nothing else of that name") {
  Editor editor;
  const std::string text =
      "REMEMBER total = 0\nDEFINE more WITH total\n  SET Total TO total\nEND\n"
      "WHEN to|tal > 3 DO SET total TO 0\nEND\n";
  const Json all = {{"context", {{"includeDeclaration", true}}}};
  CHECK(places(editor.at("references", text, all)) ==
        Words{"robot.rsl:1:10", "robot.rsl:3:7", "robot.rsl:5:6", "robot.rsl:5:23"});
  const Json used = {{"context", {{"includeDeclaration", false}}}};
  CHECK(places(editor.at("references",
                         "WHEN tou|ch LEVEL > 3 AND touchLevel < 9 DO STOP ALL\nEND\n", used)) ==
        Words{"robot.rsl:1:6"});
  CHECK(places(editor.at("references",
                         "WHEN touch LEV|EL > 3 AND touchLevel < 9 DO STOP ALL\nEND\n", used)) ==
        Words{"robot.rsl:1:12", "robot.rsl:1:26"});
}

TEST_CASE("references of robot.json are those of every program that uses it") {
  Editor editor;
  editor.open("a.rsl", "WHEN touch LEVEL > 3 DO STOP ALL\nEND\n");
  editor.open("b.rsl", "WHEN touch LEVEL > 4 DO STOP ALL\nEND\n");
  editor.open("robot.json", test::kEditorsRobot);
  const Json found =
      editor.ask("textDocument/references", {{"textDocument", {{"uri", editor.uri("robot.json")}}},
                                             {"position", {{"line", 2}, {"character", 15}}},
                                             {"context", {{"includeDeclaration", false}}}});
  CHECK(places(found) == Words{"a.rsl:1:6", "b.rsl:1:6"});
}

TEST_CASE("a name is changed wherever it stands, and the program means the same") {
  Editor editor;
  const std::string text =
      "% 🤖 total\nREMEMBER total = 0\nWHEN touch LEVEL > to|tal DO LOG \"🤖\", total\nEND\n";
  const Json asked = editor.at("prepareRename", text);
  CHECK(asked.at("placeholder") == "total");
  const Json changes = editor.at("rename", text, {{"newName", "sum"}}).at("changes");
  CHECK(changes.size() == 1);
  const Json& edits = changes.at(editor.uri("robot.rsl"));
  CHECK(edits.size() == 3);
  CHECK(edits.back().at("range").at("start") == Json({{"line", 2}, {"character", 38}}));
}

TEST_CASE(
    "a name that others may use, or that nobody gave here, is not changed, and the reason is "
    "said") {
  Editor editor;
  const auto why = [&](const std::string& marked, const std::string& name) {
    return editor.at("rename", marked, {{"newName", name}}).value("message", "");
  };
  CHECK_THAT(why("WHEN touch LEVEL > 3 DO MO|VE arms SLOWLY\nEND\n", "x"),
             Contains("belongs to a device"));
  CHECK_THAT(why("WHEN AB|S(touch LEVEL) > 3 DO STOP ALL\nEND\n", "x"), Contains("word of RSL"));
  CHECK_THAT(why("USE gestures\nWHEN touch LEVEL > 3 DO PERFORM wa|ve\nEND\n", "x"),
             Contains("<gestures>"));
  CHECK_THAT(why("WH|EN touch LEVEL > 3 DO STOP ALL\nEND\n", "x"), Contains("no name here"));
  const std::string let =
      "LET mo|st = 7\nSTATE mood: calm, wild\nWHEN touch LEVEL > most DO SET mood TO wild\nEND\n";
  for (const char* const bad : {"", "7up", "a b", "a-b", "\"a\"", "a\n", "%"})
    CHECK_THAT(why(let, bad), Contains("is no name"));
  CHECK_THAT(why(let, "when"), Contains("is a word of RSL"));
  CHECK_THAT(why(let, "MOOD"), Contains("already"));
  CHECK_THAT(why(let, "touch"), Contains("already"));
  CHECK_THAT(why(let, "touch_level"), Contains("already"));
  CHECK_THAT(why(let, "left_arm"), Contains("already"));
  CHECK_THAT(why(let, "play"), Contains("already"));
  CHECK_THAT(why(let, "slowly"), Contains("already"));
  CHECK_THAT(why(let, "wild"), Contains("already"));
  CHECK_THAT(why(let, "abs"), Contains("already"));
  CHECK(why(let, "most_of_all").empty());
  CHECK(why(let, "MOST").empty());
  CHECK_THAT(why("STATE mood: calm, wild\nWHEN mood IS wi|ld DO SET mood TO calm\nEND\n", "calm"),
             Contains("already"));
}

TEST_CASE("a BEHAVIOR is renamed in robot.json too, inside of its quotes") {
  std::string robot = test::kEditorsRobot;
  robot.insert(robot.rfind('}'), R"(, "behaviors": [{"name": "hug", "priority": 7}])");
  Editor editor(Json::object(), robot.c_str());
  const Json changes =
      editor
          .at("rename", "BEHAVIOR h|ug\n  WHEN touch LEVEL > 3 DO STOP ALL\n  END\nEND\n",
              {{"newName", "embrace"}})
          .at("changes");
  const Json& edit = changes.at(editor.uri("robot.json"))[0];
  CHECK(edit.at("range").at("end").at("character").get<int>() -
            edit.at("range").at("start").at("character").get<int>() ==
        3);
}

TEST_CASE("the name of a module that another program uses is not changed") {
  Editor editor;
  editor.open("robot.rsl", "USE \"part.rsl\"\nWHEN touch LEVEL > 3 DO wave\nEND\n");
  editor.open("part.rsl", "DEFINE wave\n  MOVE arms TO 30deg OVER 1s\nEND\n");
  const Json error =
      editor.ask("textDocument/rename", {{"textDocument", {{"uri", editor.uri("part.rsl")}}},
                                         {"position", {{"line", 0}, {"character", 8}}},
                                         {"newName", "x"}});
  CHECK_THAT(error.value("message", ""), Contains("robot.rsl uses this file as a module"));
}

TEST_CASE("the items of a program are listed, and what stands in them") {
  Editor editor(
      Json{{"textDocument", {{"documentSymbol", {{"hierarchicalDocumentSymbolSupport", true}}}}}});
  const std::string text =
      "LET x = 1\n% 🤖\nBEHAVIOR hug PRIORITY 3\n  WHEN touch LEVEL > 3 % soft\n  DO STOP ALL\n  "
      "END\nEND\nTEST \"🤖\"\n  WAIT 1s\nEND\n";
  editor.open("robot.rsl", text);
  const Json list = editor.ask("textDocument/documentSymbol",
                               {{"textDocument", {{"uri", editor.uri("robot.rsl")}}}});
  REQUIRE(list.size() == 3);
  CHECK(list[0].at("name") == "LET x");
  CHECK(list[1].at("name") == "BEHAVIOR hug");
  CHECK(list[1].at("children")[0].at("name") == "WHEN touch LEVEL > 3");
  CHECK(list[1].at("selectionRange").at("start").at("character") == 9);
  CHECK(list[2].at("name") == "TEST \"🤖\"");
  CHECK(list[2].at("selectionRange").at("end").at("character") == 9);
  Editor flat;
  flat.open("robot.rsl", text);
  const Json all =
      flat.ask("textDocument/documentSymbol", {{"textDocument", {{"uri", flat.uri("robot.rsl")}}}});
  CHECK(all.size() == 4);
  CHECK(all[2].at("containerName") == "BEHAVIOR hug");
}

TEST_CASE("words are coloured by what they mean, in units of UTF-16") {
  Editor editor;
  editor.open("robot.rsl",
              "LET most = 7 % 🤖\nWHEN touch LEVEL > most DO LOG \"🤖\", most\nEND\n");
  const Json legend =
      editor.started.at("capabilities").at("semanticTokensProvider").at("legend").at("tokenTypes");
  const Json data = editor
                        .ask("textDocument/semanticTokens/full",
                             {{"textDocument", {{"uri", editor.uri("robot.rsl")}}}})
                        .at("data");
  REQUIRE(data.size() % 5 == 0);
  std::vector<std::string> seen;
  int line = 0, character = 0;
  for (std::size_t at = 0; at < data.size(); at += 5) {
    character = data[at] == 0 ? character + data[at + 1].get<int>() : data[at + 1].get<int>();
    line += data[at].get<int>();
    seen.push_back(std::to_string(line) + ":" + std::to_string(character) + "+" +
                   std::to_string(data[at + 2].get<int>()) + " " +
                   legend[data[at + 3].get<std::size_t>()].get<std::string>() + " " +
                   std::to_string(data[at + 4].get<int>()));
  }
  CHECK(seen == Words{"0:0+3 keyword 0", "0:4+4 variable 3", "0:11+1 number 0", "1:0+4 keyword 0",
                      "1:5+5 property 0", "1:11+5 property 0", "1:19+4 variable 2",
                      "1:24+2 keyword 0", "1:27+3 keyword 0", "1:31+4 string 0",
                      "1:37+4 variable 2", "2:0+3 keyword 0"});
}

TEST_CASE("blocks of several lines can be folded, also while there is a mistake") {
  Editor editor;
  editor.open("robot.rsl",
              "BEHAVIOR b PRIORITY\n  WHEN touch LEVEL > 3 DO STOP ALL END\n  WHEN touch LEVEL > "
              "4\n  DO STOP ALL\n  END\nEND\nEND\n");
  const Json folds = editor.ask("textDocument/foldingRange",
                                {{"textDocument", {{"uri", editor.uri("robot.rsl")}}}});
  CHECK(folds ==
        Json::array({{{"startLine", 2}, {"endLine", 4}}, {{"startLine", 0}, {"endLine", 5}}}));
}

TEST_CASE("a name is found in every kind of item and statement") {
  const std::string text =
      "REMEMBER total = 0\nLET other = 3\nLIST few: total, other\nCHECK size OF total\n  small "
      "BELOW 3\n  big OTHERWISE\nEND\n"
      "MOTION wave OF left_arm\n  AT 0s total\n  AT 1s (total + 1)\nEND\n"
      "DEFINE note WITH what\n  LOG what, total\nEND\n"
      "SAFETY stop WHEN total > 9\nDO STOP ALL\nRESUME WHEN total < 2\nEND\n"
      "BEHAVIOR b PRIORITY 3\n  WHILE total > 1 AND (total < 3 OR NOT total = 2) COOLDOWN total\n  "
      "DO\n"
      "    IF total > 3\n    DO WAIT total\n    ELSE IF total < 2\n    DO WAIT UNTIL total > 1 "
      "WITHIN total\n"
      "    ELSE\n      MOVE left_arm TO (total) OVER (total)\n    END\n"
      "    REPEAT total TIMES\n      note WITH total\n      THEN\n    END\n    REPEAT WHILE total "
      "> 2\n      WAIT 1s\n    END\n"
      "    PICK ONE\n      OPTION 50%\n        SET total TO total + MIN(total, 3)\n      OPTION "
      "50%\n        RAISE total BY total\n    END\n"
      "    ALERT total\n  END\nEND\nEVERY total TO total\nDO LOG ITEM total OF few\nEND\n"
      "TEST \"t\"\n  AT 1s touch LEVEL = total\n  EXPECT MOVE left_arm TO (total) WITHIN total\n  "
      "EXPECT THAT total > 2 WITHIN 1s\nEND\n";
  std::size_t written = 0;
  for (std::size_t at = text.find("total"); at != std::string::npos;
       at = text.find("total", at + 1))
    ++written;
  Editor editor;
  editor.open("robot.rsl", text);
  const Json found =
      editor.ask("textDocument/references", {{"textDocument", {{"uri", editor.uri("robot.rsl")}}},
                                             {"position", {{"line", 0}, {"character", 10}}},
                                             {"context", {{"includeDeclaration", true}}}});
  CHECK(found.size() == written);
}
