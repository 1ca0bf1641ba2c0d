// Places in UTF-16 and UTF-8, and addresses of files.
#include "rsc/lsp/positions.hpp"

#include <catch2/catch.hpp>

#include "rsc/lsp/uris.hpp"

using namespace robosync;
using namespace robosync::tool::lsp;

namespace {

// ä takes two bytes and one unit of UTF-16, 🤖 four and two.
const compiler::SourceFile& source() {
  static const compiler::SourceFile file("", "% ä🤖b\r\n🤖🤖\rx\n\nend");
  return file;
}

std::uint32_t offset(std::uint32_t line, std::uint32_t character,
                     Encoding encoding = Encoding::utf16) {
  return offset_of(source(), {line, character}, encoding);
}

}  // namespace

TEST_CASE("a position counts units of UTF-16") {
  CHECK(offset(0, 3) == 4);   // behind ä
  CHECK(offset(0, 5) == 8);   // behind the robot
  CHECK(offset(0, 6) == 9);   // behind b
  CHECK(offset(1, 2) == 15);  // between two robots
  CHECK(offset(2, 1) == 21);
  CHECK(offset(3, 0) == 22);
  CHECK(offset(4, 3) == 26);
}

TEST_CASE("a position that is nowhere is the next place in front of it") {
  CHECK(offset(0, 4) == 4);   // inside of the robot
  CHECK(offset(1, 3) == 15);  // likewise
  CHECK(offset(0, 7) == 9);   // behind the end of the line
  CHECK(offset(0, 4'000'000'000) == 9);
  CHECK(offset(5, 0) == 26);  // behind the last line
  CHECK(offset(4'000'000'000, 4'000'000'000) == 26);
  CHECK(offset(0, 3, Encoding::utf8) == 2);  // inside of ä
}

TEST_CASE("places and offsets are each other's inverse") {
  for (const Encoding encoding : {Encoding::utf8, Encoding::utf16})
    for (std::uint32_t at = 0; at <= source().text().size(); ++at) {
      const bool inside = at < source().text().size() &&
                          (static_cast<unsigned char>(source().text()[at]) & 0xC0U) == 0x80U;
      if (inside || source().text().substr(at, 1) == "\n") continue;  // between CR and LF
      CHECK(offset_of(source(), place_of(source(), at, encoding), encoding) == at);
    }
  CHECK(place_of(source(), 8, Encoding::utf16).character == 5);
  CHECK(place_of(source(), 8, Encoding::utf8).character == 8);
}

TEST_CASE("addresses of files, and paths") {
  CHECK(path_of("file:///a/b%20c/%C3%A4.rsl") == "/a/b c/ä.rsl");
  CHECK(path_of("file://localhost/a/../b.rsl") == "/b.rsl");
  CHECK(path_of("file:///a%zz%2") == "/a%zz%2");
  CHECK(path_of("file:///a%00b") == "/a%00b");
  CHECK(!path_of("untitled:Untitled-1"));
  CHECK(!path_of("file://"));
  CHECK(!path_of(""));
  CHECK(uri_of("/a/b c/ä.rsl") == "file:///a/b%20c/%C3%A4.rsl");
}
