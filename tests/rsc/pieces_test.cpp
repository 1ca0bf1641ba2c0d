// What of an image travels: whatever the two images are, a board makes the new one of it, and what it has does not travel.
#include "rsc/device/pieces.hpp"

#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "link/receiver.hpp"
#include "tests/rsc/image.hpp"

using namespace robosync;

namespace {

using Bytes = std::vector<std::byte>;

// What the board makes of it, in frames of at most `most` bytes; `travelled`: bytes of all of them.
Bytes received(const Bytes& base, const Bytes& image, std::size_t most, std::size_t& travelled) {
  const tool::Pieces pieces(base, image);
  Bytes buffer(image.size());
  link::Receiver receiver;
  receiver.begin({1, static_cast<std::uint32_t>(image.size()), {1}, {2}}, buffer, base);
  travelled = 0;
  std::size_t at = 0;
  while (at < image.size()) {
    Bytes payload;
    const std::size_t end = pieces.fill(at, most, payload);
    REQUIRE(payload.size() <= most);
    REQUIRE(end > at);
    REQUIRE(receiver.pieces(static_cast<std::uint32_t>(at), payload).next_offset == end);
    travelled += payload.size();
    at = end;
  }
  return buffer;
}

Bytes bytes_of(const tool::Program& program) {
  const auto bytes = tool::without_source_lines(program);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

TEST_CASE("what a board makes of the pieces is the image, whatever the two are") {
  std::mt19937 random(1);
  std::size_t travelled = 0;
  for (unsigned round = 0; round < 600; ++round) {
    Bytes base(random() % 3000), image;
    for (std::byte& byte : base)
      byte = static_cast<std::byte>(random() % (2 + round % 250));
    for (auto parts = random() % 12; parts > 0; --parts) {
      if (!base.empty() && random() % 2 == 0) {
        const std::size_t from = random() % base.size();
        const auto some = std::span(base).subspan(from, random() % (base.size() - from + 1));
        image.insert(image.end(), some.begin(), some.end());
      } else {
        image.insert(image.end(), random() % 300, static_cast<std::byte>(random()));
      }
    }
    REQUIRE(received(base, image, 20 + random() % 220, travelled) == image);
  }
}

TEST_CASE("images of 64 KB, of which what stands too far away cannot be said") {
  std::mt19937 random(2);
  std::size_t travelled = 0;
  Bytes base(60'000);
  std::generate(base.begin(), base.end(), [&] { return static_cast<std::byte>(random()); });
  Bytes image(base.rbegin(), base.rend());
  image.insert(image.end(), base.begin() + 1000, base.begin() + 6000);
  image.insert(image.end(), 500, std::byte{7});
  CHECK(received(base, image, 240, travelled) == image);
  CHECK(travelled < 64'000);
}

TEST_CASE(
    "of a changed threshold a few dozen bytes travel, and less than all of what repeats itself") {
  std::string changed(test::kProgram);
  changed.replace(changed.find("< 3"), 3, "< 5");
  std::size_t travelled = 0;
  const Bytes before = bytes_of(test::compile()), after = bytes_of(test::compile(changed));
  CHECK(received(before, after, 236, travelled) == after);
  CHECK(travelled < 70);
  CHECK(received({}, after, 236, travelled) == after);
  CHECK(travelled < after.size());
}
