// An I2C master on two open-drain lines that software drives, a bit at a time, so that nothing waits for a transfer: see AskedBus
// (boards/common/asked_bus.hpp). An interrupt of timer 0 does the next bit every 10 us, and no bit takes longer than 3 us. While no
// thread needs the processor, the idle thread does not wait for the timer (hurry()): the bus then runs at some 300 kHz.
//
// The board's store ranks below: its thread does the bits of its transfers, and a transfer for anybody else takes the bus away
// from it, even in the middle of a byte.
//
// Lines are driven as a device of 400 kHz allows. A device may hold the clock low, but not for ever: then the transfer fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/asked_bus.hpp"
#include "runtime-m4/boards/common/transfer.hpp"
#include "runtime-m4/boards/store.hpp"

namespace robosync::boards::mps2 {

class LineMaster {  // for AskedBus
public:
  static void start();
  void begin(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in);
  Transfer on_interrupt();
  void let_go();
  static bool clock_is_high();
  static bool data_is_high();
  // … or will be, when the store's transfer has been broken off.
  bool are_high() const;
  static void take_clock() {}
  static void give_clock_back() {}
  static void drive_clock(bool high);
  static void half_bit();

  // A transfer for the store; both lines are high (AskedBus::free()). `taken`: another one took the bus, or has it.
  //  [the thread with the lowest rank]
  [[nodiscard]] Store::Outcome transfer_between(std::uint8_t address,
                                                std::span<const std::byte> out,
                                                std::span<std::byte> in);
  // Does the bits of the running transfers at once.  [a thread that no other needs]
  static void hurry();

private:
  enum class User : std::uint8_t { nobody, asked, store };
  // What the next rise of the clock is for. break_off ends the store's transfer: its device may be about to acknowledge.
  enum class Next : std::uint8_t { bit, start, stop, break_off, stop_and_start };

  void prepare(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in);
  Transfer do_bit();
  [[gnu::noinline]] Transfer do_special();
  [[gnu::noinline]] Transfer end_byte();
  [[gnu::noinline, gnu::cold]] Transfer stretched();
  Transfer end(bool done);
  Transfer want(Next next);
  Transfer send(std::uint32_t bits);
  Transfer receive();
  Transfer send_start();
  static void pull(std::uint32_t line);
  static void release(std::uint32_t line);

  const std::byte* out_ = nullptr;
  const std::byte* out_end_ = nullptr;
  std::byte* in_ = nullptr;
  std::byte* in_end_ = nullptr;
  std::uint32_t frame_ =
      0;  // from its top: the bits to send; at its bottom: those that have come, below a 1
  std::uint16_t patience_ = 0;  // bits for which devices may still hold a line low
  std::uint8_t address_ = 0;    // as sent, with the direction of the transfer
  Next next_ = Next::bit;
  User user_ = User::nobody;
  bool receives_ = false;  // the running byte
  bool done_ = false;      // all bytes; else the transfer has failed
};
using I2c = AskedBus<LineMaster>;

}  // namespace robosync::boards::mps2
