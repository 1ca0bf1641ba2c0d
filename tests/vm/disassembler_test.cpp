// The disassembler's text, and that no word and no buffer brings it out of bounds.
#include "vm/disassembler.hpp"

#include <array>

#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/golden.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
using Op = Opcode;

namespace {

std::string text_of(const Image& image, Word word) {
  std::array<char, 128> buffer{};
  const std::size_t length = disassemble(image, word, buffer);
  REQUIRE(buffer[length] == 0);
  return {buffer.data(), length};
}

std::string listing(const Image& image) {
  std::string text;
  for (std::size_t i = 0; i < image.code.size(); ++i)
    text += std::to_string(i) + "\t" + text_of(image, image.code[i]) + "\n";
  return text;
}

}  // namespace

TEST_CASE("the disassembly of a program") {
  const Bytes bytes = companion::make().build();
  Image image;
  REQUIRE(view_image(bytes, image));
  const std::string actual = listing(image);
  CHECK(actual == golden("tests/vm/golden/companion.txt", actual));
}

TEST_CASE("the disassembly of every opcode") {
  ImageBuilder builder = companion::make();
  builder.constants = {2500, -1, kUnknown, 1000 * kScale, 50};
  builder.code.clear();
  for (std::size_t op = 0; op < kOpcodes.size(); ++op)
    builder.code.push_back(encode(static_cast<Op>(op), 1, 0, 3));
  for (unsigned constant = 0; constant < builder.constants.size(); ++constant)
    builder.code.push_back(encode_wide(Op::load, 7, constant));
  for (unsigned param = 0; param < 8; ++param)
    builder.code.push_back(encode(Op::arg, param, 255));
  builder.code.push_back(encode(Op::cmd, companion::arms, companion::move_verb, kNoWord));
  const Bytes bytes = builder.build();
  Image image;
  REQUIRE(view_image(bytes, image));
  const std::string actual = listing(image);
  CHECK(actual == golden("tests/vm/golden/opcodes.txt", actual));
}

TEST_CASE("what refers to nothing is shown by number") {
  const Image empty;
  CHECK(text_of(empty, 0x12345CFF) == "?        0x12345cff");
  CHECK(text_of(empty, encode(Op::lt_k, 1, 2, 200)) == "lt_k     r1, r2, constant?200");
  CHECK(text_of(empty, encode_wide(Op::load, 1, 65535)) == "load     r1, constant?65535");
  CHECK(text_of(empty, encode(Op::cmd, 3, 4, 5)) == "cmd      actuator?3 verb?4 word?5");
  CHECK(text_of(empty, encode(Op::cmd_end, kGroupBit | 3, 4, kNoWord)) ==
        "cmd_end  group?3 verb?4");
  CHECK(text_of(empty, encode(Op::arg, 9, 1)) == "arg      param?9, r1");
  CHECK(text_of(empty, encode_wide(Op::alert, 0, 77)) == "alert    string?77");
}

TEST_CASE("operands that stand behind an empty one are the first in the text") {
  const Image empty;
  CHECK(text_of(empty, encode_wide(Op::jump, 0, 300)) == "jump     +300");
  CHECK(text_of(empty, encode_wide(Op::around_always, 0, 7)) == "around_always -7");
  CHECK(text_of(empty, encode_wide(Op::unless_known, 7, 4)) == "unless_known r7, +4");
  CHECK(text_of(empty, encode(Op::halt, kAllActuators)) == "halt     ALL");
  CHECK(text_of(empty, encode(Op::held, 1, 2, 3)) == "held     r1, r2, t3");
  CHECK(text_of(empty, encode(Op::loop)) == "loop");
}

TEST_CASE("control characters in names do not reach the terminal") {
  ImageBuilder builder;
  builder.verbs.push_back({builder.name("\x1b[2J\x7f\n"), Action::move, 0});
  builder.actuators.resize(1);
  builder.actuators[0].name = builder.name("arm");
  const Bytes bytes = builder.build();
  Image image;
  REQUIRE(view_image(bytes, image));
  CHECK(text_of(image, encode(Op::cmd, 0, 0, kNoWord)) == "cmd      arm ?[2J??");
}

TEST_CASE("a small buffer cuts the text, and is always terminated") {
  const Image empty;
  const std::string whole = text_of(empty, encode(Op::lt_k, 1, 2, 200));
  for (std::size_t size = 1; size <= whole.size() + 1; ++size) {
    std::string buffer(size + 1, '#');
    const std::size_t length =
        disassemble(empty, encode(Op::lt_k, 1, 2, 200), std::span(buffer.data(), size));
    CHECK(length == size - 1);
    CHECK(buffer.substr(0, length) == whole.substr(0, length));
    CHECK(buffer[length] == 0);
    CHECK(buffer[size] == '#');
  }
  CHECK(disassemble(empty, 0, {}) == 0);
}
