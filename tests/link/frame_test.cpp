// Frames on a clean line: known answers, every length, every byte value.
#include "link/frame.hpp"

#include <algorithm>
#include <string_view>

#include <catch2/catch.hpp>

#include "tests/link/line.hpp"

using namespace robosync;
using test::Bytes;
using test::OwnedFrame;

namespace {

std::span<const std::byte> text(std::string_view characters) {
  return std::as_bytes(std::span(characters.data(), characters.size()));
}

}  // namespace

TEST_CASE("CRC-16/CCITT-FALSE gives the known answers") {
  CHECK(link::crc16(text("123456789")) == 0x29B1);  // the check value of the catalogue
  CHECK(link::crc16(text("")) == 0xFFFF);
  CHECK(link::crc16(text("A")) == 0xB915);
}

TEST_CASE("the frame that stops is always the same, and known by its bytes") {
  const Bytes wire = test::encode({link::MessageType::stop, link::kStopSequence, {}});
  CHECK(std::ranges::equal(wire, link::kStopFrame));
  const auto times = [](const Bytes& line) {
    link::StopDetector watch;
    return std::ranges::count_if(line, [&](std::byte byte) { return watch.push(byte); });
  };
  CHECK(times(wire) == 1);
  const Bytes other = test::encode({link::MessageType::stop, 7, {}});
  CHECK(times(other) == 0);
  Bytes line = other;
  for (const Bytes& next : {wire, other, Bytes{std::byte{0}}, wire, wire})
    line.insert(line.end(), next.begin(), next.end());
  CHECK(times(line) == 3);
}

// Whatever carries its bytes in the midst of other ones is another frame.
TEST_CASE("no piece of another frame stops the robot") {
  Bytes line = {std::byte{1}};
  line.insert(line.end(), link::kStopFrame.begin(), link::kStopFrame.end());
  link::StopDetector watch;
  for (const std::byte byte : line)
    CHECK_FALSE(watch.push(byte));
  for (std::size_t lost = 0; lost < link::kStopFrame.size(); ++lost)
    for (std::size_t i = 0; i < link::kStopFrame.size(); ++i)
      if (i != lost) CHECK_FALSE(watch.push(link::kStopFrame[i]));
}

TEST_CASE("a frame on the wire is what link.md says") {
  const Bytes wire = test::encode({link::MessageType::trace_on, 7, {std::byte{0}}});
  const std::uint16_t crc = link::crc16(Bytes{std::byte{17}, std::byte{7}, std::byte{0}});
  const Bytes expected = {std::byte{3},  // the first zero is 3 bytes away
                          std::byte{17},
                          std::byte{7},
                          std::byte{3},  // then the end is 3 bytes away
                          static_cast<std::byte>(crc & 0xFF),
                          static_cast<std::byte>(crc >> 8),
                          std::byte{0}};
  CHECK(wire == expected);
}

TEST_CASE("every payload length arrives, with any content") {
  for (std::size_t length = 0; length <= link::kMaxPayload; ++length) {
    for (const unsigned step : {0u, 1u, 7u, 255u}) {
      OwnedFrame sent{link::MessageType::data, static_cast<std::uint8_t>(length), Bytes(length)};
      for (std::size_t i = 0; i < length; ++i)
        sent.payload[i] = static_cast<std::byte>(i * step);
      const Bytes wire = test::encode(sent);
      REQUIRE(wire.size() == length + link::kFrameOverhead + 2);
      REQUIRE(std::count(wire.begin(), wire.end(), std::byte{0}) == 1);
      REQUIRE(test::decode(wire) == std::vector{sent});
    }
  }
}

TEST_CASE("a payload that is too long is not sent") {
  CHECK(test::encode({link::MessageType::data, 0, Bytes(link::kMaxPayload + 1)}).empty());
}

TEST_CASE("a frame whose zeros do not lead to its end is bad, even if its content is right") {
  Bytes wire = test::encode({link::MessageType::trace_on, 7, {std::byte{0}}});
  wire[3] = std::byte{4};  // beyond the end
  link::FrameDecoder decoder;
  CHECK(test::decode(wire, decoder).empty());
  CHECK(decoder.bad_frames() == 1);
}

TEST_CASE("empty frames are ignored and not counted as bad") {
  link::FrameDecoder decoder;
  CHECK(test::decode(Bytes(100), decoder).empty());
  CHECK(decoder.bad_frames() == 0);
}

TEST_CASE("a line without delimiters does not overflow, and the next frame arrives") {
  const OwnedFrame sent{link::MessageType::log, 1, Bytes(5, std::byte{'x'})};
  Bytes stream(100'000, std::byte{0x55});
  stream.push_back(std::byte{0});
  const Bytes wire = test::encode(sent);
  stream.insert(stream.end(), wire.begin(), wire.end());
  link::FrameDecoder decoder;
  CHECK(test::decode(stream, decoder) == std::vector{sent});
  CHECK(decoder.bad_frames() == 1);
}

TEST_CASE("payload structs have no padding, and fit in a frame") {
  link::ActivateResult result{};
  CHECK(sizeof result == 16);
  CHECK(sizeof(link::HelloReply) == 96);
  CHECK(sizeof(link::Status) == 40);
  CHECK(sizeof(link::Fault) <= link::kMaxPayload);
}
