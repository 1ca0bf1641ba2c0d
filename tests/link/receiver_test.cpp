// The receiving end of a transfer: loss, duplication, reordering, resuming, and lies about sizes.
#include "link/receiver.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

using namespace robosync::link;

namespace {

constexpr std::size_t kSize = 1000;
constexpr Begin kBegin{kSize, 0xC0FFEE};

std::vector<std::byte> image() {
  std::vector<std::byte> bytes(kSize);
  std::mt19937 random(7);
  for (std::byte& byte : bytes)
    byte = static_cast<std::byte>(random());
  return bytes;
}

bool holds(const Receiver& receiver, const std::vector<std::byte>& bytes) {
  return receiver.complete() && std::ranges::equal(receiver.bytes(), bytes);
}

}  // namespace

TEST_CASE("a transfer in order") {
  const auto sent = image();
  std::vector<std::byte> buffer(kSize);
  Receiver receiver;
  CHECK(receiver.status().state == TransferState::idle);
  CHECK(receiver.begin(kBegin, buffer).next_offset == 0);
  for (std::uint32_t at = 0; at < kSize; at += 100) {
    CHECK_FALSE(receiver.complete());
    CHECK(receiver.data(at, std::span(sent).subspan(at, 100)).next_offset == at + 100);
  }
  CHECK(receiver.status().state == TransferState::complete);
  CHECK(holds(receiver, sent));
  CHECK(receiver.crc32() == kBegin.crc32);
}

TEST_CASE("a transfer resumes at each offset") {
  const auto sent = image();
  for (std::uint32_t cut = 0; cut <= kSize; ++cut) {
    std::vector<std::byte> buffer(kSize);
    Receiver receiver;
    receiver.begin(kBegin, buffer);
    receiver.data(0, std::span(sent).first(cut));
    const TransferStatus resumed = receiver.begin(kBegin, buffer);
    REQUIRE(resumed.next_offset == cut);
    receiver.data(cut, std::span(sent).subspan(cut));
    REQUIRE(holds(receiver, sent));
  }
}

TEST_CASE("another image, or another buffer, starts from the beginning") {
  const auto sent = image();
  std::vector<std::byte> buffer(kSize);
  std::vector<std::byte> other(kSize);
  Receiver receiver;
  receiver.begin(kBegin, buffer);
  receiver.data(0, std::span(sent).first(500));
  CHECK(receiver.begin({kSize, 1}, buffer).next_offset == 0);
  receiver.data(0, std::span(sent).first(500));
  CHECK(receiver.begin({kSize - 1, 1}, buffer).next_offset == 0);
  receiver.data(0, std::span(sent).first(500));
  CHECK(receiver.begin({kSize - 1, 1}, other).next_offset == 0);
}

TEST_CASE("frames lost, doubled and reordered at random: the wanted offset leads to the whole") {
  const auto sent = image();
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> buffer(kSize);
    Receiver receiver;
    TransferStatus status = receiver.begin(kBegin, buffer);
    int rounds = 0;
    while (!receiver.complete()) {
      REQUIRE(++rounds < 1000);
      // The host sends up to four pieces from the wanted offset on; the line plays tricks.
      std::vector<std::pair<std::uint32_t, std::uint32_t>> pieces;
      for (std::uint32_t at = status.next_offset; at < kSize && pieces.size() < 4; at += 60)
        pieces.emplace_back(at, std::min<std::uint32_t>(60, kSize - at));
      if (random() % 3 == 0) pieces.push_back(pieces[random() % pieces.size()]);
      if (random() % 3 == 0) std::shuffle(pieces.begin(), pieces.end(), random);
      for (const auto& [at, length] : pieces) {
        if (random() % 4 == 0) continue;
        const std::uint32_t before = status.next_offset;
        status = receiver.data(at, std::span(sent).subspan(at, length));
        REQUIRE(status.next_offset == (at == before ? at + length : before));
      }
    }
    REQUIRE(holds(receiver, sent));
  }
}

TEST_CASE("data that would not fit is not taken") {
  std::vector<std::byte> guarded(kSize + 64, std::byte{0xEE});
  const auto buffer = std::span(guarded).first(kSize);
  const std::vector<std::byte> bytes(64, std::byte{1});
  Receiver receiver;
  receiver.begin({100, 0}, buffer);
  CHECK(receiver.data(0, bytes).next_offset == 64);
  CHECK(receiver.data(64, bytes).next_offset == 64);          // 28 too many
  CHECK(receiver.data(0xFFFFFFFF, bytes).next_offset == 64);  // wraps around
  CHECK(receiver.data(63, bytes).next_offset == 64);          // overlaps
  CHECK(std::all_of(guarded.begin() + 64, guarded.end(),
                    [](std::byte byte) { return byte == std::byte{0xEE}; }));
}

TEST_CASE("an image larger than the buffer is refused, and its data with it") {
  std::vector<std::byte> buffer(kSize);
  Receiver receiver;
  CHECK(receiver.begin({kSize + 1, 0}, buffer).state == TransferState::too_large);
  CHECK(receiver.begin({0xFFFFFFFF, 0}, buffer).state == TransferState::too_large);
  CHECK(receiver.data(0, buffer).state == TransferState::no_transfer);
  CHECK_FALSE(receiver.complete());
  CHECK(receiver.begin({kSize, 0}, buffer).state == TransferState::receiving);
}

TEST_CASE("data without a transfer is not taken") {
  const auto sent = image();
  Receiver receiver;
  CHECK(receiver.data(0, sent).state == TransferState::no_transfer);
  CHECK_FALSE(receiver.complete());
}

TEST_CASE("an empty image is complete at once, and has no bytes") {
  std::vector<std::byte> buffer(kSize);
  Receiver receiver;
  CHECK(receiver.begin({0, 0}, buffer).state == TransferState::complete);
  CHECK(receiver.bytes().empty());
}
