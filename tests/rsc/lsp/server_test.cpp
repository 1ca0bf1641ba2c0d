// From `initialize` to `exit`, and messages that are not as they should be.
#include <random>

#include <catch2/catch.hpp>

#include "tests/rsc/lsp/editor.hpp"

using namespace robosync;
using test::Editor, test::Json;
namespace error = tool::lsp::error;

namespace {

struct Bare {
  std::vector<Json> heard;
  tool::lsp::Server server{[this](const std::string& text) { heard.push_back(Json::parse(text)); }};

  Json say(const std::string& text) {
    server.receive(text);
    while (server.step()) {
    }
    return heard.empty() ? Json() : heard.back();
  }
  int code(const std::string& text) { return say(text).at("error").at("code").get<int>(); }
};

constexpr const char* kInitialize = R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{}})";

}  // namespace

TEST_CASE("the editor is told what the server can do") {
  Editor editor;
  const Json& can = editor.started.at("capabilities");
  CHECK(can.at("positionEncoding") == "utf-16");
  CHECK(can.at("textDocumentSync").at("change") == 2);
  CHECK(can.at("completionProvider").at("triggerCharacters") == Json({" ", "\""}));
  CHECK(editor.started.at("serverInfo").at("name") == "rsc");
  const Json utf8 = {{"general", {{"positionEncodings", {"utf-16", "utf-8"}}}}};
  CHECK(Editor(utf8).started.at("capabilities").at("positionEncoding") == "utf-8");
}

TEST_CASE("the order of a session is kept, and its end has the code of the protocol") {
  Bare bare;
  CHECK(bare.code(R"({"id":1,"method":"textDocument/hover","params":{}})") ==
        error::not_initialized);
  CHECK(bare.say(kInitialize).contains("result"));
  CHECK(bare.code(kInitialize) == error::invalid_request);
  CHECK(bare.say(R"({"id":2,"method":"shutdown"})").at("result").is_null());
  CHECK(bare.code(R"({"id":3,"method":"textDocument/hover","params":{}})") ==
        error::invalid_request);
  (void)bare.say(R"({"method":"exit"})");
  CHECK(bare.server.exit_code() == 0);
}

TEST_CASE("an exit without a shutdown is none in order") {
  Bare bare;
  (void)bare.say(kInitialize);
  CHECK(bare.server.exit_code_at_end() == 1);
  (void)bare.say(R"({"method":"exit"})");
  CHECK(bare.server.exit_code() == 1);
}

TEST_CASE("what is no message is answered with an error, and the next one is read") {
  Bare bare;
  CHECK(bare.code("{") == error::parse_error);
  CHECK(bare.code("{\"id\":1,\"method\":\"\\ud800\"}") == error::parse_error);
  CHECK(bare.code("[]") == error::invalid_request);
  CHECK(bare.code("7") == error::invalid_request);
  CHECK(bare.code("{}") == error::invalid_request);
  CHECK(bare.code(R"({"id":{},"method":"shutdown"})") == error::invalid_request);
  CHECK(bare.code(std::string(100'000, '[')) == error::parse_error);
  CHECK(bare.say(R"({"id":1,"method":"initialize","params":)" + std::string(100'000, '[') +
                 std::string(100'000, ']') + "}")
            .contains("result"));
  CHECK(bare.code(kInitialize) == error::invalid_request);
  CHECK(bare.code(R"({"id":4,"method":"textDocument/none"})") == error::method_not_found);
  CHECK(bare.code(R"({"id":"five","method":"textDocument/hover"})") == error::invalid_params);
  CHECK(bare.heard.back().at("id") == "five");
  CHECK(bare.heard.back().at("error").at("message") ==
        "the parameters of `textDocument/hover` lack something, or something in them is of a wrong "
        "kind");
  CHECK(
      bare.code(R"({"id":6,"method":"textDocument/hover","params":{"textDocument":{"uri":7}}})") ==
      error::invalid_params);
}

TEST_CASE("answers of the editor, and notes that nobody knows, are taken without a word") {
  Bare bare;
  (void)bare.say(kInitialize);
  const std::size_t before = bare.heard.size();
  (void)bare.say(R"({"id":"watch files","result":null})");
  (void)bare.say(R"({"id":9,"error":{"code":1,"message":""}})");
  (void)bare.say(R"({"method":"$/setTrace","params":{"value":"off"}})");
  (void)bare.say(R"({"method":"$/cancelRequest","params":{"id":12}})");
  (void)bare.say(R"({"method":"$/cancelRequest"})");
  CHECK(bare.heard.size() == before);
}

TEST_CASE("a request that waits can be taken back; it has one answer") {
  Editor editor;
  editor.open("robot.rsl", "LET x = 1\n");
  const Json params = {{"textDocument", {{"uri", editor.uri("robot.rsl")}}}};
  editor.pass({{"id", 101}, {"method", "textDocument/documentSymbol"}, {"params", params}});
  editor.pass({{"id", 102}, {"method", "textDocument/documentSymbol"}, {"params", params}});
  editor.tell("$/cancelRequest", {{"id", 101}});
  editor.rest();
  CHECK(editor.answers.at(101).at("error").at("code") == error::request_cancelled);
  CHECK(editor.answers.at(102).contains("result"));
  editor.answers.clear();
  editor.tell("$/cancelRequest", {{"id", 102}});
  editor.rest();
  CHECK(editor.answers.empty());
}

TEST_CASE("changes that are not as they should be change nothing") {
  Editor editor;
  editor.open("robot.rsl", "LET x = 1\n");
  const std::vector<Json> wrong = {
      7,
      Json::object(),
      Json::array({1}),
      {{{"text", 5}}},
      {{{"text", ""}, {"range", {{"start", 1}, {"end", 2}}}}},
      {{{"text", ""}, {"range", {{"start", {{"line", -1}, {"character", "x"}}}, {"end", 2}}}}}};
  for (const Json& changes : wrong)
    editor.change("robot.rsl", changes);
  editor.change("other.rsl", {{{"text", "x"}}});
  editor.close("other.rsl");
  CHECK(editor.server().workspace().find(editor.uri("robot.rsl"))->source.text() == "LET x = 1\n");
}

TEST_CASE("a range that runs backwards inserts where it begins") {
  Editor editor;
  editor.open("robot.rsl", "abc\n");
  editor.change(
      "robot.rsl",
      {{{"text", "X"},
        {"range",
         {{"start", {{"line", 0}, {"character", 2}}}, {"end", {{"line", 0}, {"character", 1}}}}}}});
  CHECK(editor.server().workspace().find(editor.uri("robot.rsl"))->source.text() == "abXc\n");
}
