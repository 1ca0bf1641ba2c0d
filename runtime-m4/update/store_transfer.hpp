// Copies part of the board's store to or from memory, one small transfer at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/store.hpp"

namespace robosync::update {

enum class Work : std::uint8_t {
  none,   // there is nothing to do
  some,   // a piece is done; there may be more
  waits,  // as `some`, but the next attempt makes no sense for a millisecond
  rests,  // as `some`, but the next piece makes everything else wait: Store::Outcome::goes_on
  ended   // the last piece is done
};

class StoreTransfer {
public:
  // nullptr: treated as a store that does not answer.
  explicit StoreTransfer(boards::Store* store) : store_(store) {}

  // From or to the byte `at` of the store, a multiple of Store::kPiece. A transfer in progress is given up.
  void read(std::uint32_t at, std::span<std::byte> to) { begin(at, to, {}); }
  void write(std::uint32_t at, std::span<const std::byte> from) { begin(at, {}, from); }
  void give_up() { busy_ = false; }

  // Does the next piece.
  Work work() {
    if (!busy_) return Work::none;
    if (store_ == nullptr) return end(false);
    if (done_ == length()) return end(true);
    switch (transfer()) {
      case boards::Store::Outcome::taken:
        break;
      case boards::Store::Outcome::busy:
        return ++unanswered_ < kPatience ? Work::waits : end(false);
      case boards::Store::Outcome::goes_on:
        return Work::rests;
      case boards::Store::Outcome::at_work:
        return Work::waits;
      case boards::Store::Outcome::spent:
        return end(false);
      case boards::Store::Outcome::done:
        unanswered_ = 0;
        done_ += std::min(boards::Store::kPiece, length() - done_);
        // At once: until then a request could believe that the store does not have what it has.
        if (done_ == length()) return end(true);
    }
    return Work::some;
  }
  // The whole transfer succeeded. Valid after Work::ended.
  bool answered() const { return answered_; }

private:
  static constexpr unsigned kPatience = 20;  // attempts without an answer, a millisecond each

  void begin(std::uint32_t at, std::span<std::byte> to, std::span<const std::byte> from) {
    busy_ = true;
    at_ = at;
    to_ = to;
    from_ = from;
    done_ = 0;
    unanswered_ = 0;
  }
  Work end(bool answered) {
    busy_ = false;
    answered_ = answered;
    return Work::ended;
  }
  std::size_t length() const { return std::max(to_.size(), from_.size()); }
  boards::Store::Outcome transfer() {
    const std::uint32_t at = at_ + static_cast<std::uint32_t>(done_);
    const std::size_t count = std::min(boards::Store::kPiece, length() - done_);
    return from_.empty() ? store_->read(at, to_.subspan(done_, count))
                         : store_->write(at, from_.subspan(done_, count));
  }

  boards::Store* store_;
  bool busy_ = false;
  bool answered_ = false;
  std::uint32_t at_ = 0;
  std::span<std::byte> to_;
  std::span<const std::byte> from_;
  std::size_t done_ = 0;
  unsigned unanswered_ = 0;
};

}  // namespace robosync::update
