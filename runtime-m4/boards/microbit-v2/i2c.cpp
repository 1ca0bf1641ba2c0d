// See i2c.hpp. What is wanted stands in requests, which run one after the other, in the order in which they were asked.
#include "runtime-m4/boards/microbit-v2/i2c.hpp"

#include <algorithm>

namespace robosync::boards::microbit {

namespace {

constexpr unsigned kMostClocks = 9;  // a byte, and its acknowledgement
constexpr unsigned kHalfBit = 24;    // turns of a loop of four cycles: 1.5 us

bool is_high(const Pin& pin) {
  return pin.levels().has(pin.mask());
}

void half_bit() {
  for (unsigned turns = kHalfBit; turns != 0; --turns)
    asm volatile("nop");
}

}  // namespace

void I2c::start() {
  for (const Pin& line : {lines_.clock, lines_.data}) {
    line.set_high().write(line.mask());
    line.configuration().write(Pin::kBusLine);
  }
  master_.clock_pin().write(lines_.clock.number());
  master_.data_pin().write(lines_.data.number());
  master_.frequency().write(Twim::k390kHz);
  master_.interrupt_on().write(Twim::kWhenStopped | Twim::kWhenWrong);
  master_.enable().write(Twim::kOn);
}

bool I2c::transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                   std::span<std::byte> in) {
  if (out.size() > kMostWritten || in.size() > kMostRead || out.empty()) return false;
  const port::Alone alone;
  Request* const request = find(address, out, in.size());
  // What is written without being asked for ahead goes out as well.
  if (ahead || (request == nullptr && in.empty())) return ask(request, address, out, in.size());
  return request != nullptr && collect(*request, in);
}

I2c::Request* I2c::find(std::uint8_t address, std::span<const std::byte> out, std::size_t read) {
  for (Request& request : requests_)
    if (request.state != Request::State::none && request.address == address &&
        request.read == read && request.written == out.size() &&
        std::ranges::equal(out, std::span(request.out).first(out.size())))
      return &request;
  return nullptr;
}

// What nobody has asked about for the longest time gives way.
I2c::Request* I2c::place() {
  Request* oldest = nullptr;
  for (Request& request : requests_) {
    if (request.state == Request::State::none) return &request;
    if (!request.under_way() && (oldest == nullptr || request.turn < oldest->turn))
      oldest = &request;
  }
  return oldest;
}

// Two that want the same get it together.
bool I2c::ask(Request* request, std::uint8_t address, std::span<const std::byte> out,
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
  request->state = Request::State::waits;
  go_on();
  return nothing_to_read;
}

// What was read may be asked for again until it is asked ahead anew; what was written is over. Nobody waits for the end of
// what is only written; where something is to be read and is late, the one that runs is in the way, be it another.
bool I2c::collect(Request& request, std::span<std::byte> in) {
  const bool done = request.state == Request::State::done;
  const bool late = request.under_way();
  if (late && in.empty()) return true;
  if (!done || in.empty()) request.state = Request::State::none;
  if (late) give_up();
  if (done) std::copy_n(request.in.begin(), in.size(), in.begin());
  return done;
}

I2c::Request* I2c::next() {
  Request* first = nullptr;
  for (Request& request : requests_)
    if (request.state == Request::State::waits && (first == nullptr || request.turn < first->turn))
      first = &request;
  return first;
}

void I2c::go_on() {
  if (running_ != nullptr) return;
  Request* request = next();
  if (request == nullptr) return;
  held_ = !free_lines();
  if (!held_) return begin(*request);
  for (; request != nullptr; request = next())
    request->state = Request::State::failed;
}

void I2c::begin(Request& request) {
  request.state = Request::State::runs;
  running_ = &request;
  wrong_ = false;
  master_.address().write(request.address);
  master_.write_from().write(port::bus_address(request.out.data()));
  master_.write_count().write(request.written);
  master_.read_to().write(port::bus_address(request.in.data()));
  master_.read_count().write(request.read);
  master_.shortcuts().write(request.read == 0 ? Twim::kStopWhenWritten
                                              : Twim::kReadWhenWritten | Twim::kStopWhenRead);
  asm volatile("" ::: "memory");  // the master reads it from there
  master_.start_writing().write(kDoIt);
}

void I2c::on_end() {
  const port::Alone alone;
  if (master_.error().read() != 0) {
    forget(master_.error());
    master_.errors().write(Twim::kAllErrors);
    wrong_ = true;
    master_.stop().write(kDoIt);
  }
  if (master_.stopped().read() == 0) return;
  forget(master_.stopped());
  if (running_ == nullptr) return;
  running_->state = wrong_ ? Request::State::failed : Request::State::done;
  running_ = nullptr;
  go_on();
}

// A master that is off lets its pins go, whatever it was about; those that wait are not the ones to blame.
void I2c::give_up() {
  master_.enable().write(0);
  forget(master_.error());
  forget(master_.stopped());
  running_->state = Request::State::failed;
  running_ = nullptr;
  master_.enable().write(Twim::kOn);
  go_on();
}

// A device that was interrupted in the midst of a byte lets go of the data line when the byte is over.
bool I2c::free_lines() {
  if (!is_high(lines_.clock)) return false;
  if (is_high(lines_.data)) return true;
  clears_ = static_cast<std::uint16_t>(clears_ + !held_);
  master_.enable().write(0);
  lines_.clock.configuration().write(Pin::kDrivenBusLine);
  clock_out();
  lines_.clock.configuration().write(Pin::kBusLine);
  master_.enable().write(Twim::kOn);
  return is_high(lines_.clock) && is_high(lines_.data);
}

void I2c::clock_out() {
  for (unsigned i = 0; i < kMostClocks && !is_high(lines_.data); ++i) {
    lines_.clock.set_low().write(lines_.clock.mask());
    half_bit();
    lines_.clock.set_high().write(lines_.clock.mask());
    half_bit();
    if (!is_high(lines_.clock)) return;
  }
}

}  // namespace robosync::boards::microbit
