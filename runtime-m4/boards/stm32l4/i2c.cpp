// See i2c.hpp. ST's RM0351, 39.4 (I2C) and 11 (DMA): a transfer follows the steps of 39.4.8 and 39.4.16.
#include "runtime-m4/boards/stm32l4/i2c.hpp"

namespace robosync::boards::stm32l4 {

namespace {

constexpr unsigned kHalfBit = 30;  // iterations of a loop of four cycles: 1.5 us

void set_up(const DmaChannel& channel, Register data) {
  kDmaSelect.set_field(channel.number - 1, 4, kDmaForI2c);
  channel.peripheral().write(static_cast<std::uint32_t>(data.address));
}

// Inlined, because a sensor's thread has no stack to spare for another frame.
[[gnu::always_inline]] inline void move(const DmaChannel& channel, std::uint32_t memory,
                                        std::size_t bytes, std::uint32_t direction) {
  channel.memory().write(memory);
  channel.count().write(static_cast<std::uint32_t>(bytes));
  channel.control().write(direction | DmaChannel::kOn);
}

}  // namespace

// The lines come last: an idle master does not drive them.
void I2cMaster::start() const {
  rcc::give_clock(rcc::kAhb1, rcc::kDma1);
  rcc::give_clock(rcc::kApb1, wires_.master.clock);
  set_up(wires_.to_send, wires_.master.send());
  set_up(wires_.to_memory, wires_.master.received());
  wires_.master.timing().write(I2cRegisters::kAlmost400kHz);
  wires_.master.control().write(I2cRegisters::kOn);
  for (const unsigned line : {wires_.clock, wires_.data}) {
    kPortOfI2c.change().write(1U << line);
    kPortOfI2c.open().set(1U << line);
    kPortOfI2c.pulls().set_field(line, 2, kPullUp);
    kPortOfI2c.function(line).set_field(line % 8, 4, kFunctionOfI2c);
    kPortOfI2c.mode().set_field(line, 2, kModeOfFunction);
  }
}

void I2cMaster::begin(std::uint8_t address, std::span<const std::byte> out,
                      std::span<std::byte> in) {
  wrong_ = false;
  reading_ = in.empty() ? 0
                        : I2cRegisters::to(address, in.size()) | I2cRegisters::kRead |
                              I2cRegisters::kStart | I2cRegisters::kStopBehind;
  move(wires_.to_send, port::bus_address(out.data()), out.size(), DmaChannel::kBytesFromMemory);
  if (!in.empty())
    move(wires_.to_memory, port::bus_address(in.data()), in.size(), DmaChannel::kBytesToMemory);
  wires_.master.transfer().write(I2cRegisters::to(address, out.size()) | I2cRegisters::kStart |
                                 (in.empty() ? I2cRegisters::kStopBehind : 0));
}

// After a NACK the master sends the stop on its own, but still holds a byte, which must not become the first one of the next
// transfer. After lost arbitration there is nothing to stop. ES0250: a bus error means nothing for a master.
Transfer I2cMaster::on_interrupt() {
  const std::uint32_t state = wires_.master.state().read();
  if ((state & I2cRegisters::kWritten) != 0) wires_.master.transfer().write(reading_);
  constexpr std::uint32_t kNoted =
      I2cRegisters::kRefused | I2cRegisters::kStopped | I2cRegisters::kBusError;
  if ((state & (kNoted | I2cRegisters::kOutvoted)) == 0) return Transfer::goes_on;
  wires_.master.forget().write(state & kNoted);
  if ((state & (I2cRegisters::kRefused | I2cRegisters::kOutvoted)) != 0) wrong_ = true;
  if ((state & (I2cRegisters::kStopped | I2cRegisters::kOutvoted)) == 0) return Transfer::goes_on;
  if (wrong_ || (reading_ != 0 && wires_.to_memory.count().read() != 0)) [[unlikely]] {
    let_go();
    return Transfer::failed;
  }
  wires_.to_send.control().write(0);
  wires_.to_memory.control().write(0);
  return Transfer::done;
}

// The master must be off for at least three bus clock cycles, which the read takes. That aborts the transfer and frees the lines.
// A channel of the DMA that has failed stays off until its flags are cleared.
void I2cMaster::switch_off() const {
  wires_.to_send.control().write(0);
  wires_.to_memory.control().write(0);
  kDmaForget.write(wires_.to_send.flags() | wires_.to_memory.flags());
  wires_.master.control().write(0);
  static_cast<void>(wires_.master.control().read());
}

void I2cMaster::let_go() const {
  switch_off();
  wires_.master.control().write(I2cRegisters::kOn);
}

void I2cMaster::take_clock() const {
  switch_off();
  kPortOfI2c.mode().set_field(wires_.clock, 2, kModeOfOutput);
}

void I2cMaster::give_clock_back() const {
  kPortOfI2c.mode().set_field(wires_.clock, 2, kModeOfFunction);
  wires_.master.control().write(I2cRegisters::kOn);
}

void I2cMaster::drive_clock(bool high) const {
  kPortOfI2c.change().write(1U << (high ? wires_.clock : wires_.clock + 16));
}

void I2cMaster::half_bit() {
  for (unsigned turns = kHalfBit; turns != 0; --turns)
    asm volatile("nop");
}

}  // namespace robosync::boards::stm32l4
