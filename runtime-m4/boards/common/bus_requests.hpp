// What is wanted of an I2C bus (asked_bus.hpp): requests that stay, so that the same one is found again.
//
// Finding one takes most of what a sample costs. So the parts of a request lie as they are compared, a word at a time, and the table
// remembers what followed each request the last time: a sensor asks, and collects, in the same order every time.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/transfer.hpp"

namespace robosync::boards {

// The master's DMA reads and writes these, so they do not move.
struct alignas(std::uint32_t) BusRequest {
  // Written and read: part of a display's picture, or a register's number, and a motion sensor's setting and outputs.
  static constexpr std::size_t kMostBytes = 19;

  using Word = std::uint32_t;
  // The numbers of bytes, compared as one word. Nothing written: the request is free.
  struct Shape {
    std::uint8_t address;
    std::uint8_t first;    // transfer: bytes written, and those read times 4; 0: there is none
    std::uint8_t written;  // by the other one
    std::uint8_t read;     // by both
  };
  static_assert(std::bit_cast<Word>(Shape{0, 1, 0, 0}) == 1U << 8);
  static constexpr Word shape_of(std::uint8_t address, Word first, std::size_t written,
                                 std::size_t read) {
    return address | first << 8 | static_cast<Word>(written << 16 | read << 24);
  }
  static constexpr Word written_of(Word shape) { return shape >> 16 & 0xFF; }
  static constexpr unsigned kRead = 4;  // in Shape::first
  static_assert(kMostSelected < kRead);

  using State = RequestState;

  Shape shape{};
  std::uint32_t turn = 0;
  // What the first transfer writes, from 1 on, and the other one, from kOut on; behind it, what both read. The first word is
  // compared as one.
  static constexpr std::size_t kFirst = 1, kOut = kFirst + kMostSelected;
  std::array<std::byte, kOut + kMostBytes> bytes{};
  State state = State::failed;
  bool ahead = false;
  std::uint8_t follower = 0;  // the request that was looked for behind this one the last time

  std::byte* in() { return &bytes[kOut + shape.written]; }
  bool under_way() const { return is_under_way(state); }
  bool is_free() const { return shape.written == 0; }
  void free() {
    state = State::failed;
    shape = {};
  }
};
static_assert(BusRequest::kOut < sizeof(BusRequest::Word) &&
              offsetof(BusRequest, bytes) % sizeof(BusRequest::Word) == 0);

// Words first: the core reads and writes them at any address.
[[gnu::always_inline]] inline void copy_words(const std::byte* from, std::byte* to,
                                              std::size_t bytes) {
  using Word = BusRequest::Word;
  for (; bytes >= sizeof(Word); bytes -= sizeof(Word)) {
    std::memcpy(to, from, sizeof(Word));
    from += sizeof(Word);
    to += sizeof(Word);
  }
  for (; bytes != 0; --bytes)
    *to++ = *from++;
}

class BusRequests {
public:
  using Word = BusRequest::Word;
  using State = RequestState;
  // More than fit into the time (policy::bus_window_us()).
  static constexpr std::size_t kMost = ROBOSYNC_BUS_REQUESTS;

  // The request with this shape and these bytes, if it is known: `head` is the first word of BusRequest::bytes, and the bytes from
  // out[1] on come after it. Not inlined, as place(): in one function they need more registers than there are.
  [[gnu::noinline]] BusRequest* find(Word shape, Word head, const std::byte* out);
  // Makes it, if there is room.
  [[gnu::noinline]] BusRequest* place(Word shape, Word head, const std::byte* out);
  // The one that waits and was asked first. There is one.
  BusRequest& first_waiting();
  void fail_waiting();

private:
  std::span<BusRequest> used() { return std::span(requests_).first(used_); }
  [[gnu::noinline]] BusRequest* search(Word shape, Word head, const std::byte* out);
  void follow(BusRequest& request);

  std::uint8_t used_ = 0;    // requests, from the first on
  std::uint8_t latest_ = 0;  // the request that was looked for last
  std::uint8_t guess_ = 0;   // … and what was looked for next the last time
  std::array<BusRequest, kMost> requests_{};
};

}  // namespace robosync::boards
