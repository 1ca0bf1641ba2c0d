// Models of the SPI masters that send a panel its picture: SPIM2 of an nRF52833 (Nordic's Product Specification), and SPI1 of an
// STM32L475 with channel 3 of its DMA1 (ST's RM0351), each with the pins it may have. They are independent of the drivers:
// addresses, fields and values are defined here again.
//
// Everything else that they can do is left out; using it throws an exception.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>

#include "tests/runtime-m4/boards/nrf52833.hpp"
#include "tests/runtime-m4/boards/stm32_timers.hpp"

namespace robosync::tests {

// The level of the data line when the SPI has nothing to send, which the manuals do not specify.
enum class Idle { low, high, as_it_was };

class SpiLine {
public:
  Idle idle = Idle::as_it_was;
  // Called with the level, and how many nanoseconds it lasts.
  std::function<void(bool, unsigned)> heard = [](bool, unsigned) {};

protected:
  ~SpiLine() = default;
  void say(std::uint8_t byte, unsigned ns_of_bit);
  void say_nothing(unsigned ns);

private:
  bool last_ = false;
};

class NrfSpim : public Nrf52833, public SpiLine {
public:
  bool is_dead = false;  // it does nothing, and reads as 0
  unsigned looks = 0;    // polls for the end of a stopped transfer

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;
  // Lets time pass; a byte takes two microseconds.
  void pass(unsigned us);
  // The chip's pin that it has; all bits set: none.
  std::uint32_t pin() const { return enable_ == 7 ? output_ : ~0U; }

private:
  void pass_byte();
  void start();

  std::uint32_t enable_ = 0, output_ = ~0U, clock_ = ~0U, frequency_ = 0x0400'0000, memory_ = 0,
                count_ = 0, receive_count_ = 0, ended_ = 0, stopped_ = 0;
  std::size_t sent_ = 0;
  bool runs_ = false, stops_ = false;
};

class Stm32Spi : public Stm32Timers, public SpiLine {
public:
  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;
  // Lets time pass.
  void pass(unsigned us);
  // The SPI has PA7.
  bool has_pin();

private:
  void pass_byte();
  void fill();

  std::uint32_t ahb1_ = 0, apb2_ = 0, control_ = 0, control2_ = 0x700;
  std::uint32_t select_ = 0, dma_ = 0, left_ = 0, peripheral_ = 0, memory_ = 0;
  std::size_t moved_ = 0;
  std::deque<std::uint8_t> waiting_;  // four bytes at most
};

}  // namespace robosync::tests
