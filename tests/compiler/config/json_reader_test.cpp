// Every value of a JSON text is found where it stands.
#include "compiler/config/json_reader.hpp"

#include <functional>

#include <catch2/catch.hpp>

#include "tests/compiler/compiled.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

struct Read {
  SourceMap sources;
  Diagnostics diagnostics;
  std::optional<json::Value> tree;
};

Read read(const std::string& text) {
  Read result;
  result.tree = json::read(result.sources, result.sources.add("x.json", text), result.diagnostics);
  return result;
}

// Scalars as their spans show them, in the order of the text.
std::string spans(const Read& read) {
  std::string list;
  const std::function<void(const json::Value&)> walk = [&](const json::Value& value) {
    if (value.items.empty() && value.members.empty())
      list += std::string(read.sources.text(value.span)) + "|";
    for (const json::Value& item : value.items)
      walk(item);
    for (const json::Member& member : value.members) {
      list += std::string(read.sources.text(member.key_span)) + "|";
      walk(member.value);
    }
  };
  walk(*read.tree);
  return list;
}

}  // namespace

TEST_CASE("spans are the tokens") {
  const Read result = read(
      "\xEF\xBB\xBF { \"a\" :-1.5e3,\n\t\"b\\\"c\": [true,false , null,\"x\\\\\"], \"\xC3\xA4\":{} "
      "}");
  REQUIRE(result.tree);
  CHECK(spans(result) == "\"a\"|-1.5e3|\"b\\\"c\"|true|false|null|\"x\\\\\"|\"\xC3\xA4\"|{}|");
  CHECK(result.tree->members[1].key == "b\"c");
  CHECK(result.sources.text(result.tree->members[1].value.span) == "[true,false , null,\"x\\\\\"]");
  CHECK(result.tree->members[0].value.text == "-1.5e3");
}

TEST_CASE("a text of one value") {
  CHECK(spans(read("7")) == "7|");
  CHECK(spans(read("\"\"")) == "\"\"|");
  CHECK(spans(read(" [ ] ")) == "[ ]|");
}

TEST_CASE("depth is bounded") {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  CHECK(read(nested(json::kMaxDepth)).tree);
  CHECK(!read(nested(json::kMaxDepth + 1)).tree);
  CHECK(!read(nested(1000000)).tree);
  CHECK(!read(std::string(1000000, '[')).tree);
}

TEST_CASE("a wrong text gives exactly one message, at the mistake") {
  const auto place = [](const std::string& text) {
    const Read result = read(text);
    REQUIRE(!result.tree);
    REQUIRE(result.diagnostics.all().size() == 1);
    const Span span = result.diagnostics.all()[0].labels.back().span;
    return std::pair(span.begin, std::string(result.sources.text(span)));
  };
  CHECK(place("[1,]") == std::pair(2U, std::string(",")));
  CHECK(place("[1 2]") == std::pair(3U, std::string("2")));
  CHECK(place("{\"a\" \"b\"}") == std::pair(5U, std::string("\"b\"")));
  CHECK(place("[nul]") == std::pair(1U, std::string("nul")));
  CHECK(place("[1e999]") == std::pair(1U, std::string("1e999")));
  CHECK(place("[\"a\xFF\"]").first == 3U);
  CHECK(place("").first == 0U);
}
