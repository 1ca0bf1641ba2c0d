// rsc fmt's style of robot.json: what it makes of each kind of line, that it does not depend on how the text was spaced before,
// and that nothing but white space changes.
#include "compiler/config/json_format.hpp"

#include <filesystem>
#include <random>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "compiler/compiler.hpp"
#include "tests/compiler/compiled.hpp"
#include "tests/compiler/syntax/examples.hpp"
#include "tests/compiler/syntax/mutations.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/share.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

namespace fs = std::filesystem;

// Empty if the text is not JSON.
std::string styled(const std::string& text) {
  SourceMap sources;
  Diagnostics diagnostics;
  const FileId file = sources.add("robot.json", text);
  const auto root = json::read(sources, file, diagnostics);
  return root ? json::formatted(sources, file, *root) : "";
}

std::vector<fs::path> descriptions() {
  std::vector<fs::path> found = files_in({"examples"}, ".json");
  found.push_back(source_folder() / "docs/robot.json");
  return found;
}

// Other white space between the same words.
std::string respaced(const std::string& text, std::mt19937& random) {
  std::string made;
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"' && text[at - 1] != '\\') quoted = !quoted;
    if (!quoted && (c == ' ' || c == '\n')) continue;
    made += c;
    if (!quoted && std::string_view("{}[],:").find(c) != std::string_view::npos &&
        random() % 2 == 0)
      made += random() % 4 == 0 ? "\n" : random() % 2 == 0 ? " " : "\t";
  }
  return made;
}

std::string without_blank_lines(std::string text) {
  for (std::size_t at = text.find("\n\n"); at != std::string::npos; at = text.find("\n\n"))
    text.erase(at, 1);
  return text;
}

}  // namespace

TEST_CASE("each part of a robot.json has its place") {
  CHECK(styled(R"({"sensors":[{"name":"touch","pin":3},{"name":"distance","pin":10}],
"groups" : {"arms":["a","b"]}, "actuators":[ ]


,"board":"microbit-v2"})") ==
        "{\n"
        "  \"sensors\": [\n"
        "    {\"name\": \"touch\",    \"pin\": 3},\n"
        "    {\"name\": \"distance\", \"pin\": 10}\n"
        "  ],\n"
        "  \"groups\": {\"arms\": [\"a\", \"b\"]},\n"
        "  \"actuators\": [],\n"
        "\n"
        "  \"board\": \"microbit-v2\"\n"
        "}\n");
  CHECK(styled("{\"a\":1,\n\n\"b\":2,\n\"c\":3}") ==
        "{\n  \"a\": 1,\n\n  \"b\": 2,\n  \"c\": 3\n}\n");
  CHECK(styled("{}") == "{}\n");
  CHECK(styled("[1,2 , {}]") == "[1, 2, {}]\n");
  CHECK(styled("7") == "7\n");
  CHECK(styled("\xEF\xBB\xBF{\"a\":1}") == "{\n  \"a\": 1\n}\n");
  CHECK(styled("{\"a\":1.50,\"b\":\"\\u00e4\"}") == "{\n  \"a\": 1.50,\n  \"b\": \"\\u00e4\"\n}\n");
}

TEST_CASE("what is too long for its line continues behind its bracket") {
  const std::string word = '"' + std::string(40, 'x') + '"';
  const std::string text = styled("{\"sensors\":[{\"name\":" + word + ",\"labels\":[" + word + "," +
                                  word + "," + word + "]}]}");
  CHECK(text == "{\n  \"sensors\": [\n    {\"name\": " + word + ",\n     \"labels\": [" + word +
                    ", " + word + ",\n                " + word + "]}\n  ]\n}\n");
  CHECK(styled(text) == text);
}

TEST_CASE("the examples and the robot of the pages are in the one style of JSON") {
  CHECK(descriptions().size() >= 40);
  for (const fs::path& path : descriptions()) {
    INFO(path);
    CHECK(styled(read_file(path)) == read_file(path));
  }
}

TEST_CASE("however a robot.json is spaced, it is formatted to the same, with the same content") {
  std::mt19937 random(20261128);
  for (const fs::path& path : descriptions())
    for (int round = 0; round < robosync::test::share_of(20); ++round) {
      const std::string text = read_file(path), other = respaced(text, random);
      INFO(path << "\n" << other);
      CHECK(nlohmann::ordered_json::parse(other) == nlohmann::ordered_json::parse(text));
      // Line ends that were put there may look like a blank line.
      CHECK(without_blank_lines(styled(other)) == without_blank_lines(text));
    }
}

TEST_CASE("formatting a robot.json changes neither the image nor a formatted text") {
  std::mt19937 random(20261129);
  std::size_t read = 0;
  for (const Example& example : examples())
    for (const Mutation mutation : every_mutation)
      for (int round = 0; round < robosync::test::share_of(10); ++round) {
        const std::string changed = mutate_json(example.robot, mutation, random);
        const std::string text = styled(changed);
        if (text.empty()) continue;
        ++read;
        INFO(example.name << "\n" << changed);
        CHECK(styled(text) == text);
        CHECK(compiled(example.program, text).image == compiled(example.program, changed).image);
      }
  CHECK(read >= robosync::test::share_of(200U));
}
