// Random changes, as an editor sends them: the text of the server is that of the editor, and no question about it ends badly.
// The number of changes is ROBOSYNC_EDITS where that is set (scripts/soak).
#include <cstdlib>
#include <random>

#include <catch2/catch.hpp>

#include "tests/rsc/lsp/editor.hpp"

using namespace robosync;
using test::Editor, test::Json;

namespace {

// A text as the editor has it: UTF-16, in which positions are counted by themselves.
class Text {
public:
  explicit Text(std::u16string text) : text_(std::move(text)) {}
  std::size_t size() const { return text_.size(); }
  bool is_between(std::size_t at) const {  // two halves of a code point, or CR and LF
    const bool halves = at > 0 && at < size() && (text_[at] & 0xFC00) == 0xDC00;
    return halves || (at > 0 && at < size() && text_[at - 1] == u'\r' && text_[at] == u'\n');
  }
  Json place(std::size_t at) const {
    std::size_t line = 0, start = 0;
    for (std::size_t i = 0; i < at; ++i) {
      const bool end =
          text_[i] == u'\n' || (text_[i] == u'\r' && (i + 1 >= size() || text_[i + 1] != u'\n'));
      if (end) ++line, start = i + 1;
    }
    return {{"line", line}, {"character", at - start}};
  }
  void replace(std::size_t begin, std::size_t end, const std::u16string& by) {
    text_.replace(begin, end - begin, by);
  }
  std::string utf8() const {
    std::string result;
    for (std::size_t i = 0; i < size(); ++i) {
      char32_t c = text_[i];
      if ((c & 0xFC00) == 0xD800) c = 0x10000 + ((c & 0x3FFU) << 10U) + (text_[++i] & 0x3FFU);
      const auto add = [&](char32_t bits, unsigned mark) {
        result += static_cast<char>(mark | bits);
      };
      if (c < 0x80)
        add(c, 0);
      else if (c < 0x800)
        add(c >> 6U, 0xC0), add(c & 0x3FU, 0x80);
      else if (c < 0x10000)
        add(c >> 12U, 0xE0), add(c >> 6U & 0x3FU, 0x80), add(c & 0x3FU, 0x80);
      else
        add(c >> 18U, 0xF0), add(c >> 12U & 0x3FU, 0x80), add(c >> 6U & 0x3FU, 0x80),
            add(c & 0x3FU, 0x80);
    }
    return result;
  }

private:
  std::u16string text_;
};

using Pieces = std::vector<std::u16string>;
const Pieces kPieces = {u"WHEN touch LEVEL > 3\nDO\n  MOVE arms TO 30deg SLOWLY\nEND\n",
                        u"% ä🤖𝄞\n",
                        u"\n",
                        u"\r\n",
                        u"\r",
                        u" ",
                        u"🤖",
                        u"END\n",
                        u"STATE mood: calm, wild\n",
                        u"mood IS ",
                        u"\"",
                        u"DEFINE greet WITH how\n  SAY how\nEND\n",
                        u"greet WITH 3\n",
                        u"BEHAVIOR b PRIORITY 3\n",
                        u"touch ",
                        u"LEVEL",
                        u"(",
                        u")",
                        u", ",
                        u"USE gestures\n",
                        u"PLAY sound \"greeting.wav\"\n",
                        u"TEST \"t\"\n  AT 1s touch LEVEL = 2\nEND\n",
                        u"3cm",
                        u"",
                        u"",
                        u"",
                        u""};

const Pieces kPiecesOfRobot = {u"{\"name\": \"touch\", \"device\": \"hc-sr04\"}",
                               u"\"sensors\": [",
                               u"\"channels\": {\"LEVEL\": {\"range\": [0, 9]}}",
                               u"\"actuators\": [{\"device\": \"servo\", \"name\": \"🤖\"}],",
                               u"\"groups\": {\"arms\": [\"left_arm\"]}",
                               u"\"board\": \"microbit-v2\",",
                               u"{",
                               u"}",
                               u"[",
                               u"]",
                               u"[[[[[[[[",
                               u"\"",
                               u"\\",
                               u":",
                               u",",
                               u"🤖",
                               u"\r",
                               u"\n",
                               u" ",
                               u"",
                               u"",
                               u"",
                               u""};

constexpr const char* kQuestions[] = {
    "completion",          "hover",       "definition",     "references", "documentHighlight",
    "prepareRename",       "rename",      "documentSymbol", "formatting", "codeAction",
    "semanticTokens/full", "foldingRange"};

std::size_t number_of_edits() {
  const char* const wanted = std::getenv("ROBOSYNC_EDITS");
  return wanted == nullptr ? 1000 : std::strtoul(wanted, nullptr, 10);
}

const std::u16string kEditedProgram =
    u"WHEN touch LEVEL > 3\nDO\n  MOVE arms TO 30deg SLOWLY\nEND\n";

class Typist {
public:
  Typist(unsigned seed, std::string name, std::u16string text, const Pieces& pieces)
      : random_(seed), name_(std::move(name)), pieces_(pieces), text_(std::move(text)) {
    editor_.open("robot.rsl", Text(kEditedProgram).utf8());
    if (name_ != "robot.rsl") editor_.open(name_, text_.utf8());
  }

  void change() {
    Json changes = Json::array();
    const std::size_t count = below(10) == 0 ? 3 : 1;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t begin = place();
      std::size_t end = below(3) == 0 ? std::min(text_.size(), begin + below(60)) : begin;
      while (text_.is_between(end))
        ++end;
      const std::u16string by =
          text_.size() > 3000 && end == begin ? u"" : pieces_[below(pieces_.size())];
      changes.push_back({{"range", {{"start", text_.place(begin)}, {"end", text_.place(end)}}},
                         {"text", Text(by).utf8()}});
      text_.replace(begin, end, by);
      if (text_.size() > 3000) {  // now and then all of it is another
        text_ = Text(u"");
        changes.push_back({{"text", ""}});
      }
    }
    editor_.tell("textDocument/didChange",
                 {{"textDocument", {{"uri", editor_.uri(name_)}, {"version", ++editor_.version}}},
                  {"contentChanges", changes}});
  }
  // A moment in which nothing is typed.
  void rest() { editor_.rest(); }
  void settle() { editor_.settle(); }

  void ask() {
    const std::string question = kQuestions[below(std::size(kQuestions))];
    const Json at = text_.place(place());
    const Json answer =
        editor_.ask("textDocument/" + question, {{"textDocument", {{"uri", editor_.uri(name_)}}},
                                                 {"position", at},
                                                 {"range", {{"start", at}, {"end", at}}},
                                                 {"newName", "other"},
                                                 {"context", {{"includeDeclaration", true}}}});
    // It may be a refusal, but no exception that nobody expects.
    REQUIRE((!answer.is_object() || answer.value("code", 0) != tool::lsp::error::internal_error));
    editor_.answers.clear();
    editor_.others.clear();
  }

  bool is_same() const {
    return editor_.server().workspace().find(editor_.uri(name_))->source.text() == text_.utf8();
  }
  std::int64_t shown() const { return editor_.shown.at(editor_.uri(name_)).at("version"); }
  std::int64_t version() const { return editor_.version; }

private:
  std::size_t below(std::size_t end) { return random_() % end; }
  std::size_t place() {
    std::size_t at = below(text_.size() + 1);
    while (text_.is_between(at))
      ++at;
    return at;
  }

  std::mt19937 random_;
  std::string name_;
  const Pieces& pieces_;
  Editor editor_;
  Text text_;
};

// Asks after so many edits.
void type_and_ask(Typist typist, std::size_t often) {
  const std::size_t edits = number_of_edits();
  for (std::size_t i = 0; i < edits; ++i) {
    typist.change();
    typist.settle();
    REQUIRE(typist.is_same());
    if (i % often == 0) typist.ask();
    if (i % 32 != 0) continue;
    typist.rest();
    REQUIRE(typist.shown() == typist.version());
  }
}

}  // namespace

TEST_CASE("after any changes the text is that of the editor, and every question has an answer") {
  type_and_ask(Typist(17, "robot.rsl", kEditedProgram, kPieces), 16);
}

TEST_CASE("after any changes of a robot.json the text is that of the editor, too") {
  const std::string robot = test::kEditorsRobot;
  type_and_ask(Typist(18, "robot.json", {robot.begin(), robot.end()}, kPiecesOfRobot), 1);
}
