// Names of robot.json, from both files: where they are, and renaming in all programs that say them, open or not.
#include <algorithm>
#include <filesystem>

#include <catch2/catch.hpp>

#include "tests/compiler/compiled.hpp"
#include "tests/rsc/lsp/editor.hpp"

using namespace robosync;
using Catch::Contains;
using test::Editor, test::Json, test::Marked, test::Words;

namespace {

// A robot in which names refer to others in every way there is.
constexpr const char* kReferringRobot = R"({
  "sensors": [
    {"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}, "HEAT": {"range": [0, 10]}}},
    {"name": "left_wheel", "device": "encoder", "type": "GPIO", "pin": 40, "pulses_per_turn": 20, "wheel": "65mm"},
    {"name": "right_wheel", "device": "encoder", "type": "GPIO", "pin": 41, "pulses_per_turn": 20, "wheel": "65mm"}
  ],
  "actuators": [
    {"name": "left_arm", "type": "VIRTUAL", "device": "joint", "range": ["0deg", "120deg"]},
    {"name": "right_arm", "type": "VIRTUAL", "device": "joint", "range": ["0deg", "120deg"]},
    {"name": "wheels", "device": "differential_drive", "type": "PWM", "left": [0, 1], "right": [2, 3],
     "speed": "30cm/s", "track": "12cm", "encoders": ["left_wheel", "right_wheel"]}
  ],
  "groups": {"arms": ["left_arm", "right_arm"]},
  "behaviors": [{"name": "hug", "priority": 7, "action": "arms"}, {"name": "point", "priority": 5, "action": "left_arm"}],
  "algorithms": [{"name": "mood_of", "module": "touch_levels", "input": "touch"}]
}
)";
const std::string kHug =
    "BEHAVIOR hug\n  WHEN touch LEVEL > 3 AND touchLevel < 9\n"
    "  DO MOVE arms TO 30deg\n  END\nEND\n";
const std::string kOther = "WHEN touch_heat > 3 DO MOVE left_arm TO 9deg\nEND\n";

// Writes what has no open text.
void save(const Editor& editor, const std::string& name, const std::string& text) {
  (void)editor.folder.write(name, text);
}

// Asks about the `nth` of the places where `word` stands in a text that is open.
Json asked(Editor& editor, const std::string& method, const std::string& name,
           const std::string& text, const std::string& word, int nth = 1,
           Json more = Json::object()) {
  std::size_t at = text.find(word);
  while (--nth > 0)
    at = text.find(word, at + 1);
  REQUIRE(at != std::string::npos);
  std::string marked = text;
  more["textDocument"] = {{"uri", editor.uri(name)}};
  more["position"] = Marked(marked.insert(at + 1, "|")).place;
  return editor.ask("textDocument/" + method, more);
}

// The text with the edits, which have only ASCII before them in their lines.
std::string edited(const std::string& text, const Json& edits) {
  const auto offset = [&](const Json& place) {
    std::size_t at = 0;
    for (int line = place.at("line"); line > 0; --line)
      at = text.find('\n', at) + 1;
    return at + place.at("character").get<std::size_t>();
  };
  std::string result;
  std::size_t end = 0;
  for (const Json& edit : edits) {
    const std::size_t begin = offset(edit.at("range").at("start"));
    result += text.substr(end, begin - end) + edit.at("newText").get<std::string>();
    end = offset(edit.at("range").at("end"));
  }
  return result + text.substr(end);
}

// "robot.json 3" for each file with so many places.
std::string counted(const Json& locations) {
  std::map<std::string, int> counts;
  for (const Json& one : locations) {
    const std::string uri = one.at("uri");
    ++counts[uri.substr(uri.rfind('/') + 1)];
  }
  std::string text;
  for (const auto& [name, count] : counts)
    text += name + " " + std::to_string(count) + " ";
  return text;
}

const Json kAll = {{"context", {{"includeDeclaration", true}}}};

// With two programs, one of which is not open.
struct Both : Editor {
  Both() : Editor(Json::object(), kReferringRobot) {
    save(*this, "other.rsl", kOther);
    open("robot.rsl", kHug);
  }
  void open_robot() { open("robot.json", kReferringRobot); }
  Json renamed(const std::string& file, const std::string& text, const std::string& word, int nth,
               const std::string& name) {
    return asked(*this, "rename", file, text, word, nth, {{"newName", name}});
  }
  // All three files after the answer.
  std::map<std::string, std::string> after(const Json& answer) {
    std::map<std::string, std::string> texts = {
        {"robot.rsl", kHug}, {"other.rsl", kOther}, {"robot.json", kReferringRobot}};
    for (auto& [name, text] : texts)
      if (answer.at("changes").contains(uri(name)))
        text = edited(text, answer.at("changes").at(uri(name)));
    return texts;
  }
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace

TEST_CASE("the robot of these tests has no mistake") {
  Both editor;
  editor.open("other.rsl", kOther);
  editor.open_robot();
  for (const char* const name : {"robot.json", "robot.rsl", "other.rsl"})
    for (const Json& one : editor.diagnostics(name))
      CHECK(one.at("severity") != 1);
}

TEST_CASE("a name that another entry of robot.json gives leads to its declaration") {
  Both editor;
  editor.open_robot();
  for (const auto& [word, nth, line] :
       {std::tuple("left_arm", 2, 7), std::tuple("left_arm", 3, 7), std::tuple("\"touch\"", 2, 2),
        std::tuple("left_wheel", 2, 3), std::tuple("right_wheel", 2, 4),
        std::tuple("\"arms\"", 2, 12)}) {
    CAPTURE(word, nth);
    const Json place = asked(editor, "definition", "robot.json", kReferringRobot, word, nth);
    CHECK(place.at("uri") == editor.uri("robot.json"));
    CHECK(place.at("range").at("start").at("line") == line);
  }
  const Json behavior = asked(editor, "definition", "robot.json", kReferringRobot, "hug");
  CHECK(behavior.at("uri") == editor.uri("robot.rsl"));
}

TEST_CASE("the places of a name are the same from robot.json and from RSL, in all programs") {
  Both editor;
  const std::string places = "other.rsl 1 robot.json 3 ";
  CHECK(counted(asked(editor, "references", "robot.rsl", kHug, "touch", 1, kAll)) ==
        "robot.json 2 robot.rsl 1 ");
  editor.open("other.rsl", kOther);
  CHECK(counted(asked(editor, "references", "other.rsl", kOther, "left_arm", 1, kAll)) == places);
  editor.open_robot();
  for (const int nth : {1, 2, 3})
    CHECK(counted(asked(editor, "references", "robot.json", kReferringRobot, "left_arm", nth,
                        kAll)) == places);
  CHECK(counted(asked(editor, "references", "robot.json", kReferringRobot, "hug", 1, kAll)) ==
        "robot.json 1 robot.rsl 1 ");
}

TEST_CASE("the places of a name in the same text are highlighted, its declaration in another way") {
  Both editor;
  editor.open_robot();
  const Json found =
      asked(editor, "documentHighlight", "robot.json", kReferringRobot, "left_arm", 2);
  REQUIRE(found.size() == 3);
  CHECK(found[0].at("kind") == 3);
  CHECK(found[1].at("kind") == 2);
  CHECK(found[1].at("range").at("end").at("character").get<int>() -
            found[1].at("range").at("start").at("character").get<int>() ==
        8);
  CHECK(asked(editor, "documentHighlight", "robot.rsl", kHug, "touch").size() == 1);
  CHECK(asked(editor, "documentHighlight", "robot.rsl", kHug, "MOVE").size() == 1);
  CHECK(asked(editor, "documentHighlight", "robot.rsl", kHug, "WHEN").empty());
}

TEST_CASE("a name of robot.json is changed in robot.json and in every program, open or not") {
  Both editor;
  editor.open_robot();
  struct Case {
    std::string file, word;
    int nth;
    std::string name;
  };
  const Case cases[] = {
      {"robot.json", "left_arm", 1, "paw"},     {"robot.json", "left_arm", 2, "paw"},
      {"robot.json", "left_arm", 3, "paw"},     {"robot.json", "left_wheel", 1, "rolls"},
      {"robot.json", "left_wheel", 2, "rolls"}, {"robot.json", "arms", 1, "paws"},
      {"robot.json", "arms", 2, "paws"},        {"robot.rsl", "arms", 1, "paws"},
      {"robot.json", "hug", 1, "embrace"},      {"robot.rsl", "hug", 1, "embrace"},
      {"robot.json", "wheels", 1, "base"},      {"robot.json", "mood_of", 1, "feel"},
  };
  for (const Case& one : cases) {
    CAPTURE(one.file, one.word, one.nth);
    const std::string& text = one.file == "robot.json" ? kReferringRobot : kHug;
    const auto after = editor.after(editor.renamed(one.file, text, one.word, one.nth, one.name));
    CHECK(after.at("robot.json") == replaced(kReferringRobot, one.word, one.name));
    CHECK(after.at("robot.rsl") == replaced(kHug, one.word, one.name));
    CHECK(after.at("other.rsl") == replaced(kOther, one.word, one.name));
  }
}

TEST_CASE("a sensor and its channel are changed where one word says both") {
  Both editor;
  editor.open_robot();
  auto after = editor.after(editor.renamed("robot.rsl", kHug, "touch", 1, "HAND"));
  CHECK_THAT(after.at("robot.rsl"), Contains("HAND LEVEL > 3 AND handLevel < 9"));
  CHECK_THAT(after.at("other.rsl"), Contains("hand_heat > 3"));
  CHECK_THAT(after.at("robot.json"),
             Contains("\"name\": \"HAND\"") && Contains("\"input\": \"HAND\""));
  after = editor.after(editor.renamed("robot.json", kReferringRobot, "\"touch\"", 2, "hand"));
  CHECK_THAT(after.at("robot.rsl"), Contains("hand LEVEL > 3 AND handLevel < 9"));
  after = editor.after(editor.renamed("robot.json", kReferringRobot, "LEVEL", 1, "FORCE"));
  CHECK_THAT(after.at("robot.rsl"), Contains("touch FORCE > 3 AND touchForce < 9"));
  CHECK(after.at("other.rsl") == kOther);
  after = editor.after(editor.renamed("robot.rsl", kHug, "touchLevel", 1, "force"));
  CHECK_THAT(after.at("robot.rsl"), Contains("touch force > 3 AND touchForce < 9"));
  after = editor.after(editor.renamed("robot.json", kReferringRobot, "HEAT", 1, "Warmth"));
  CHECK_THAT(after.at("other.rsl"), Contains("touch_Warmth > 3"));
}

TEST_CASE("a sensor and its channel are changed in scenarios and in their recordings") {
  const std::string scenario = R"({"duration": "9s", "stimuli": [
  {"at": "1s", "sensor": "touch", "channel": "LEVEL", "value": 3},
  {"at": "2s", "sensor": "TOUCH", "channel": "HEAT", "value": 3},
  {"at": "2s", "sensor": "touch.level", "value": 3},
  {"csv": "both.csv"}, {"csv": "both.csv", "at": "3s"}, {"csv": "one.csv", "sensor": "touch"},
  {"csv": "missing.csv"}, {"csv": "touch", "sensor": 7}, {"sensor": "\\u0074ouch", "value": "touch"}, "touch"]}
)";
  const std::string both = "touch.HEAT,time (s);\"touch.LEVEL (%)\"\r\n1,2,touch\r\n";
  const std::string one = "time (s)\tLEVEL\t touch \n";
  Both editor;
  save(editor, "play.json", scenario);
  save(editor, "both.csv", "\xEF\xBB\xBF" + both);  // which editors do not count
  save(editor, "one.csv", one);
  save(editor, "broken.json", "{\"stimuli\": [{\"sensor\": \"touch\"");
  const auto after = [&](const Json& answer, const std::string& name, const std::string& text) {
    const Json& changes = answer.at("changes");
    return changes.contains(editor.uri(name)) ? edited(text, changes.at(editor.uri(name))) : text;
  };
  const Json hand = editor.renamed("robot.rsl", kHug, "touch", 1, "hand");
  std::string wanted = replaced(scenario, "\"touch\", \"ch", "\"hand\", \"ch");
  wanted = replaced(replaced(wanted, "TOUCH", "hand"), "touch.level", "hand.level");
  CHECK(after(hand, "play.json", scenario) ==
        replaced(wanted, R"("one.csv", "sensor": "touch")", R"("one.csv", "sensor": "hand")"));
  CHECK(after(hand, "both.csv", both) == replaced(both, "touch.", "hand."));
  CHECK(after(hand, "one.csv", one) == one);
  CHECK_FALSE(hand.at("changes").contains(editor.uri("broken.json")));
  const Json force = editor.renamed("robot.rsl", kHug, "LEVEL", 1, "FORCE");
  CHECK(after(force, "play.json", scenario) ==
        replaced(replaced(scenario, "LEVEL", "FORCE"), "touch.level", "touch.FORCE"));
  CHECK(after(force, "both.csv", both) == replaced(both, "LEVEL", "FORCE"));
  CHECK(after(force, "one.csv", one) == replaced(one, "LEVEL", "FORCE"));
  editor.open_robot();
  const Json arm = editor.renamed("robot.json", kReferringRobot, "left_arm", 1, "touched");
  CHECK_FALSE(arm.at("changes").contains(editor.uri("play.json")));
}

TEST_CASE("scenarios in a folder with two robots are not changed") {
  Both editor;
  save(editor, "play.json",
       R"({"stimuli": [{"at": "1s", "sensor": "touch", "channel": "LEVEL", "value": 3}]})");
  const auto is_changed = [&] {
    return editor.renamed("robot.rsl", kHug, "touch", 1, "hand")
        .at("changes")
        .contains(editor.uri("play.json"));
  };
  CHECK(is_changed());
  save(editor, "another.json", R"({"sensors": []})");
  CHECK_FALSE(is_changed());
}

TEST_CASE("a name is shown without its quotes before it is changed") {
  Both editor;
  editor.open_robot();
  const Json shown = asked(editor, "prepareRename", "robot.json", kReferringRobot, "left_arm", 2);
  CHECK(shown.at("placeholder") == "left_arm");
  CHECK(shown.at("range").at("end").at("character").get<int>() -
            shown.at("range").at("start").at("character").get<int>() ==
        8);
}

TEST_CASE("a name of robot.json that is taken, or is none, is refused with the reason") {
  Both editor;
  editor.open_robot();
  save(editor, "third.rsl", "LET most = 3\nWHEN touch LEVEL > most DO LOG \"x\"\nEND\n");
  const auto why = [&](const std::string& word, int nth, const std::string& name) {
    return editor.renamed("robot.json", kReferringRobot, word, nth, name).value("message", "");
  };
  for (const char* const bad : {"", "7up", "a b", "a\"b", "a-b", "\"a\"", "%"})
    CHECK_THAT(why("left_arm", 1, bad), Contains("is no name"));
  CHECK_THAT(why("left_arm", 2, "when"), Contains("is a word of RSL"));
  for (const char* const taken : {"right_arm", "ARMS", "wheels", "touch", "hug", "most", "MOVE"})
    CHECK_THAT(why("left_arm", 1, taken), Contains("already"));
  CHECK_THAT(why("LEVEL", 1, "heat"), Contains("already"));
  CHECK(why("left_arm", 1, "Left_Arm").empty());
  CHECK_THAT(why("encoder", 1, "x"), Contains("no name here"));
  CHECK_THAT(why("priority", 1, "x"), Contains("no name here"));
  CHECK_THAT(editor.renamed("robot.rsl", kHug, "MOVE", 1, "x").value("message", ""),
             Contains("belongs to a device"));
}

TEST_CASE("a name after which another one would mean something else is refused") {
  Editor editor;
  // `touch_level` would be the channel and the LET.
  save(editor, "robot.json", kReferringRobot);
  editor.open("robot.rsl", "LET handLevel = 3\nWHEN touch LEVEL > handLevel DO LOG \"x\"\nEND\n");
  const Json error = asked(editor, "rename", "robot.rsl",
                           "LET handLevel = 3\nWHEN touch LEVEL > handLevel DO LOG \"x\"\nEND\n",
                           "touch", 1, {{"newName", "hand"}});
  CHECK_THAT(error.value("message", ""), Contains("then "));
}

TEST_CASE("a name that the library says is not changed") {
  const std::string robot = replaced(kReferringRobot, "left_arm", "head");
  Editor editor(Json::object(), robot.c_str());
  editor.open("robot.rsl", "USE attention\nWHEN touch LEVEL > 3 DO LOG \"x\"\nEND\n");
  editor.open("robot.json", robot);
  const Json answer = asked(editor, "rename", "robot.json", robot, "head", 1, {{"newName", "paw"}});
  CHECK_THAT(answer.value("message", ""), Contains("the module <attention> of the library"));
}

TEST_CASE("a name in a module that a program of another robot uses is not changed") {
  Both editor;
  std::filesystem::create_directory(editor.folder.path("far"));
  save(editor, "far/robot.json", kReferringRobot);
  save(editor, "part.rsl", "DEFINE wave\n  MOVE left_arm TO 30deg\nEND\n");
  editor.open("robot.rsl", "USE \"part.rsl\"\nWHEN touch LEVEL > 3 DO wave\nEND\n");
  editor.open("far/robot.rsl", "USE \"../part.rsl\"\nWHEN touch LEVEL > 3 DO wave\nEND\n");
  editor.open_robot();
  CHECK_THAT(
      editor.renamed("robot.json", kReferringRobot, "left_arm", 1, "paw").value("message", ""),
      Contains("part.rsl says `left_arm`, and is also a module of"));
}

TEST_CASE("a module of the same robot is changed with its programs") {
  Both editor;
  save(editor, "part.rsl", "DEFINE wave\n  MOVE left_arm TO 30deg\nEND\n");
  editor.open("robot.rsl", "USE \"part.rsl\"\nWHEN touch LEVEL > 3 DO wave\nEND\n");
  editor.open_robot();
  const Json changes =
      editor.renamed("robot.json", kReferringRobot, "left_arm", 1, "paw").at("changes");
  CHECK(edited(editor.folder.read("part.rsl"), changes.at(editor.uri("part.rsl"))) ==
        "DEFINE wave\n  MOVE paw TO 30deg\nEND\n");
  CHECK(changes.contains(editor.uri("other.rsl")));
  CHECK_FALSE(changes.contains(editor.uri("robot.rsl")));
}

TEST_CASE(
    "with more programs than are looked at, names of robot.json are not changed, but others are") {
  Both editor;
  for (int i = 0; i < 40; ++i)
    save(editor, "p" + std::to_string(i) + ".rsl", kOther);
  CHECK_THAT(editor.renamed("robot.rsl", kHug, "arms", 1, "paws").value("message", ""),
             Contains("so many programs use robot.json"));
  const std::string let = "LET most = 3\nWHEN touch LEVEL > most DO LOG \"x\"\nEND\n";
  editor.open("robot.rsl", let);
  CHECK(editor.renamed("robot.rsl", let, "most", 1, "bound").contains("changes"));
}

TEST_CASE("what was written to a file that is not open is seen when a name is changed") {
  Both editor;
  editor.open_robot();
  (void)editor.renamed("robot.json", kReferringRobot, "left_arm", 1, "paw");
  save(editor, "other.rsl", "% left\n" + kOther);
  const Json answer = editor.renamed("robot.json", kReferringRobot, "left_arm", 1, "paw");
  CHECK(answer.at("changes").at(editor.uri("other.rsl"))[0].at("range").at("start").at("line") ==
        1);
}

TEST_CASE("changed and changed back, every name of every example is as before") {
  namespace fs = std::filesystem;
  std::size_t names = 0, twice = 0;
  for (const fs::directory_entry& example : fs::directory_iterator(EXAMPLES)) {
    if (!fs::exists(example.path() / "robot.json")) continue;
    const std::string robot = compiler::testing::read_file(example.path() / "robot.json");
    const std::string program = compiler::testing::read_file(example.path() / "robot.rsl");
    Editor editor(Json::object(), robot.c_str());
    for (const fs::directory_entry& file : fs::directory_iterator(example.path()))
      if (file.path().extension() != ".json" && file.is_regular_file())
        fs::copy(file.path(), editor.folder.path(file.path().filename()),
                 fs::copy_options::overwrite_existing);
    editor.open("robot.rsl", program);
    editor.open("robot.json", robot);
    const std::size_t errors = editor.diagnostics("robot.rsl").size();
    for (std::size_t at = robot.find("\"name\": \""); at != std::string::npos;
         at = robot.find("\"name\": \"", at + 1)) {
      const std::size_t begin = at + 9, end = robot.find('"', begin);
      const std::string old = robot.substr(begin, end - begin);
      if (robot.rfind('\n', at) == robot.find('\n')) continue;  // of the robot itself
      CAPTURE(example.path().string(), old);
      Json where = {{"textDocument", {{"uri", editor.uri("robot.json")}}},
                    {"position",
                     {{"line", std::count(robot.begin(),
                                          robot.begin() + static_cast<std::ptrdiff_t>(at), '\n')},
                      {"character", begin - robot.rfind('\n', at) - 1}}}};
      where["newName"] = "zzzz";
      const Json there = editor.ask("textDocument/rename", where);
      if (!there.contains("changes")) continue;  // refused
      ++names;
      std::string changed_robot = robot, changed_program = program;
      const Json& changes = there.at("changes");
      REQUIRE(changes.contains(editor.uri("robot.json")));
      changed_robot = edited(robot, changes.at(editor.uri("robot.json")));
      if (changes.contains(editor.uri("robot.rsl")))
        changed_program = edited(program, changes.at(editor.uri("robot.rsl")));
      editor.write("robot.json", changed_robot);
      editor.write("robot.rsl", changed_program);
      CHECK(editor.diagnostics("robot.rsl").size() == errors);
      where["newName"] = old;
      const Json back = editor.ask("textDocument/rename", where);
      if (!back.contains("changes")) {  // two things had that name, or a word of RSL
        CHECK_THAT(back.value("message", ""), Contains("already") || Contains("is a word of RSL"));
        ++twice;
        editor.write("robot.json", robot);
        editor.write("robot.rsl", program);
        continue;
      }
      CHECK(edited(changed_robot, back.at("changes").at(editor.uri("robot.json"))) == robot);
      if (back.at("changes").contains(editor.uri("robot.rsl")))
        CHECK(edited(changed_program, back.at("changes").at(editor.uri("robot.rsl"))) == program);
      editor.write("robot.json", robot);
      editor.write("robot.rsl", program);
    }
  }
  CHECK(names > 60);
  CHECK(twice < 8);
}
