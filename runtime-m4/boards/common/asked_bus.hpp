// An I2C bus whose master works by itself, by DMA or interrupts, and reports the end of a transfer, so no thread waits for one.
// Transfers are therefore asked ahead (boards::Board::ask_buses()). They are queued as requests (bus_requests.hpp) and run one after
// the other, in the order in which they were asked. A request may have a first transfer, which selects a page (select()) or reads other
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

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/bus_lines.hpp"
#include "runtime-m4/boards/common/bus_requests.hpp"
#include "runtime-m4/boards/common/transfer.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"

namespace robosync::boards {

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
  // For somebody who uses the lines besides, while is_busy() is false: frees them as before a transfer. False: one stays low.
  bool free() {
    const port::Alone alone;
    if (running_ == nullptr) held_ = !free_lines();
    return !held_;
  }
  Master& master() { return master_; }
  // [its interrupt]
  void on_interrupt();

  static constexpr std::size_t kMostRequests = BusRequests::kMost;

private:
  using Request = BusRequest;
  using Word = Request::Word;
  using Shape = Request::Shape;
  using State = RequestState;

  // Not inlined: in one function they need more registers than there are.
  [[gnu::noinline]] void ask(Request& request, bool ahead);
  [[gnu::noinline]] bool collect(Request& request, std::byte* in);
  [[gnu::cold]] void give_up(Request& request);
  [[gnu::cold]] void fail_waiting();
  void begin(Request& request);
  void send_first(Request& request);
  void send_other(Request& request);
  [[gnu::noinline]] void send(const std::byte* out, std::byte* in, Word shape);
  void end(State how);
  bool free_lines();
  [[gnu::cold]] bool clear();

  BusRequests requests_;
  Master master_;
  Request* running_ = nullptr;
  std::uint32_t turn_ = 0;
  Word page_ = 0;  // for the next transfer: as in `head`, and in the lowest byte how long it is
  bool is_first_ = false;     // running_ is in its first transfer
  std::uint8_t waiting_ = 0;  // requests; none without a running one
  std::uint16_t clears_ = 0;
  bool held_ = false;
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
  if (out.size() + in.size() > Request::kMostBytes || out.empty()) return false;
  const Word shape = Request::shape_of(address, page & 0xFF, out.size(), in.size());
  const Word head = (page & ~Word{0xFF}) | std::to_integer<Word>(out[0]) << 8 * Request::kOut;
  port::Alone alone;
  Request* request = requests_.find(shape, head, out.data());
  if (ahead || (in.empty() && (request == nullptr || !request->ahead))) {
    if (request == nullptr) request = requests_.place(shape, head, out.data());
    if (request != nullptr) ask(*request, ahead);
    return request != nullptr && in.empty();
  }
  return request != nullptr && collect(*request, in.data());
}

template <typename Master>
bool AskedBus<Master>::read_two(bool ahead, std::uint8_t address, TwoBlocks blocks,
                                std::span<std::byte> in) {
  if (1 + in.size() > Request::kMostBytes || blocks.split >= in.size()) return false;
  const Word shape = Request::shape_of(address, 1 + Request::kRead * blocks.split, 1, in.size());
  const Word head = std::to_integer<Word>(blocks.first) << 8 * Request::kFirst |
                    std::to_integer<Word>(blocks.second) << 8 * Request::kOut;
  port::Alone alone;
  Request* request = requests_.find(shape, head, nullptr);
  if (!ahead) return request != nullptr && collect(*request, in.data());
  if (request == nullptr) request = requests_.place(shape, head, nullptr);
  if (request != nullptr) ask(*request, ahead);
  return false;
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
    copy_words(request.in(), in, bytes);
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

template <typename Master>
void AskedBus<Master>::fail_waiting() {
  requests_.fail_waiting();
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
       Request::shape_of(all.address, 0, all.first % Request::kRead, all.first / Request::kRead));
}

template <typename Master>
void AskedBus<Master>::send_other(Request& request) {
  const Shape& all = request.shape;
  const unsigned there = all.first / Request::kRead;
  send(&request.bytes[Request::kOut], request.in() + there,
       Request::shape_of(all.address, 0, all.written, all.read - there));
}

// The master reads it from memory.
template <typename Master>
void AskedBus<Master>::send(const std::byte* out, std::byte* in, Word shape) {
  asm volatile("" ::: "memory");
  master_.begin(static_cast<std::uint8_t>(shape), {out, Request::written_of(shape)},
                {in, shape >> 24});
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
  if (waiting_ == 0) return;
  --waiting_;
  begin(requests_.first_waiting());
}

template <typename Master>
[[gnu::always_inline]] inline bool AskedBus<Master>::free_lines() {
  return master_.are_high() || clear();
}

template <typename Master>
bool AskedBus<Master>::clear() {
  if (!master_.clock_is_high()) return false;
  clears_ = static_cast<std::uint16_t>(clears_ + !held_);
  return clear_lines(master_);
}

}  // namespace robosync::boards
