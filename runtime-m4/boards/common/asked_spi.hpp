// An SPI bus whose master has DMA: as asked_bus.hpp, for transfers that write one byte and read one or two (vm::kMostSpiBytes).
// They are asked ahead, and run one after the other in the background; an interrupt reports the end of each. A part cannot hold
// the lines, so a transfer ends in time unless the hardware fails: one that is not over when its answer is due is given up.
//
// Master implements the hardware's part, in static functions:
//   open(), close()          it has its pins in between
//   begin(out, in)           sends `out`, and receives as many bytes; neither moves during the transfer
//   on_interrupt()           returns the transfer's state
//   let_go()                 aborts any transfer, and is ready for the next one
//   begin_select(pin), end_select(pin)   in between it is the select pin of a part: select(pin, on) sets it low (on) or high. The
//                                        pin at an enable input is always high otherwise
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/transfer.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"
#include "vm/drivers.hpp"

namespace robosync::boards {

template <typename Master>
class AskedSpi {
public:
  // For a part with this select pin, of 0 to 63.
  void open(std::uint16_t select);
  // Forgets all requests, and gives the pins back.
  void close();
  // As in boards::Board; `ahead` is the last argument of ask_buses(). False while the bus is closed.  [one thread at a time]
  bool transfer(bool ahead, std::uint16_t select, std::span<const std::byte> out,
                std::span<std::byte> in);
  bool is_busy() const { return running_ != nullptr; }
  // [its interrupt]
  void on_interrupt();

  static constexpr std::size_t kMostRequests = 32;  // a program has no more channels

private:
  static constexpr std::size_t kMostRead = vm::kMostSpiBytes - 1;

  using State = RequestState;
  struct Request {
    State state : 4;
    std::uint8_t read : 4;
    std::uint8_t select, command;
    std::array<std::byte, kMostRead> in;

    bool under_way() const { return is_under_way(state); }
  };
  static_assert(sizeof(Request) == 5, "a board's RAM outside of its arena is small");

  Request* find(std::uint8_t select, std::uint8_t command, std::size_t read);
  void ask(std::uint8_t select, std::uint8_t command, std::size_t read);
  bool collect(Request& request, std::span<std::byte> in);
  void begin(Request& request);
  void end(State how);
  void go_on(std::size_t from);
  Request* find_waiting(std::size_t from, std::size_t end);

  std::uint64_t selects_ = 0;  // bit p: pin p
  bool open_ = false;
  std::uint8_t used_ = 0;  // requests, from the first on
  Request* running_ = nullptr;
  std::array<Request, kMostRequests> requests_{};
  // The master's DMA reads and writes these. What is sent after the command is 0.
  std::array<std::byte, vm::kMostSpiBytes> out_{}, in_{};
};

template <typename Master>
void AskedSpi<Master>::open(std::uint16_t select) {
  Master::begin_select(select);
  selects_ |= std::uint64_t{1} << select;
  if (open_) return;
  Master::open();
  open_ = true;
}

template <typename Master>
void AskedSpi<Master>::close() {
  const port::Alone alone;
  if (!open_) return;
  if (running_ != nullptr) {
    Master::let_go();
    Master::select(running_->select, false);
  }
  running_ = nullptr;
  used_ = 0;
  open_ = false;
  Master::close();
  for (std::uint16_t pin = 0; selects_ != 0; ++pin, selects_ >>= 1)
    if ((selects_ & 1) != 0) Master::end_select(pin);
}

template <typename Master>
bool AskedSpi<Master>::transfer(bool ahead, std::uint16_t select, std::span<const std::byte> out,
                                std::span<std::byte> in) {
  if (out.size() != 1 || in.empty() || in.size() > kMostRead || select > UINT8_MAX) return false;
  const auto pin = static_cast<std::uint8_t>(select);
  const auto command = std::to_integer<std::uint8_t>(out[0]);
  const port::Alone alone;
  if (!open_) return false;
  if (ahead) {
    ask(pin, command, in.size());
    return false;
  }
  Request* const request = find(pin, command, in.size());
  return request != nullptr && collect(*request, in);
}

template <typename Master>
typename AskedSpi<Master>::Request* AskedSpi<Master>::find(std::uint8_t select,
                                                           std::uint8_t command, std::size_t read) {
  for (Request& request : std::span(requests_).first(used_))
    if (request.select == select && request.command == command && request.read == read)
      return &request;
  return nullptr;
}

// Two channels that want the same transfer share one request, also if it runs.
template <typename Master>
void AskedSpi<Master>::ask(std::uint8_t select, std::uint8_t command, std::size_t read) {
  Request* request = find(select, command, read);
  if (request == nullptr) {
    if (used_ == requests_.size()) return;
    request = &requests_[used_++];
    request->state = State::failed;
    request->read = static_cast<std::uint8_t>(read & 0xF);
    request->select = select;
    request->command = command;
  }
  request->state = State::waits;
  go_on(0);
}

// A result can be collected again until it is asked for anew. If it is late, the running transfer is given up, even if it belongs
// to another request.
template <typename Master>
bool AskedSpi<Master>::collect(Request& request, std::span<std::byte> in) {
  if (request.under_way()) {
    request.state = State::failed;
    Master::let_go();
    end(State::failed);
  }
  if (request.state != State::done) return false;
  std::copy_n(request.in.begin(), in.size(), in.begin());
  return true;
}

// Inlined, because a sensor's thread has no stack to spare for another frame.
template <typename Master>
[[gnu::always_inline]] inline void AskedSpi<Master>::begin(Request& request) {
  request.state = State::runs;
  running_ = &request;
  out_[0] = std::byte{request.command};
  Master::select(request.select, true);
  asm volatile("" ::: "memory");  // the master reads it from memory
  const std::size_t bytes = 1U + request.read;
  Master::begin(std::span(out_).first(bytes), std::span(in_).first(bytes));
}

template <typename Master>
void AskedSpi<Master>::on_interrupt() {
  const port::Alone alone;
  const Transfer state = Master::on_interrupt();
  if (state == Transfer::goes_on || running_ == nullptr) return;
  asm volatile("" ::: "memory");  // the master has written to memory
  std::copy_n(in_.begin() + 1, kMostRead, running_->in.begin());
  end(state == Transfer::done ? State::done : State::failed);
}

// Requests that wait do not fail with this one.
template <typename Master>
void AskedSpi<Master>::end(State how) {
  Request& ended = *running_;
  Master::select(ended.select, false);
  ended.state = how;
  running_ = nullptr;
  go_on(static_cast<std::size_t>(&ended - requests_.data()) + 1);
}

// The next request in the order of their places, from that one on and round again, so that none waits for ever.
template <typename Master>
void AskedSpi<Master>::go_on(std::size_t from) {
  if (running_ != nullptr) return;
  Request* next = find_waiting(from, used_);
  if (next == nullptr) next = find_waiting(0, from);
  if (next != nullptr) begin(*next);
}

template <typename Master>
typename AskedSpi<Master>::Request* AskedSpi<Master>::find_waiting(std::size_t from,
                                                                   std::size_t end) {
  for (Request& request : std::span(requests_).first(end).subspan(from))
    if (request.state == State::waits) return &request;
  return nullptr;
}

}  // namespace robosync::boards
