// See i2c.hpp. Nordic's nRF52833 Product Specification, 6.30 (TWIM).
#include "runtime-m4/boards/microbit-v2/i2c.hpp"

namespace robosync::boards::microbit {

namespace {

constexpr unsigned kHalfBit = 24;  // iterations of a loop of four cycles: 1.5 us

}  // namespace

void TwimMaster::start() const {
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

void TwimMaster::begin(std::uint8_t address, std::span<const std::byte> out,
                       std::span<std::byte> in) {
  wrong_ = false;
  to_write_ = static_cast<std::uint32_t>(out.size());
  to_read_ = static_cast<std::uint32_t>(in.size());
  master_.address().write(address);
  master_.write_from().write(port::bus_address(out.data()));
  master_.write_count().write(to_write_);
  master_.read_to().write(port::bus_address(in.data()));
  master_.read_count().write(to_read_);
  master_.shortcuts().write(in.empty() ? Twim::kStopWhenWritten
                                       : Twim::kReadWhenWritten | Twim::kStopWhenRead);
  master_.start_writing().write(kDoIt);
}

Transfer TwimMaster::on_interrupt() {
  if (master_.error().read() != 0) {
    forget(master_.error());
    master_.errors().write(Twim::kAllErrors);
    wrong_ = true;
    master_.stop().write(kDoIt);
  }
  if (master_.stopped().read() == 0) return Transfer::goes_on;
  forget(master_.stopped());
  if (wrong_) return Transfer::failed;
  if (is_whole()) return Transfer::done;
  let_go();
  return Transfer::failed;
}

// A stop that comes from the lines, a disturbance or a device that breaks the rules, ends a transfer without an error. Then the
// master has to be switched off and on (Nordic's nrfx, xfer_completeness_check()).
bool TwimMaster::is_whole() const {
  return master_.bytes_written().read() == to_write_ &&
         (to_read_ == 0 || master_.bytes_read().read() == to_read_);
}

// Switching the master off aborts any transfer and releases its pins.
void TwimMaster::let_go() const {
  master_.enable().write(0);
  forget(master_.error());
  forget(master_.stopped());
  master_.enable().write(Twim::kOn);
}

void TwimMaster::take_clock() const {
  master_.enable().write(0);
  lines_.clock.configuration().write(Pin::kDrivenBusLine);
}

void TwimMaster::give_clock_back() const {
  lines_.clock.configuration().write(Pin::kBusLine);
  master_.enable().write(Twim::kOn);
}

void TwimMaster::drive_clock(bool high) const {
  (high ? lines_.clock.set_high() : lines_.clock.set_low()).write(lines_.clock.mask());
}

void TwimMaster::half_bit() {
  for (unsigned turns = kHalfBit; turns != 0; --turns)
    asm volatile("nop");
}

}  // namespace robosync::boards::microbit
