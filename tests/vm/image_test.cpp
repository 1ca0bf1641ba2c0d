// The image's view, its strings and masks, and the checksum.
#include "vm/image.hpp"

#include <array>

#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;

namespace {
std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}
}  // namespace

TEST_CASE("crc32 gives the published check values") {
  CHECK(crc32(bytes_of("")) == 0);
  CHECK(crc32(bytes_of("123456789")) == 0xCBF43926);
  CHECK(crc32(bytes_of("The quick brown fox jumps over the lazy dog")) == 0x414FA339);
  CHECK(crc32(std::vector<std::byte>(32, std::byte{0xFF})) == 0xFF6CAB0B);
}

TEST_CASE("crc32 can be continued at any byte") {
  const auto text = bytes_of("123456789");
  for (std::size_t cut = 0; cut <= text.size(); ++cut)
    CHECK(crc32(text.subspan(cut), crc32(text.first(cut))) == 0xCBF43926);
}

TEST_CASE("a view shows the records that were written") {
  const ImageBuilder written = companion::make();
  const Bytes bytes = written.build();
  Image image;
  REQUIRE(view_image(bytes, image));
  CHECK(image.header->magic == kMagic);
  CHECK(image.sensors.size() == 2);
  CHECK(image.channels.size() == 3);
  CHECK(image.actuators.size() == 3);
  CHECK(image.groups.size() == 1);
  CHECK(image.verbs.size() == 2);
  CHECK(image.words.size() == 4);
  CHECK(image.variables.size() == 5);
  CHECK(image.checks.size() == 1);
  CHECK(image.bands.size() == 2);
  CHECK(image.behaviors.size() == 3);
  CHECK(image.modifiers.size() == 1);
  CHECK(image.timers.size() == 6);
  CHECK(image.rules.size() == 8);
  CHECK(image.responses.size() == 7);
  CHECK(image.string(image.labels[3]) == "wary");
  CHECK(image.timers[companion::first_then].state == 5);
  CHECK(image.bands[1].stay_low == 700 * kScale);
  CHECK(image.string(image.actuators[companion::speaker].name) == "speaker");
  CHECK(std::vector(image.inputs.begin(), image.inputs.end()) == written.inputs);
  CHECK(std::vector(image.constants.begin(), image.constants.end()) == written.constants);
  CHECK(std::vector(image.code.begin(), image.code.end()) == written.code);
  CHECK(std::string(image.strings.begin(), image.strings.end()) == written.strings);
  CHECK(image.source_lines[2].line == 10);
}

TEST_CASE("a view is refused unless the sections fill the bytes") {
  const Bytes good = companion::make().build();
  Image image;
  for (std::size_t size = 0; size < good.size(); ++size)
    CHECK_FALSE(view_image(std::span(good).first(size), image));

  Bytes longer = good;
  longer.resize(good.size() + 4);
  CHECK_FALSE(view_image(longer, image));
  const auto length = static_cast<std::uint32_t>(longer.size());
  std::memcpy(longer.data() + offsetof(ImageHeader, total_length), &length, sizeof length);
  CHECK_FALSE(view_image(longer, image));  // four bytes that no section claims
}

TEST_CASE("a view needs aligned bytes") {
  const Bytes good = companion::make().build();
  Bytes shifted(good.size() + 1);
  std::copy(good.begin(), good.end(), shifted.begin() + 1);
  Image image;
  CHECK_FALSE(view_image(std::span(shifted).subspan(1), image));
  CHECK(image.header == nullptr);
}

TEST_CASE("string() never leaves the pool") {
  const std::array<char, 6> pool{'a', 'b', 0, 'c', 'd', 'e'};  // the last one without its NUL
  Image image;
  image.strings = pool;
  CHECK(image.string(0) == "ab");
  CHECK(image.string(1) == "b");
  CHECK(image.string(2).empty());
  CHECK(image.string(3) == "cde");
  CHECK(image.string(6).empty());
  CHECK(image.string(kNoIndex).empty());
}

TEST_CASE("target_mask() knows actuators and groups, and nothing else") {
  const Bytes bytes = companion::make().build();
  Image image;
  REQUIRE(view_image(bytes, image));
  CHECK(image.target_mask(companion::left_arm) == 0b001);
  CHECK(image.target_mask(companion::speaker) == 0b100);
  CHECK(image.target_mask(companion::arms) == 0b011);
  for (unsigned target = 3; target < 256; ++target)
    if (target != companion::arms) CHECK(image.target_mask(static_cast<std::uint8_t>(target)) == 0);
}

TEST_CASE("there are SAFETY rules if the first behaviour has their priority") {
  CHECK_FALSE(Image{}.has_safety());
  ImageBuilder builder = companion::make();
  for (const bool expected : {true, false}) {
    const Bytes bytes = builder.build();
    Image image;
    REQUIRE(view_image(bytes, image));
    CHECK(image.has_safety() == expected);
    builder.behaviors.erase(builder.behaviors.begin() + kSafetyBehavior);
  }
}
