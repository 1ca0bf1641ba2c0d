// A damaged line: every byte of a stream lost, flipped, doubled or joined by another one, at every
// place, costs at most the frames it touches; noise makes no frames.
#include <random>

#include <catch2/catch.hpp>

#include "link/frame.hpp"
#include "tests/link/line.hpp"

using namespace robosync;
using test::Bytes;
using test::OwnedFrame;

namespace {

struct Stream {
  std::vector<OwnedFrame> frames;
  Bytes bytes;
  std::vector<std::size_t> frame_of;  // which frame a byte belongs to
};

// Frames of every shape: empty, all zeros, no zeros, the longest, ordinary ones.
Stream sample() {
  Stream stream;
  std::mt19937 random(1);
  const auto add = [&](Bytes payload) {
    const OwnedFrame frame{link::MessageType::data, static_cast<std::uint8_t>(stream.frames.size()),
                           std::move(payload)};
    const Bytes wire = test::encode(frame);
    stream.bytes.insert(stream.bytes.end(), wire.begin(), wire.end());
    stream.frame_of.insert(stream.frame_of.end(), wire.size(), stream.frames.size());
    stream.frames.push_back(frame);
  };
  add({});
  add(Bytes(12));
  add(Bytes(30, std::byte{0xFF}));
  Bytes longest(link::kMaxPayload);
  for (std::byte& byte : longest)
    byte = static_cast<std::byte>(random());
  add(longest);
  for (const std::size_t length : {1u, 2u, 17u}) {
    Bytes payload(length);
    for (std::byte& byte : payload)
      byte = static_cast<std::byte>(random() % 3);
    add(payload);
  }
  return stream;
}

// The frames that arrived are the sent ones without some of `first`…`last`; nothing else.
void check_cost(const Stream& stream, const Bytes& damaged, std::size_t first, std::size_t last) {
  const std::vector<OwnedFrame> got = test::decode(damaged);
  std::size_t next = 0;
  for (const OwnedFrame& frame : got) {
    while (next < stream.frames.size() && !(stream.frames[next] == frame)) {
      INFO("frame " << next << " is missing; the damage touched " << first << " to " << last);
      REQUIRE((first <= next && next <= last));
      ++next;
    }
    REQUIRE(next < stream.frames.size());  // else a frame nobody sent, or one that came twice
    ++next;
  }
  while (next < stream.frames.size()) {
    REQUIRE((first <= next && next <= last));
    ++next;
  }
}

// A damaged delimiter joins two frames.
std::size_t last_touched(const Stream& stream, std::size_t at) {
  const std::size_t frame = stream.frame_of[at];
  return stream.bytes[at] == std::byte{0} ? frame + 1 : frame;
}

}  // namespace

TEST_CASE("a lost byte costs the frames it belongs to") {
  const Stream stream = sample();
  for (std::size_t at = 0; at < stream.bytes.size(); ++at) {
    Bytes damaged = stream.bytes;
    damaged.erase(damaged.begin() + static_cast<std::ptrdiff_t>(at));
    check_cost(stream, damaged, stream.frame_of[at], last_touched(stream, at));
  }
}

TEST_CASE("flipped bits cost the frames their byte belongs to") {
  const Stream stream = sample();
  for (std::size_t at = 0; at < stream.bytes.size(); ++at) {
    for (unsigned flip = 1; flip < 256; ++flip) {
      Bytes damaged = stream.bytes;
      damaged[at] ^= static_cast<std::byte>(flip);
      check_cost(stream, damaged, stream.frame_of[at], last_touched(stream, at));
    }
  }
}

TEST_CASE("a doubled byte costs the frame it belongs to") {
  const Stream stream = sample();
  for (std::size_t at = 0; at < stream.bytes.size(); ++at) {
    Bytes damaged = stream.bytes;
    damaged.insert(damaged.begin() + static_cast<std::ptrdiff_t>(at), stream.bytes[at]);
    check_cost(stream, damaged, stream.frame_of[at], stream.frame_of[at]);
  }
}

TEST_CASE("an inserted byte costs the frame it lands in") {
  const Stream stream = sample();
  for (std::size_t at = 0; at < stream.bytes.size(); ++at) {
    for (unsigned value = 0; value < 256; ++value) {
      Bytes damaged = stream.bytes;
      damaged.insert(damaged.begin() + static_cast<std::ptrdiff_t>(at),
                     static_cast<std::byte>(value));
      check_cost(stream, damaged, stream.frame_of[at], stream.frame_of[at]);
    }
  }
}

TEST_CASE("a stream cut anywhere recovers with the next frame") {
  const Stream stream = sample();
  const OwnedFrame next{link::MessageType::hello, 200, {}};
  for (std::size_t cut = 0; cut <= stream.bytes.size(); ++cut) {
    Bytes damaged(stream.bytes.begin(), stream.bytes.begin() + static_cast<std::ptrdiff_t>(cut));
    damaged.push_back(std::byte{0});  // the host clears the line before it talks
    const Bytes wire = test::encode(next);
    damaged.insert(damaged.end(), wire.begin(), wire.end());
    const std::vector<OwnedFrame> got = test::decode(damaged);
    REQUIRE(!got.empty());
    REQUIRE(got.back() == next);
  }
}

TEST_CASE("a megabyte of noise makes no more frames than the CRC lets through, and harms nothing") {
  std::mt19937 random(20230817);
  link::FrameDecoder decoder;
  std::size_t accepted = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    if (decoder.push(static_cast<std::byte>(random()))) ++accepted;
  }
  // About 4,000 pieces between zeros, of which one in 65,536 passes the CRC by chance.
  CHECK(accepted <= 1);
  CHECK(decoder.bad_frames() > 3000);

  const OwnedFrame sent{link::MessageType::hello, 9, {}};
  Bytes stream = {std::byte{0}};
  const Bytes wire = test::encode(sent);
  stream.insert(stream.end(), wire.begin(), wire.end());
  CHECK(test::decode(stream, decoder) == std::vector{sent});
}
