// See i2c.hpp. NXP's UM10204: the clock is high for 0.6 us or more, and low for 1.3 us or more.
#include "runtime-m4/boards/mps2-an386/i2c.hpp"

#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"

volatile std::uint32_t robosync_has_work = 0;

namespace robosync::boards::mps2 {

namespace {

constexpr std::uint32_t kTimerCounts = kClockHz / 1'000'000 * 10;
constexpr std::uint16_t kPatience = 400;  // bits: a millisecond or more
constexpr std::uint32_t kReads = 1;       // in the first byte
// Of a frame: what comes after nine bits, the next bit to send, and the acknowledge bit to send.
constexpr std::uint32_t kFull = 1U << 9, kNextBit = 1U << 31, kAcknowledge = 1U << 23;

// Three cycles each time, or four.
[[gnu::always_inline]] inline void wait(unsigned turns) {
#if defined(__arm__)
  asm volatile("1: subs %0, #1\n\tbne 1b" : "+r"(turns) : : "cc");
#else
  static_cast<void>(turns);
#endif
}
constexpr unsigned kHigh = 3;      // 0.4 us, besides what is done meanwhile
constexpr unsigned kStoreLow = 6;  // 0.7 us, besides what is done meanwhile
constexpr unsigned kFree = 11;     // 1.3 us

constexpr port::Register kLines{kI2c0 + kI2cLines};  // written: released
constexpr port::Register kPull{kI2c0 + kI2cPull};
constexpr port::Register kControl{kTimer0 + kTimerControl};
constexpr port::Register kValue{kTimer0 + kTimerValue};
constexpr port::Register kReload{kTimer0 + kTimerReload};
constexpr port::Register kInterrupt{kTimer0 + kTimerInterrupt};
constexpr std::uint32_t kNvicBit = 1U << kTimer0Interrupt;

}  // namespace

[[gnu::always_inline]] inline void LineMaster::pull(std::uint32_t line) {
  kPull.write(line);
}

[[gnu::always_inline]] inline void LineMaster::release(std::uint32_t line) {
  kLines.write(line);
}

bool LineMaster::clock_is_high() {
  return (kLines.read() & kI2cClock) != 0;
}

bool LineMaster::data_is_high() {
  return (kLines.read() & kI2cData) != 0;
}

bool LineMaster::are_high() const {
  constexpr std::uint32_t kBoth = kI2cClock | kI2cData;
  return user_ == User::store || (kLines.read() & kBoth) == kBoth;
}

void LineMaster::drive_clock(bool high) {
  high ? release(kI2cClock) : pull(kI2cClock);
}

void LineMaster::half_bit() {
  wait(kFree);
}

void LineMaster::start() {
  release(kI2cClock | kI2cData);
  kReload.write(kTimerCounts - 1);
}

void LineMaster::prepare(std::uint8_t address, std::span<const std::byte> out,
                         std::span<std::byte> in) {
  out_ = out.data();
  out_end_ = out_ + out.size();
  in_ = in.data();
  in_end_ = in_ + in.size();
  address_ = static_cast<std::uint8_t>(address << 1);
  patience_ = kPatience;
  receives_ = false;
}

void LineMaster::begin(std::uint8_t address, std::span<const std::byte> out,
                       std::span<std::byte> in) {
  const bool taken = user_ == User::store;
  user_ = User::asked;
  prepare(address, out, in);
  if (taken) {
    release(kI2cData);
    next_ = Next::break_off;
  } else {
    send_start();
  }
  kValue.write(kTimerCounts - 1);
  kControl.write(kTimerOn | kTimerInterrupts);
  robosync_has_work = 1;
}

// Both lines are high, and the clock has been for long enough.
Transfer LineMaster::send_start() {
  pull(kI2cData);
  wait(kHigh);
  pull(kI2cClock);
  return send(std::uint32_t{address_} << 24 | kAcknowledge);
}

// The clock is low.
[[gnu::always_inline]] inline Transfer LineMaster::send(std::uint32_t bits) {
  frame_ = bits | 1;
  next_ = Next::bit;
  (bits & kNextBit) != 0 ? release(kI2cData) : pull(kI2cData);
  return Transfer::goes_on;
}

// The last byte is not acknowledged, so the device stops sending.
Transfer LineMaster::receive() {
  receives_ = true;
  return send(0xFFU << 24 | (in_ + 1 == in_end_ ? kAcknowledge : 0));
}

// The clock is low. For a stop, the data line rises while it is high.
Transfer LineMaster::want(Next next) {
  next_ = next;
  next == Next::start ? release(kI2cData) : pull(kI2cData);
  return Transfer::goes_on;
}

Transfer LineMaster::on_interrupt() {
  kInterrupt.write(1);
  return do_bit();
}

// What comes back is what the line shows, also while this side sends. The clock stays low until all is loaded: from one interrupt
// to the next at once that is 1.3 us.
[[gnu::always_inline]] inline Transfer LineMaster::do_bit() {
  std::uint32_t frame = frame_;
  Next next = next_;
  asm volatile("" : "+r"(frame), "+r"(next));
  release(kI2cClock);
  wait(kHigh);
  const std::uint32_t lines = kLines.read();
  if ((lines & kI2cClock) == 0) [[unlikely]]
    return stretched();
  if (next != Next::bit) [[unlikely]]
    return do_special();
  pull(kI2cClock);
  frame_ = frame = frame << 1 | lines / kI2cData;
  if ((frame & kFull) != 0) [[unlikely]]
    return end_byte();
  (frame & kNextBit) != 0 ? release(kI2cData) : pull(kI2cData);
  return Transfer::goes_on;
}

Transfer LineMaster::end_byte() {
  if (receives_) {
    *in_++ = static_cast<std::byte>(frame_ >> 1);
    if (in_ != in_end_) return receive();
    done_ = true;
    return want(Next::stop);
  }
  done_ = false;
  if ((frame_ & 1) != 0) return want(Next::stop);  // not acknowledged
  if ((address_ & kReads) != 0) return receive();
  if (out_ != out_end_) return send(std::to_integer<std::uint32_t>(*out_++) << 24 | kAcknowledge);
  done_ = in_ == in_end_;
  return want(done_ ? Next::stop : Next::start);
}

// The clock is high.
Transfer LineMaster::do_special() {
  switch (next_) {
    case Next::break_off:
      pull(kI2cClock);
      return want(Next::stop_and_start);
    case Next::start:
      if (!data_is_high()) return end(false);
      address_ |= kReads;
      return send_start();
    case Next::stop_and_start:
      release(kI2cData);
      half_bit();
      if (data_is_high()) return send_start();
      // The clock before was the last of a byte, which the device acknowledges with this one.
      pull(kI2cClock);
      pull(kI2cData);
      return stretched();
    case Next::bit:
    case Next::stop:
      break;
  }
  release(kI2cData);
  half_bit();
  return end(done_);
}

Transfer LineMaster::stretched() {
  return --patience_ != 0 ? Transfer::goes_on : end(false);
}

Transfer LineMaster::end(bool done) {
  let_go();
  return done ? Transfer::done : Transfer::failed;
}

// A pending interrupt would do a bit of nobody's.
void LineMaster::let_go() {
  robosync_has_work = 0;
  kControl.write(0);
  kInterrupt.write(1);
  port::Register{port::core::kNvicIcpr}.write(kNvicBit);
  release(kI2cClock);
  release(kI2cData);
  user_ = User::nobody;
}

void LineMaster::hurry() {
  for (; robosync_has_work != 0; wait(2))
    port::Register{port::core::kNvicIspr}.write(kNvicBit);
}

Store::Outcome LineMaster::transfer_between(std::uint8_t address, std::span<const std::byte> out,
                                            std::span<std::byte> in) {
  {
    const port::Alone alone;
    if (user_ != User::nobody) return Store::Outcome::taken;
    user_ = User::store;
    prepare(address, out, in);
    send_start();
  }
  while (true) {
    const port::Alone alone;
    if (user_ != User::store) return Store::Outcome::taken;
    const Transfer state = do_bit();
    if (state != Transfer::goes_on)
      return state == Transfer::done ? Store::Outcome::done : Store::Outcome::busy;
    wait(kStoreLow);
  }
}

}  // namespace robosync::boards::mps2
