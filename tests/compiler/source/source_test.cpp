// Places in a source, and its characters.
#include <string>

#include <catch2/catch.hpp>

#include "compiler/source/source_file.hpp"
#include "compiler/source/utf8.hpp"

using namespace robosync::compiler;

TEST_CASE("lines and columns", "[source]") {
  const SourceFile file("f", "ab\nçd\r\ne\rf");
  const auto at = [&file](std::uint32_t offset) {
    const Position position = file.position(offset);
    return std::to_string(position.line) + ":" + std::to_string(position.column);
  };
  CHECK(at(0) == "1:1");
  CHECK(at(2) == "1:3");
  CHECK(at(3) == "2:1");
  CHECK(at(5) == "2:2");  // ç takes two bytes and one column
  CHECK(at(8) == "3:1");
  CHECK(at(10) == "4:1");
  CHECK(at(11) == "4:2");
  CHECK(at(4000000000U) == "4:2");
  CHECK(file.line(2) == "çd");
  CHECK(file.line(3) == "e");
  CHECK(file.line(4) == "f");
  CHECK(file.line(0).empty());
  CHECK(file.line(5).empty());
  CHECK(file.text({0, 0, 2}) == "ab");
  CHECK(file.text({0, 9, 4000000000U}) == "\rf");
  CHECK(file.text({0, 5, 2}).empty());
}

TEST_CASE("columns of long lines", "[source]") {
  std::string text;
  const std::string parts[] = {"a", "bc ", "é", "触", "🤖", "\xff", "\t"};
  for (std::size_t i = 0; i < 9000; ++i)
    text += i % 4000 == 3999 ? "\n" : parts[i * i % 7];
  const SourceFile file("f", text);
  std::uint32_t line = 1, column = 1;
  for (std::size_t at = 0; at < text.size(); ++column) {
    const Position position = file.position(static_cast<std::uint32_t>(at));
    REQUIRE(position.line == line);
    REQUIRE(position.column == column);
    if (text[at] == '\n') {
      ++line;
      column = 0;
    }
    at += utf8::decode(text, at).size;
  }
}

TEST_CASE("UTF-8 is checked", "[source]") {
  const auto value = [](std::string_view text) { return utf8::decode(text, 0).value; };
  CHECK(value("A") == U'A');
  CHECK(value("é") == U'é');
  CHECK(value("触") == U'触');
  CHECK(value("🤖") == U'🤖');
  for (const std::string_view bad : {"\x80", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80",
                                     "\xF4\x90\x80\x80", "\xE2\x82", "\xFF"}) {
    CHECK(utf8::decode(bad, 0).value == utf8::replacement);
    CHECK(utf8::decode(bad, 0).size == 1);
  }
  CHECK(utf8::printable("a\x1b[2Jé\xff") == "a�[2Jé�");
}
