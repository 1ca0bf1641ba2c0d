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
constexpr Begin kBegin{1, kSize, {0xC0, 0xFF, 0xEE}, {}};

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
  CHECK(receiver.hash() == kBegin.hash);
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
  CHECK(receiver.begin({1, kSize, {1}, {}}, buffer).next_offset == 0);
  receiver.data(0, std::span(sent).first(500));
  CHECK(receiver.begin({1, kSize - 1, {1}, {}}, buffer).next_offset == 0);
  receiver.data(0, std::span(sent).first(500));
  CHECK(receiver.begin({1, kSize - 1, {1}, {}}, other).next_offset == 0);
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
  receiver.begin({1, 100, {0}, {}}, buffer);
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
  CHECK(receiver.begin({1, kSize + 1, {0}, {}}, buffer).state == TransferState::too_large);
  CHECK(receiver.begin({1, 0xFFFFFFFF, {0}, {}}, buffer).state == TransferState::too_large);
  CHECK(receiver.data(0, buffer).state == TransferState::no_transfer);
  CHECK_FALSE(receiver.complete());
  CHECK(receiver.begin({1, kSize, {0}, {}}, buffer).state == TransferState::receiving);
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
  CHECK(receiver.begin({1, 0, {0}, {}}, buffer).state == TransferState::complete);
  CHECK(receiver.bytes().empty());
}

namespace {

// A message's pieces, one after the other.
std::vector<std::byte> pieces_of(
    const std::vector<std::pair<Piece, std::vector<std::byte>>>& pieces) {
  std::vector<std::byte> payload;
  for (const auto& [piece, bytes] : pieces) {
    const auto head = std::as_bytes(std::span(&piece, 1));
    payload.insert(payload.end(), head.begin(), head.end());
    payload.insert(payload.end(), bytes.begin(), bytes.end());
  }
  return payload;
}

const std::vector<std::byte> kTwo{std::byte{0xA1}, std::byte{0xA2}};

}  // namespace

TEST_CASE("pieces copy from the base, from what has come, and give bytes") {
  const auto base = image();
  std::vector<std::byte> buffer(kSize);
  Receiver receiver;
  receiver.begin({1, 20, {1}, {2}}, buffer, base);
  // 4 of the base from 10 and 2 new ones; then what has come so far, which it reads as it writes.
  CHECK(receiver.pieces(0, pieces_of({{{10, 4, 2}, kTwo}, {{kSize, 14, 0}, {}}})).state ==
        TransferState::complete);
  const auto bytes = receiver.bytes();
  CHECK(std::ranges::equal(bytes.first(4), std::span(base).subspan(10, 4)));
  CHECK(std::ranges::equal(bytes.subspan(4, 2), kTwo));
  for (std::size_t i = 6; i < 20; ++i)
    CHECK(bytes[i] == bytes[i - 6]);
}

TEST_CASE("a message of pieces is taken as a whole, or not at all") {
  const auto base = image();
  std::vector<std::byte> guarded(kSize + 64, std::byte{0xEE});
  const auto buffer = std::span(guarded).first(kSize);
  Receiver receiver;
  receiver.begin({1, 20, {1}, {2}}, buffer, base);
  const Piece good{0, 4, 2};
  const std::vector<std::vector<std::byte>> wrong = {
      pieces_of({{good, kTwo}, {{0, 15, 0}, {}}}),           // more than the image has
      pieces_of({{good, kTwo}, {{0, 13, 2}, kTwo}}),         // … with its bytes
      pieces_of({{good, kTwo}, {{0, 0, 3}, kTwo}}),          // bytes that are not there
      pieces_of({{good, kTwo}, {{kSize + 6, 1, 0}, {}}}),    // what has not come yet
      pieces_of({{good, kTwo}, {{0xFFFF, 0xFFFF, 0}, {}}}),  // far away
      {std::byte{1}},                                        // half a piece
  };
  for (const auto& payload : wrong)
    CHECK(receiver.pieces(0, payload).next_offset == 0);
  CHECK(receiver.pieces(0, pieces_of({{good, kTwo}})).next_offset == 6);
  CHECK(receiver.pieces(0, pieces_of({{good, kTwo}})).next_offset == 6);  // not wanted any more
  CHECK(std::all_of(guarded.begin() + kSize, guarded.end(),
                    [](std::byte byte) { return byte == std::byte{0xEE}; }));
  Receiver none;
  CHECK(none.pieces(0, pieces_of({{good, kTwo}})).state == TransferState::no_transfer);
}

TEST_CASE("whatever pieces say, nothing is read or written out of place") {
  const auto base = image();
  std::mt19937 random(9);
  std::vector<std::byte> buffer(kSize);
  for (unsigned round = 0; round < 20'000; ++round) {
    Receiver receiver;
    receiver.begin({1, static_cast<std::uint32_t>(random() % kSize), {1}, {2}}, buffer,
                   std::span(base).first(random() % kSize));
    std::vector<std::byte> payload(random() % 60);
    for (std::byte& byte : payload)
      byte = static_cast<std::byte>(random() % 3 == 0 ? random() : random() % 4);
    (void)receiver.pieces(0, payload);  // the sanitizers look
  }
}
