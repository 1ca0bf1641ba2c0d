// A board's store in memory. It may lose its power during a write, be busy, or lose its bus to a sensor.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "runtime-m4/boards/store.hpp"

namespace robosync::test {

class MemoryStore final : public boards::Store {
public:
  static constexpr std::uint32_t kPage = 64;

  explicit MemoryStore(std::uint32_t size) : bytes(size, std::byte{0xFF}) {}

  std::uint32_t size() const override { return static_cast<std::uint32_t>(bytes.size()); }
  std::uint32_t page() const override { return kPage; }
  bool is_flash() const override { return stalls != 0; }

  Outcome read(std::uint32_t at, std::span<std::byte> to) override {
    if (const auto other = in_the_way()) return *other;
    std::copy_n(bytes.begin() + at, to.size(), to.begin());
    busy_for_ = reads_take;
    ++reads;
    return Outcome::done;
  }

  // A write that lost the bus may have been done in part.
  Outcome write(std::uint32_t at, std::span<const std::byte> from) override {
    const auto other = in_the_way();
    if (other == Outcome::busy) return *other;
    if (at % kPage == 0 && stalled_ < stalls) {
      if (stalled_++ != 0) stall();
      return Outcome::goes_on;
    }
    stalled_ = 0;
    for (std::size_t i = 0; i < from.size() / (other ? 2 : 1); ++i) {
      if (power_for == 0) return lose_power(at);
      if (power_for) --*power_for;
      bytes[at + i] = from[i];
      ++written;
    }
    if (other) return *other;
    if (wrote) wrote(at + static_cast<std::uint32_t>(from.size()));
    busy_for_ = writes_take;
    return Outcome::done;
  }

  void switch_on() {
    power_for.reset();
    dead = false;
  }

  std::vector<std::byte> bytes;
  std::size_t written = 0;  // bytes
  std::size_t reads = 0;    // transfers
  std::optional<std::size_t>
      power_for;             // bytes until the power is cut; the page of the next one is spoiled
  unsigned writes_take = 0;  // transfers that find the store busy after a write
  unsigned reads_take = 0;   // … after a read
  unsigned one_in_is_taken = 0;  // 0: none
  bool dead = false;             // it never answers
  unsigned stalls = 0;           // a page is erased in this many parts, plus one; 0: not flash
  std::function<void()> stall;
  std::function<void(std::uint32_t end)> wrote;  // a whole piece, up to `end`

private:
  std::optional<Outcome> in_the_way() {
    if (dead || busy_for_ != 0) {
      busy_for_ -= busy_for_ != 0 ? 1 : 0;
      return Outcome::busy;
    }
    if (one_in_is_taken != 0 && random_() % one_in_is_taken == 0) return Outcome::taken;
    return std::nullopt;
  }

  Outcome lose_power(std::uint32_t at) {
    const auto page = bytes.begin() + at / kPage * kPage;
    std::generate(page, page + kPage, [this] { return static_cast<std::byte>(random_()); });
    dead = true;
    return Outcome::busy;
  }

  unsigned busy_for_ = 0;
  unsigned stalled_ = 0;
  std::mt19937 random_{1};
};

// The bytes of the store before `end`.
template <typename T>
T bytes_before(const MemoryStore& memory, std::uint32_t end) {
  T value{};
  std::memcpy(&value, memory.bytes.data() + end - sizeof value, sizeof value);
  return value;
}

}  // namespace robosync::test
