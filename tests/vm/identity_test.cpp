// The name of an image: SHA-256 as published, the same however the bytes come in, another one when any of them is changed, and
// the same with and without source lines.
#include "vm/identity.hpp"

#include <algorithm>
#include <cstring>
#include <random>

#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;

namespace {

Digest digest_of(std::span<const std::byte> bytes) {
  return Identity().finish(bytes);
}

ProgramHash name(std::span<const std::byte> image) {
  return name_of(digest_of(image));
}

// The same image with another count of source lines behind it; its header says so.
Bytes with_lines(const Bytes& image, std::uint16_t lines) {
  Bytes longer = image;
  longer.resize(image.size() + lines * sizeof(SourceLine), std::byte{0x5A});
  const auto total = static_cast<std::uint32_t>(longer.size());
  std::memcpy(longer.data() + offsetof(ImageHeader, total_length), &total, sizeof total);
  std::memcpy(longer.data() + offsetof(ImageHeader, source_lines), &lines, sizeof lines);
  return longer;
}

}  // namespace

// Shorter than a header, so that nothing is left out.
TEST_CASE("short texts have the digests that were published for SHA-256") {
  const std::string_view abcd = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
  CHECK(digest_of({}) == Digest{0xE3B0C442, 0x98FC1C14, 0x9AFBF4C8, 0x996FB924, 0x27AE41E4,
                                0x649B934C, 0xA495991B, 0x7852B855});
  // In one block with the length, and with the length in a block of its own. The words at 4, 8, 16 and 20, which are not
  // counted, are zero here.
  Bytes text(56);
  std::memcpy(text.data(), abcd.data(), text.size());
  for (const std::size_t at : {4U, 8U, 16U, 20U})
    std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(at), 4, std::byte{0});
  CHECK(digest_of(std::span(text).first(52))[0] == 0x96205EB0);
  CHECK(digest_of(text)[0] == 0x6C554DE9);
}

TEST_CASE("the name is the same however the bytes come in") {
  const Bytes image = companion::make().build();
  const ProgramHash whole = name(image);
  std::mt19937 random(3);
  for (unsigned round = 0; round < 200; ++round) {
    Identity identity;
    for (std::size_t have = 0; have < image.size(); have += 1 + random() % 240)
      identity.follow(std::span(image).first(have));
    REQUIRE(name_of(identity.finish(image)) == whole);
  }
}

TEST_CASE("a patched image has another name, whatever its checksum says") {
  Bytes image = companion::make().build();
  REQUIRE(is_named(image, {}));
  const ProgramHash before = stated_name(image);
  Image view;
  REQUIRE(view_image(image, view));
  const std::size_t end = image.size() - view.source_lines.size_bytes();
  for (std::size_t at = 0; at < image.size(); ++at) {
    INFO("byte " << at);
    Bytes patched = image;
    patched[at] ^= std::byte{1};
    const bool counts = (at < 4 || at >= 12) && (at < 16 || at >= 24) && at < end;
    // The length and the count of lines move where that ends which counts.
    const bool moves_end = (at >= 8 && at < 12) || at == 64 || at == 65;
    if (!moves_end) CHECK((name(patched) != before) == counts);
    if (counts) CHECK_FALSE(is_named(patched, {}));
    seal(patched);
    CHECK(is_named(patched, {}));
    if (counts && !moves_end) CHECK(stated_name(patched) != before);
  }
}

TEST_CASE("with source lines and without it is the same program") {
  const Bytes image = companion::make().build();
  for (const std::uint16_t lines : std::initializer_list<std::uint16_t>{0, 1, 7, 100})
    CHECK(name(with_lines(image, lines)) == name(with_lines(image, 0)));
}

TEST_CASE("whatever the header says, nothing is read that has not come") {
  std::mt19937 random(5);
  const Bytes image = companion::make().build();
  for (unsigned round = 0; round < 3000; ++round) {
    Bytes any(image.begin(), image.begin() + static_cast<std::ptrdiff_t>(random() % image.size()));
    for (std::size_t at = 0; at < std::min<std::size_t>(any.size(), 68); ++at)
      if (random() % 4 == 0) any[at] = static_cast<std::byte>(random());
    Identity identity;
    identity.follow(std::span(any).first(any.size() / 2));
    (void)identity.finish(any);  // the sanitizers look
  }
  CHECK_FALSE(is_named({}, {}));
}
