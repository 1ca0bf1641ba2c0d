// An I2C bus whose master has DMA. The processor starts a transfer and an interrupt reports its end, so no thread waits.
// Transfers are therefore asked ahead (boards::Board::ask_buses()). They are queued as requests and run one after the other, in
// the order in which they were asked. A request may have a first transfer, which selects a page (select()) or reads other
// registers (read_two()); no other request comes between the two.
//
// Time is bounded. A transfer that is not acknowledged, or does not get the clock, has failed. One that is not over when its
// answer is due is given up, and the bus released. If the data line is held low before a transfer, it gets up to nine clocks;
// while a line stays low, no transfer begins.
//
// Master implements the hardware's part:
//   start()                  called once
//   begin(address, out, in)  writes `out`, then reads `in`, if it is not empty; neither moves during the transfer
//   on_interrupt()           returns the transfer's state
//   let_go()                 aborts any transfer, releases the lines and is ready for the next one
//   clock_is_high(), data_is_high(), are_high() both
//   take_clock(), give_clock_back()   the master is off in between, and drive_clock(high) sets the line
//   half_bit()               waits for some 1.5 us
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"

namespace robosync::boards {

enum class Transfer : std::uint8_t { goes_on, done, failed };

template <typename Master>
class AskedBus {
public:
  constexpr explicit AskedBus(Master master) : master_(master) {}

  void start() { master_.start(); }
  // As in boards::Board; `ahead` is the last argument of ask_buses(). A transfer too long for a request fails.
  //  [one thread at a time]
  bool select(std::span<const std::byte> page);
  bool transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                std::span<std::byte> in);
  bool read_two(bool ahead, std::uint8_t address, TwoBlocks blocks, std::span<std::byte> in);
  bool is_busy() const { return running_ != nullptr; }
  BusState state() const { return {clears_, static_cast<std::uint8_t>(held_)}; }
  // [its interrupt]
  void on_interrupt();

  // More than fit into the time (policy::kBusWindowUs).
  static constexpr std::size_t kMostRequests = 20;

private:
  // Written and read: part of a display's picture, or a register's number, and a motion sensor's setting and outputs.
  static constexpr std::size_t kMostBytes = 19;
  static constexpr unsigned kMostClocks = 9;  // a byte and its acknowledge bit

  using Word = std::uint32_t;
  // The numbers of bytes of a request, compared as one word. Nothing written: the request is free.
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

  // The master's DMA reads and writes these, so they do not move.
  struct alignas(Word) Request {
    enum class State : std::uint8_t { waits, runs, done, failed };
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
    bool under_way() const { return state == State::waits || state == State::runs; }
    bool is_free() const { return shape.written == 0; }
    void free() {
      state = State::failed;
      shape = {};
    }
  };
  static_assert(Request::kOut < sizeof(Word) && offsetof(Request, bytes) % sizeof(Word) == 0);
  using State = typename Request::State;

  std::span<Request> used() { return std::span(requests_).first(used_); }
  // Not inlined: in one function they need more registers than there are. `head` is the first word of Request::bytes, and the bytes
  // from out[1] on come after it.
  [[gnu::noinline]] Request* find(Word shape, Word head, const std::byte* out);
  [[gnu::noinline]] Request* search(Word shape, Word head, const std::byte* out);
  static bool is(const Request& request, Word shape, Word head, const std::byte* out);
  [[gnu::noinline]] static bool are_same(const std::byte* a, const std::byte* b, std::size_t bytes);
  [[gnu::noinline]] Request* place(Word shape, Word head, const std::byte* out);
  void follow(Request& request);
  [[gnu::noinline]] void ask(Request& request, bool ahead);
  [[gnu::noinline]] bool collect(Request& request, std::byte* in);
  [[gnu::cold]] void give_up(Request& request);
  static void copy(const std::byte* from, std::byte* to, std::size_t bytes);
  Request& take_next();
  [[gnu::cold]] void fail_waiting();
  void begin(Request& request);
  void send_first(Request& request);
  void send_other(Request& request);
  [[gnu::noinline]] void send(const std::byte* out, std::byte* in, Word shape);
  void end(State how);
  bool free_lines();
  [[gnu::cold]] bool clear_lines();
  void clock_out();

  Master master_;
  Request* running_ = nullptr;
  std::size_t used_ = 0;  // requests, from the first on
  std::uint32_t turn_ = 0;
  Word page_ = 0;  // for the next transfer: as in `head`, and in the lowest byte how long it is
  bool is_first_ = false;  // running_ is in its first transfer
  std::uint16_t clears_ = 0;
  std::uint8_t latest_ = 0;   // the request that was looked for last
  std::uint8_t guess_ = 0;    // … and what was looked for next the last time
  std::uint8_t waiting_ = 0;  // requests; none without a running one
  bool held_ = false;
  std::array<Request, kMostRequests> requests_{};
};

template <typename Master>
bool AskedBus<Master>::select(std::span<const std::byte> page) {
  if (page.size() > kMostSelected) return false;
  page_ = static_cast<Word>(page.size());
  for (std::size_t i = 0; i < page.size(); ++i)
    page_ |= std::to_integer<Word>(page[i]) << 8 * (Request::kFirst + i);
  return true;
}

// A write that was not asked ahead is sent, too, each time.
template <typename Master>
bool AskedBus<Master>::transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                                std::span<std::byte> in) {
  const Word page = std::exchange(page_, 0);
  if (out.size() + in.size() > kMostBytes || out.empty()) return false;
  const Word shape = shape_of(address, page & 0xFF, out.size(), in.size());
  const Word head = (page & ~Word{0xFF}) | std::to_integer<Word>(out[0]) << 8 * Request::kOut;
  port::Alone alone;
  Request* request = find(shape, head, out.data());
  if (ahead || (in.empty() && (request == nullptr || !request->ahead))) {
    if (request == nullptr) request = place(shape, head, out.data());
    if (request != nullptr) ask(*request, ahead);
    return request != nullptr && in.empty();
  }
  return request != nullptr && collect(*request, in.data());
}

template <typename Master>
bool AskedBus<Master>::read_two(bool ahead, std::uint8_t address, TwoBlocks blocks,
                                std::span<std::byte> in) {
  if (1 + in.size() > kMostBytes || blocks.split >= in.size()) return false;
  const Word shape = shape_of(address, 1 + kRead * blocks.split, 1, in.size());
  const Word head = std::to_integer<Word>(blocks.first) << 8 * Request::kFirst |
                    std::to_integer<Word>(blocks.second) << 8 * Request::kOut;
  port::Alone alone;
  Request* request = find(shape, head, nullptr);
  if (!ahead) return request != nullptr && collect(*request, in.data());
  if (request == nullptr) request = place(shape, head, nullptr);
  if (request != nullptr) ask(*request, ahead);
  return false;
}

// A sensor asks, and collects, in the same order every time. So what follows the latest one is usually the same as before.
template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::find(Word shape, Word head,
                                                           const std::byte* out) {
  const std::uint8_t guess = guess_;
  Request& request = requests_[guess];
  if (!is(request, shape, head, out)) [[unlikely]]
    return search(shape, head, out);
  latest_ = guess;
  guess_ = request.follower;
  return &request;
}

template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::search(Word shape, Word head,
                                                             const std::byte* out) {
  for (Request& request : used())
    if (is(request, shape, head, out)) {
      follow(request);
      return &request;
    }
  return nullptr;
}

template <typename Master>
void AskedBus<Master>::follow(Request& request) {
  const auto number = static_cast<std::uint8_t>(&request - requests_.data());
  requests_[latest_].follower = number;
  latest_ = number;
  guess_ = request.follower;
}

template <typename Master>
[[gnu::always_inline]] inline bool AskedBus<Master>::is(const Request& request, Word shape,
                                                        Word head, const std::byte* out) {
  Word known = 0;
  std::memcpy(&known, request.bytes.data(), sizeof known);
  if (std::bit_cast<Word>(request.shape) != shape || known != head) return false;
  const Word written = written_of(shape);
  return written == 1 || are_same(out + 1, request.bytes.data() + sizeof known, written - 1);
}

template <typename Master>
bool AskedBus<Master>::are_same(const std::byte* a, const std::byte* b, std::size_t bytes) {
  for (; bytes >= sizeof(Word); bytes -= sizeof(Word), a += sizeof(Word), b += sizeof(Word)) {
    Word in_a = 0;
    Word in_b = 0;
    std::memcpy(&in_a, a, sizeof in_a);
    std::memcpy(&in_b, b, sizeof in_b);
    if (in_a != in_b) return false;
  }
  return std::equal(a, a + bytes, b);
}

// Makes a request. The one that has not been asked for the longest time gives up its place.
template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::place(Word shape, Word head,
                                                            const std::byte* out) {
  Request* found = nullptr;
  for (Request& request : used()) {
    if (request.is_free()) {
      found = &request;
      break;
    }
    if (!request.under_way() && (found == nullptr || request.turn < found->turn)) found = &request;
  }
  if (used_ < requests_.size() && (found == nullptr || !found->is_free()))
    found = &requests_[used_++];
  if (found == nullptr) return nullptr;
  found->shape = std::bit_cast<Shape>(shape);
  std::memcpy(found->bytes.data(), &head, sizeof head);
  if (const Word more = written_of(shape) - 1; more != 0)
    copy(out + 1, found->bytes.data() + sizeof head, more);
  follow(*found);
  return found;
}

// Two callers that want the same transfer share one request.
template <typename Master>
void AskedBus<Master>::ask(Request& request, bool ahead) {
  if (request.under_way()) return;
  request.ahead = ahead;
  request.turn = ++turn_;
  if (running_ == nullptr) return begin(request);
  request.state = State::waits;
  ++waiting_;
}

// A read's result can be collected again until the read is asked ahead anew; a write's result only once. Nobody waits for the
// end of a write. If a read is late, the running transfer is given up, even if it belongs to another request.
template <typename Master>
bool AskedBus<Master>::collect(Request& request, std::byte* in) {
  const std::size_t bytes = request.shape.read;
  const bool done = request.state == State::done;
  if (done && bytes != 0) [[likely]] {
    copy(request.in(), in, bytes);
    return true;
  }
  const bool late = request.under_way();
  if (bytes == 0) {
    if (!late) request.free();
    return done || late;
  }
  if (late) give_up(request);
  return false;
}

template <typename Master>
void AskedBus<Master>::give_up(Request& request) {
  if (request.state == State::waits) --waiting_;
  request.state = State::failed;
  master_.let_go();
  is_first_ = false;
  end(State::failed);
}

// Words first: the core reads and writes them at any address.
template <typename Master>
[[gnu::always_inline]] inline void AskedBus<Master>::copy(const std::byte* from, std::byte* to,
                                                          std::size_t bytes) {
  for (; bytes >= sizeof(Word); bytes -= sizeof(Word)) {
    std::memcpy(to, from, sizeof(Word));
    from += sizeof(Word);
    to += sizeof(Word);
  }
  for (; bytes != 0; --bytes)
    *to++ = *from++;
}

// The one that was asked first. There is one.
template <typename Master>
typename AskedBus<Master>::Request& AskedBus<Master>::take_next() {
  Request* first = nullptr;
  for (Request& request : used())
    if (request.state == State::waits && (first == nullptr || request.turn < first->turn))
      first = &request;
  --waiting_;
  return *first;
}

template <typename Master>
void AskedBus<Master>::fail_waiting() {
  for (Request& request : used())
    if (request.state == State::waits) request.state = State::failed;
  waiting_ = 0;
}

template <typename Master>
void AskedBus<Master>::begin(Request& request) {
  held_ = !free_lines();
  if (held_) [[unlikely]] {
    request.state = State::failed;
    return fail_waiting();
  }
  request.state = State::runs;
  running_ = &request;
  if (request.shape.first != 0) return send_first(request);
  send_other(request);
}

template <typename Master>
void AskedBus<Master>::send_first(Request& request) {
  is_first_ = true;
  const Shape& all = request.shape;
  send(&request.bytes[Request::kFirst], request.in(),
       shape_of(all.address, 0, all.first % kRead, all.first / kRead));
}

template <typename Master>
void AskedBus<Master>::send_other(Request& request) {
  const Shape& all = request.shape;
  const unsigned there = all.first / kRead;
  send(&request.bytes[Request::kOut], request.in() + there,
       shape_of(all.address, 0, all.written, all.read - there));
}

// The master reads it from memory.
template <typename Master>
void AskedBus<Master>::send(const std::byte* out, std::byte* in, Word shape) {
  asm volatile("" ::: "memory");
  master_.begin(static_cast<std::uint8_t>(shape), {out, written_of(shape)}, {in, shape >> 24});
}

// Only code that masks this interrupt shares anything with it.
template <typename Master>
void AskedBus<Master>::on_interrupt() {
  const Transfer state = master_.on_interrupt();
  if (state == Transfer::goes_on || running_ == nullptr) return;
  asm volatile("" ::: "memory");  // the master has written to memory
  if (is_first_) {
    is_first_ = false;
    if (state == Transfer::done) return send_other(*running_);
  }
  end(state == Transfer::done ? State::done : State::failed);
}

// Waiting requests do not fail with this one. Nobody collects the result of a plain write, so its place becomes free for
// others.
template <typename Master>
void AskedBus<Master>::end(State how) {
  Request& ended = *running_;
  running_ = nullptr;
  ended.state = how;
  if (ended.shape.read == 0 && !ended.ahead) ended.free();
  if (waiting_ != 0) begin(take_next());
}

template <typename Master>
[[gnu::always_inline]] inline bool AskedBus<Master>::free_lines() {
  return master_.are_high() || clear_lines();
}

// A device that was interrupted in the middle of a byte releases the data line at the end of the byte.
template <typename Master>
bool AskedBus<Master>::clear_lines() {
  if (!master_.clock_is_high()) return false;
  clears_ = static_cast<std::uint16_t>(clears_ + !held_);
  master_.take_clock();
  clock_out();
  master_.give_clock_back();
  return master_.are_high();
}

template <typename Master>
void AskedBus<Master>::clock_out() {
  for (unsigned i = 0; i < kMostClocks && !master_.data_is_high(); ++i) {
    master_.drive_clock(false);
    master_.half_bit();
    master_.drive_clock(true);
    master_.half_bit();
    if (!master_.clock_is_high()) return;
  }
}

}  // namespace robosync::boards
