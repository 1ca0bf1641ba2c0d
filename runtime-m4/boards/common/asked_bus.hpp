// An I2C bus by a master with memory access of its own. The processor says what is wanted, and is told by an interrupt when it is
// there: nobody waits. So it is asked ahead (boards::Board::i2c_ask()). What is wanted stands in requests, which run one after the
// other, in the order in which they were asked.
//
// Bounded: who is not acknowledged, or does not get the clock, has failed. A transfer that is not over when its answer is due
// is given up, and the bus let go. A data line found held down gets clocks, nine at most, before a transfer; while a line stays
// held down no transfer begins.
//
// Master says how the hardware does it:
//   start()                  once
//   begin(address, out, in)  writes `out`, then reads `in`, if anything; both stay where they are meanwhile
//   on_interrupt()           how that stands
//   let_go()                 whatever it was about, it lets go of its lines, and is ready for the next one
//   clock_is_high(), data_is_high()
//   take_clock(), give_clock_back()   the master is off in between, and drive_clock(high) works the line
//   half_bit()               waits for some 1.5 us
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"

namespace robosync::boards {

enum class Transfer : std::uint8_t { goes_on, done, failed };

template <typename Master>
class AskedBus {
public:
  constexpr explicit AskedBus(Master master) : master_(master) {}

  void start() { master_.start(); }
  // As boards::Board says, with `ahead` as it was asked last. What is longer than a request can be fails.
  //  [one thread at a time]
  bool transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                std::span<std::byte> in);
  bool is_busy() const { return running_ != nullptr; }
  BusState state() const { return {clears_, static_cast<std::uint8_t>(held_)}; }
  // [its interrupt]
  void on_interrupt();

private:
  static constexpr std::size_t kMostWritten = 19;  // a portion of a display's picture
  static constexpr std::size_t kMostRead = 16;
  static constexpr std::size_t kMostRequests = 6;
  static constexpr unsigned kMostClocks = 9;  // a byte, and its acknowledgement

  // The master reads and writes these, so they stay where they are.
  struct Request {
    enum class State : std::uint8_t { none, waits, runs, done, failed };
    State state = State::none;
    std::uint8_t address = 0, written = 0, read = 0;
    std::uint32_t turn = 0;
    std::array<std::byte, kMostWritten> out{};
    std::array<std::byte, kMostRead> in{};

    bool under_way() const { return state == State::waits || state == State::runs; }
  };
  using State = typename Request::State;

  Request* find(std::uint8_t address, std::span<const std::byte> out, std::size_t read);
  Request* place();
  bool ask(Request* request, std::uint8_t address, std::span<const std::byte> out,
           std::size_t read);
  bool collect(Request& request, std::span<std::byte> in);
  Request* next();
  void go_on();
  void begin(Request& request);
  void end(State how);
  bool free_lines();
  void clock_out();

  Master master_;
  std::array<Request, kMostRequests> requests_{};
  Request* running_ = nullptr;
  std::uint32_t turn_ = 0;
  std::uint16_t clears_ = 0;
  bool held_ = false;
};

template <typename Master>
bool AskedBus<Master>::transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                                std::span<std::byte> in) {
  if (out.size() > kMostWritten || in.size() > kMostRead || out.empty()) return false;
  const port::Alone alone;
  Request* const request = find(address, out, in.size());
  // What is written without being asked for ahead goes out as well.
  if (ahead || (request == nullptr && in.empty())) return ask(request, address, out, in.size());
  return request != nullptr && collect(*request, in);
}

template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::find(std::uint8_t address,
                                                           std::span<const std::byte> out,
                                                           std::size_t read) {
  for (Request& request : requests_)
    if (request.state != State::none && request.address == address && request.read == read &&
        request.written == out.size() &&
        std::ranges::equal(out, std::span(request.out).first(out.size())))
      return &request;
  return nullptr;
}

// What nobody has asked about for the longest time gives way.
template <typename Master>
typename AskedBus<Master>::Request* AskedBus<Master>::place() {
  Request* oldest = nullptr;
  for (Request& request : requests_) {
    if (request.state == State::none) return &request;
    if (!request.under_way() && (oldest == nullptr || request.turn < oldest->turn))
      oldest = &request;
  }
  return oldest;
}

// Two that want the same get it together.
template <typename Master>
bool AskedBus<Master>::ask(Request* request, std::uint8_t address, std::span<const std::byte> out,
                           std::size_t read) {
  const bool nothing_to_read = read == 0;
  if (request != nullptr && request->under_way()) return nothing_to_read;
  if (request == nullptr) request = place();
  if (request == nullptr) return false;
  request->address = address;
  request->written = static_cast<std::uint8_t>(out.size());
  request->read = static_cast<std::uint8_t>(read);
  request->turn = ++turn_;
  std::ranges::copy(out, request->out.begin());
  request->state = State::waits;
  go_on();
  return nothing_to_read;
}

// What was read may be asked for again until it is asked ahead anew; what was written is over. Nobody waits for the end of
// what is only written; where something is to be read and is late, the one that runs is in the way, be it another.
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
  for (Request& request : requests_)
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
  asm volatile("" ::: "memory");  // the master reads it from there
  master_.begin(request.address, std::span(request.out).first(request.written),
                std::span(request.in).first(request.read));
}

template <typename Master>
void AskedBus<Master>::on_interrupt() {
  const port::Alone alone;
  const Transfer state = master_.on_interrupt();
  if (state == Transfer::goes_on || running_ == nullptr) return;
  asm volatile("" ::: "memory");  // it has written there
  end(state == Transfer::done ? State::done : State::failed);
}

// Those that wait are not the ones to blame.
template <typename Master>
void AskedBus<Master>::end(State how) {
  running_->state = how;
  running_ = nullptr;
  go_on();
}

// A device that was interrupted in the midst of a byte lets go of the data line when the byte is over.
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

// Of all buses of a board, the first one 0.
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
