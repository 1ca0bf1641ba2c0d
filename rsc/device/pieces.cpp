// Looks for the longest earlier match of each place in the image among some candidates (like LZ77). Promises that the board's
// result is the image, whatever the base is.
#include "rsc/device/pieces.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "link/messages.hpp"
#include "link/wire.hpp"

namespace robosync::tool {
namespace {

constexpr std::size_t kShortest = 8;  // another piece takes 6 bytes
constexpr std::size_t kMostTried = 32;
constexpr std::size_t kFarthest = 0xFFFF;  // the most that two bytes can encode
constexpr std::size_t kNowhere = SIZE_MAX;

// Earlier places with the same kShortest bytes, latest first.
class Earlier {
public:
  explicit Earlier(std::span<const std::byte> all) : all_(all), before_(all.size(), kNowhere) {
    latest_.fill(kNowhere);
  }
  void add(std::size_t at) {
    if (at + kShortest > all_.size() || at > kFarthest) return;
    std::size_t& latest = latest_[key(at)];
    before_[at] = latest;
    latest = at;
  }
  // The start of the longest match; its length is 0 if there is none.
  std::size_t find(std::size_t at, std::size_t& length) const {
    length = 0;
    if (at + kShortest > all_.size()) return kNowhere;
    std::size_t best = kNowhere;
    std::size_t tried = 0;
    for (std::size_t from = latest_[key(at)]; from != kNowhere && tried < kMostTried;
         from = before_[from], ++tried) {
      const auto rest = all_.subspan(at, std::min(kFarthest - from, all_.size() - at));
      const auto end = std::ranges::mismatch(rest, all_.subspan(from)).in1;
      const auto same = static_cast<std::size_t>(end - rest.begin());
      if (same < kShortest || same <= length) continue;
      length = same;
      best = from;
    }
    return best;
  }

private:
  std::size_t key(std::size_t at) const {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, all_.data() + at, kShortest);
    return bytes * 0x9E37'79B9'7F4A'7C15U >> 50U;
  }

  std::span<const std::byte> all_;
  std::array<std::size_t, 1U << 14U> latest_;
  std::vector<std::size_t> before_;
};

void append(std::vector<std::byte>& payload, std::span<const std::byte> bytes) {
  payload.insert(payload.end(), bytes.begin(), bytes.end());
}

}  // namespace

Pieces::Pieces(std::span<const std::byte> base, std::span<const std::byte> image)
    : image_(image), base_bytes_(base.size()) {
  std::vector<std::byte> all(base.begin(), base.end());
  all.insert(all.end(), image.begin(), image.end());
  find_ranges(all);
}

void Pieces::find_ranges(std::span<const std::byte> all) {
  Earlier earlier(all);
  std::size_t added = 0;
  for (std::size_t at = base_bytes_; at < all.size();) {
    for (; added < at; ++added)
      earlier.add(added);
    std::size_t length = 0;
    const std::size_t from = earlier.find(at, length);
    if (length > 0) ranges_.push_back({at - base_bytes_, at - base_bytes_ + length, from});
    at += std::max<std::size_t>(length, 1);
  }
}

std::size_t Pieces::fill(std::size_t at, std::size_t most_bytes,
                         std::vector<std::byte>& payload) const {
  auto range = std::ranges::upper_bound(ranges_, at, {}, &Range::end);
  while (at < image_.size() && payload.size() + sizeof(link::Piece) < most_bytes) {
    link::Piece piece{};
    if (range != ranges_.end() && range->begin <= at) {
      piece.from = static_cast<std::uint16_t>(range->from + (at - range->begin));
      piece.copied = static_cast<std::uint16_t>(range->end - at);
      at = range->end;
      ++range;
    }
    const std::size_t next = range != ranges_.end() ? range->begin : image_.size();
    const std::size_t room = most_bytes - payload.size() - sizeof piece;
    const auto bytes = image_.subspan(at, std::min(next - at, room));
    piece.count = static_cast<std::uint16_t>(bytes.size());
    append(payload, link::wire_bytes(piece));
    append(payload, bytes);
    at += bytes.size();
  }
  return at;
}

}  // namespace robosync::tool
