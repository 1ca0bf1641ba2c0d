// Part of the chip's flash as the board's store. It remembers only which page has just been erased. A write compares the
// flash's contents with the wanted data, so an interrupted write can be continued, or turns out to be impossible.
//
// Chip implements the flash access:
//   kPage              bytes that are erased together
//   kUnit              words that are written together
//   kStalls            an erase stalls code execution
//   erase(page, call)  does the next part of erasing the page at that address; `call` counts from 0. No part stalls
//                      others for longer than Store::kStall
//   program(at, words) writes kUnit words to an erased page
//   is_busy()          an erase is still running, maybe one that was given up: a read would stall. If that never ends, the
//                      store does not answer
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "runtime-m4/boards/store.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"

namespace robosync::boards {

enum class Erasing : std::uint8_t { goes_on, done, failed };

template <typename Chip>
class FlashStore final : public Store {
public:
  // `begin` is the store's address, at the start of a page.
  constexpr FlashStore(std::uint32_t begin, std::uint32_t bytes) : begin_(begin), bytes_(bytes) {}

  std::uint32_t size() const override { return bytes_; }
  std::uint32_t page() const override { return Chip::kPage; }
  bool is_flash() const override { return true; }

  Outcome read(std::uint32_t at, std::span<std::byte> bytes) override {
    if (Chip::is_busy()) return wait();
    waited_ = 0;
    const Words words = words_at(at);
    std::memcpy(bytes.data(), words.data(), std::min(bytes.size(), kPiece));
    return Outcome::done;
  }

  // The rest of a short piece stays erased.
  Outcome write(std::uint32_t at, std::span<const std::byte> bytes) override {
    if (at % Chip::kPage == 0 && erased_ != at) return erase(at);
    if (Chip::is_busy()) return wait();
    waited_ = 0;
    Words wanted;
    wanted.fill(~std::uint32_t{0});
    std::memcpy(wanted.data(), bytes.data(), std::min(bytes.size(), kPiece));
    for (std::size_t i = 0; i < wanted.size(); i += Chip::kUnit)
      if (!std::ranges::equal(unit(wanted, i), unit(words_at(at), i)))
        Chip::program(begin_ + at + static_cast<std::uint32_t>(i * kWord), unit(wanted, i));
    erased_ = kNone;  // the next write to the page's beginning erases it again
    return words_at(at) == wanted ? Outcome::done : Outcome::spent;
  }

private:
  static constexpr Outcome kGoesOn = Chip::kStalls ? Outcome::goes_on : Outcome::at_work;
  static constexpr unsigned kMostWaits = 1000;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::size_t kWord = sizeof(std::uint32_t);
  using Words = std::array<std::uint32_t, kPiece / kWord>;

  static std::span<const std::uint32_t, Chip::kUnit> unit(const Words& words, std::size_t at) {
    return std::span(words).subspan(at).template first<Chip::kUnit>();
  }

  Words words_at(std::uint32_t at) const {
    Words words;
    for (std::size_t i = 0; i < words.size(); ++i)
      words[i] = port::Register{begin_ + at + i * kWord}.read();
    return words;
  }

  Outcome erase(std::uint32_t at) {
    if (erasing_ != at) {
      calls_ = 0;
      erasing_ = at;
      return kGoesOn;
    }
    const Erasing state = Chip::erase(begin_ + at, calls_++);
    if (state == Erasing::goes_on) return kGoesOn;
    erasing_ = kNone;
    if (state == Erasing::failed) return Outcome::spent;
    erased_ = at;
    return kGoesOn;
  }

  Outcome wait() { return ++waited_ < kMostWaits ? kGoesOn : Outcome::spent; }

  std::uint32_t begin_, bytes_;
  std::uint32_t erasing_ = kNone;
  unsigned calls_ = 0;
  unsigned waited_ = 0;           // for the end of an erase that was given up
  std::uint32_t erased_ = kNone;  // this page is erased, and nothing has been written to it since
};

}  // namespace robosync::boards
