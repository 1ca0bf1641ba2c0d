// An editor beside the server, in one process: texts go in and come out, and nothing waits.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "rsc/lsp/server.hpp"
#include "rsc/lsp/uris.hpp"
#include "tests/rsc/process.hpp"

namespace robosync::test {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

inline bool has(const Words& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}
inline bool has_all(const Words& words, const Words& wanted) {
  return std::ranges::all_of(wanted, [&](const std::string& word) { return has(words, word); });
}

inline constexpr const char* kEditorsRobot = R"({
  "sensors": [
    {"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}},
    {"name": "proximity", "type": "VIRTUAL", "channels": {"DISTANCE": {"unit": "cm", "range": [2, 400]}}},
    {"name": "button", "type": "VIRTUAL", "channels": {"POSITION": {"labels": ["released", "pressed"]}}}
  ],
  "actuators": [
    {"name": "left_arm", "type": "PWM", "pin": "10", "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "right_arm", "type": "PWM", "pin": "11", "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "sound", "type": "VIRTUAL", "device": "dfplayer", "sounds": ["greeting.wav", "warning.wav"]}
  ],
  "groups": {"arms": ["left_arm", "right_arm"]}
}
)";

// A text with the place in question: `|`, which is taken out.
struct Marked {
  std::string text;
  Json place;  // counted in UTF-16 by itself, not by the server's functions

  explicit Marked(std::string marked) {
    const std::size_t at = marked.find('|');
    text = marked.erase(at, 1);
    unsigned line = 0, character = 0;
    for (std::size_t i = 0; i < at; ++i) {
      const auto byte = static_cast<unsigned char>(text[i]);
      if (byte == '\n')
        ++line, character = 0;
      else if (byte >= 0xF0)
        character += 2;
      else if (byte < 0x80 || byte >= 0xC0)
        ++character;
    }
    place = {{"line", line}, {"character", character}};
  }
};

class Editor {
public:
  explicit Editor(const Json& capabilities = Json::object(), const char* robot = kEditorsRobot)
      : server_([this](const std::string& text) { hear(Json::parse(text)); }) {
    if (robot != nullptr) (void)folder.write("robot.json", robot);
    started = ask("initialize", {{"capabilities", capabilities}});
    tell("initialized", Json::object());
  }

  std::string uri(const std::string& name) const { return tool::lsp::uri_of(folder.path(name)); }

  // The result, or the error.
  Json ask(const std::string& method, const Json& params) {
    const int id = ++ids_;
    pass({{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}});
    settle();
    const Json answer = answers.at(id);
    return answer.contains("error") ? answer.at("error") : answer.at("result");
  }
  void tell(const std::string& method, const Json& params) {
    pass({{"jsonrpc", "2.0"}, {"method", method}, {"params", params}});
  }
  void pass(const Json& message) { server_.receive(message.dump()); }
  void pass_text(const std::string& message) { server_.receive(message); }
  void settle() {
    while (server_.step()) {
    }
  }
  // All that has come is answered, and the editor is quiet for a moment.
  void rest() {
    settle();
    if (server_.is_dirty()) server_.idle();
  }

  void open(const std::string& name, const std::string& text) {
    tell("textDocument/didOpen",
         {{"textDocument",
           {{"uri", uri(name)}, {"languageId", "rsl"}, {"version", ++version}, {"text", text}}}});
    rest();
  }
  void write(const std::string& name, const std::string& text) { change(name, {{{"text", text}}}); }
  void change(const std::string& name, const Json& changes) {
    tell("textDocument/didChange", {{"textDocument", {{"uri", uri(name)}, {"version", ++version}}},
                                    {"contentChanges", changes}});
    rest();
  }
  // Edits that the server has proposed.
  void apply(const std::string& name, const Json& edits) {
    Json changes = Json::array();
    for (const Json& edit : edits)
      changes.push_back({{"range", edit.at("range")}, {"text", edit.at("newText")}});
    change(name, changes);
  }
  void close(const std::string& name) {
    tell("textDocument/didClose", {{"textDocument", {{"uri", uri(name)}}}});
    rest();
  }
  // Opens or rewrites robot.rsl, and asks about the marked place.
  Json at(const std::string& method, const std::string& marked, Json more = Json::object()) {
    const Marked text(marked);
    open("robot.rsl", text.text);
    more["textDocument"] = {{"uri", uri("robot.rsl")}};
    more["position"] = text.place;
    return ask("textDocument/" + method, more);
  }
  // What completion offers.
  std::vector<std::string> offered(const std::string& marked) {
    std::vector<std::string> labels;
    const Json result = at("completion", marked);
    for (const Json& item : result.at("items"))
      labels.push_back(item.at("label"));
    return labels;
  }
  // What is said of a file now.
  Json diagnostics(const std::string& name) const {
    const auto found = shown.find(uri(name));
    return found == shown.end() ? Json() : found->second.at("diagnostics");
  }
  const tool::lsp::Server& server() const { return server_; }

  Folder folder;
  Json started;
  std::map<int, Json> answers;
  std::vector<Json> others;           // what the server says by itself, and errors without an id
  std::map<std::string, Json> shown;  // the last publishDiagnostics, by address
  std::int64_t version = 0;

private:
  void hear(const Json& message) {
    if (message.value("method", "") == "textDocument/publishDiagnostics")
      shown[message.at("params").at("uri")] = message.at("params");
    if (!message.contains("method") && message.at("id").is_number())
      answers[message.at("id").get<int>()] = message;
    else
      others.push_back(message);
  }

  int ids_ = 0;
  tool::lsp::Server server_;
};

}  // namespace robosync::test
