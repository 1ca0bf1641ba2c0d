// An I2C bus whose master has DMA. The processor starts a transfer and an interrupt reports its end, so no thread waits.
// Transfers are therefore asked ahead (boards::Board::i2c_ask()). They are queued as requests and run one after the other, in
// the order in which they were asked. A request may begin by selecting a page, in its own transfer (select()); no other request
// comes between the two.
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
//   clock_is_high(), data_is_high()
//   take_clock(), give_clock_back()   the master is off in between, and drive_clock(high) sets the line
//   half_bit()               waits for some 1.5 us
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
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
  // As in boards::Board; `ahead` is the last argument of i2c_ask(). A transfer too long for a request fails.
  //  [one thread at a time]
  bool select(std::span<const std::byte> page);
  bool transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                std::span<std::byte> in);
  bool is_busy() const { return running_ != nullptr; }
  BusState state() const { return {clears_, static_cast<std::uint8_t>(held_)}; }
  // [its interrupt]
  void on_interrupt();

  // More than fit into the time (policy::kBusWindowUs).
  static constexpr std::size_t kMostRequests = 20;

private:
  static constexpr std::size_t kMostWritten = 19;  // part of a display's picture
  static constexpr std::size_t kMostRead = 16;
  static constexpr unsigned kMostClocks = 9;  // a byte and its acknowledge bit

  // The master's DMA reads and writes these, so they do not move.
  struct Request {
    enum class State : std::uint8_t { none, waits, runs, done, failed };
    State state = State::none;
    bool ahead = false;
    std::uint8_t address = 0, selected = 0, written = 0, read = 0;
    std::uint32_t turn = 0;
    std::array<std::byte, kMostSelected> page{};
    std::array<std::byte, kMostWritten> out{};
    std::array<std::byte, kMostRead> in{};

    bool under_way() const { return state == State::waits || state == State::runs; }
  };
  using State = typename Request::State;

  std::span<Request> used() { return std::span(requests_).first(used_); }
  Request* find(std::uint8_t address, std::span<const std::byte> out, std::size_t read);
  Request* place();
  bool ask(Request* request, bool ahead, std::uint8_t address, std::span<const std::byte> out,
           std::size_t read);
  bool collect(Request& request, std::span<std::byte> in);
  Request* next();
  void go_on();
  void begin(Request& request);
  void send(Request& request);
  void end(State how);
  bool free_lines();
  void clock_out();

  Master master_;
  std::array<Request, kMostRequests> requests_{};
  std::size_t used_ = 0;  // requests, from the first on
  Request* running_ = nullptr;
  bool selecting_ = false;  // running_ is selecting its page
  std::array<std::byte, kMostSelected> page_{};
  std::uint8_t selected_ = 0;  // bytes of page_, for the next transfer
  std::uint32_t turn_ = 0;
  std::uint16_t clears_ = 0;
  bool held_ = false;
};

template <typename Master>
bool AskedBus<Master>::select(std::span<const std::byte> page) {
  if (page.size() > kMostSelected) return false;
  std::copy_n(page.begin(), page.size(), page_.begin());
  selected_ = static_cast<std::uint8_t>(page.size());
  return true;
}

// A write that was not asked ahead is sent, too, each time.
template <typename Master>
bool AskedBus<Master>::transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                                std::span<std::byte> in) {
  bool done = false;
  if (out.size() <= kMostWritten && in.size() <= kMostRead && !out.empty()) {
    const port::Alone alone;
    Request* const request = find(address, out, in.size());
    if (ahead || (in.empty() && (request == nullptr || !request->ahead)))
      done = ask(request, ahead, address, out, in.size());
    else
      done = request != nullptr && collect(*request, in);
  }
  selected_ = 0;
  return done;
}

template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::find(std::uint8_t address,
                                                           std::span<const std::byte> out,
                                                           std::size_t read) {
  const auto page = std::span(page_).first(selected_);
  for (Request& request : used())
    if (request.state != State::none && request.address == address && request.read == read &&
        std::ranges::equal(out, std::span(request.out).first(request.written)) &&
        std::ranges::equal(page, std::span(request.page).first(request.selected)))
      return &request;
  return nullptr;
}

// The request that has not been asked for the longest time gives up its place.
template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::place() {
  Request* oldest = nullptr;
  for (Request& request : used()) {
    if (request.state == State::none) return &request;
    if (!request.under_way() && (oldest == nullptr || request.turn < oldest->turn))
      oldest = &request;
  }
  return used_ < requests_.size() ? &requests_[used_++] : oldest;
}

// Two callers that want the same transfer share one request.
template <typename Master>
bool AskedBus<Master>::ask(Request* request, bool ahead, std::uint8_t address,
                           std::span<const std::byte> out, std::size_t read) {
  const bool nothing_to_read = read == 0;
  if (request != nullptr && request->under_way()) return nothing_to_read;
  if (request == nullptr) request = place();
  if (request == nullptr) return false;
  request->ahead = ahead;
  request->address = address;
  request->selected = selected_;
  request->page = page_;
  request->written = static_cast<std::uint8_t>(out.size());
  request->read = static_cast<std::uint8_t>(read);
  request->turn = ++turn_;
  std::copy_n(out.begin(), out.size(), request->out.begin());
  request->state = State::waits;
  go_on();
  return nothing_to_read;
}

// A read's result can be collected again until the read is asked ahead anew; a write's result only once. Nobody waits for the
// end of a write. If a read is late, the running transfer is given up, even if it belongs to another request.
template <typename Master>
bool AskedBus<Master>::collect(Request& request, std::span<std::byte> in) {
  const bool done = request.state == State::done;
  const bool late = request.under_way();
  if (late && in.empty()) return true;
  if (!done || in.empty()) request.state = State::none;
  if (late) {
    master_.let_go();
    end(State::failed);
  }
  if (done) std::copy_n(request.in.begin(), in.size(), in.begin());
  return done;
}

template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::next() {
  Request* first = nullptr;
  for (Request& request : used())
    if (request.state == State::waits && (first == nullptr || request.turn < first->turn))
      first = &request;
  return first;
}

template <typename Master>
void AskedBus<Master>::go_on() {
  if (running_ != nullptr) return;
  Request* request = next();
  if (request == nullptr) return;
  held_ = !free_lines();
  if (!held_) return begin(*request);
  for (; request != nullptr; request = next())
    request->state = State::failed;
}

template <typename Master>
void AskedBus<Master>::begin(Request& request) {
  request.state = State::runs;
  running_ = &request;
  selecting_ = request.selected != 0;
  send(request);
}

// Sends the page, or the bytes after it. Inlined, because a sensor's thread has no stack to spare for another frame.
template <typename Master>
[[gnu::always_inline]] inline void AskedBus<Master>::send(Request& request) {
  const std::byte* const out = selecting_ ? request.page.data() : request.out.data();
  asm volatile("" ::: "memory");  // the master reads it from memory
  master_.begin(request.address, std::span(out, selecting_ ? request.selected : request.written),
                std::span(request.in).first(selecting_ ? 0U : request.read));
}

template <typename Master>
void AskedBus<Master>::on_interrupt() {
  const port::Alone alone;
  const Transfer state = master_.on_interrupt();
  if (state == Transfer::goes_on || running_ == nullptr) return;
  asm volatile("" ::: "memory");  // the master has written to memory
  if (std::exchange(selecting_, false) && state == Transfer::done) return send(*running_);
  end(state == Transfer::done ? State::done : State::failed);
}

// Waiting requests do not fail with this one. Nobody collects the result of a plain write, so its place becomes free for
// others.
template <typename Master>
void AskedBus<Master>::end(State how) {
  const bool is_asked_for = running_->read != 0 || running_->ahead;
  running_->state = is_asked_for ? how : State::none;
  running_ = nullptr;
  go_on();
}

// A device that was interrupted in the middle of a byte releases the data line at the end of the byte.
template <typename Master>
bool AskedBus<Master>::free_lines() {
  if (!master_.clock_is_high()) return false;
  if (master_.data_is_high()) return true;
  clears_ = static_cast<std::uint16_t>(clears_ + !held_);
  master_.take_clock();
  clock_out();
  master_.give_clock_back();
  return master_.clock_is_high() && master_.data_is_high();
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

// For all buses of a board; the first one has number 0.
template <typename Buses>
bool is_any_busy(const Buses& buses) {
  return std::ranges::any_of(buses, [](const auto& bus) { return bus.is_busy(); });
}

template <typename Buses>
BusState state_of(const Buses& buses) {
  BusState all;
  for (std::size_t bus = 0; bus < buses.size(); ++bus) {
    const BusState one = buses[bus].state();
    all.clears = static_cast<std::uint16_t>(all.clears + one.clears);
    all.held = static_cast<std::uint8_t>(all.held | one.held << bus);
  }
  return all;
}

}  // namespace robosync::boards
