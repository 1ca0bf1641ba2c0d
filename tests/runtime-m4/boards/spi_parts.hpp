// Models of the SPI masters that parts are wired to: SPIM3 of an nRF52833 with the pins of UARTE1 (Nordic's Product Specification,
// 6.23 and 6.34), and SPI1 of an STM32L475 with channels 2 and 3 of its DMA1 (ST's RM0351, 42 and 11); each with its pins, and
// parts that answer while they are selected. They are independent of the drivers: addresses, fields and values are defined here
// again.
//
// Everything else that they can do is left out; using it throws an exception.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "tests/runtime-m4/boards/nrf52833.hpp"
#include "tests/runtime-m4/boards/stm32_timers.hpp"

namespace robosync::tests {

// What both have on their lines.
struct SpiParts {
  // By the board's number of the select pin: what a part answers to a command, after it.
  std::map<unsigned, std::map<std::uint8_t, std::vector<std::uint8_t>>> answers;
  // The bytes of each transfer, and the select pin of its part; no bytes after that pin has gone high again.
  struct Heard {
    unsigned select;
    std::vector<std::uint8_t> bytes;
    bool operator==(const Heard&) const = default;
  };
  std::vector<Heard> heard;
  bool stuck = false;  // the clock does not run

protected:
  ~SpiParts() = default;
  // A byte goes out, and the part's comes back. `selected`: the pins that are low.
  std::uint8_t exchange(std::uint8_t out, const std::vector<unsigned>& selected);
  // Call it when no part is selected, between two bytes.
  void release() { goes_on_ = false; }

private:
  bool goes_on_ = false;
};

class SpimParts : public Nrf52833, public SpiParts {
public:
  bool is_dead = false;    // a transfer does not even stop
  bool loses_one = false;  // of the bytes that come: it ends one short

  void pass_microsecond();
  bool interrupt() const { return ended_ != 0 && (interrupts_ & 1U << 6) != 0; }
  bool is_on() const { return enable_ == 7; }
  bool player_has_its_pin() const { return player_enable_ == 8; }

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

  static constexpr Pin kClock{0, 17}, kInput{0, 1}, kOutput{0, 13};

private:
  void start();
  void end(bool stopped);
  void write_player(std::uintptr_t offset, std::uint32_t value);
  std::vector<unsigned> selected() const;

  std::uint32_t enable_ = 0, clock_ = ~0U, output_ = ~0U, input_ = ~0U, frequency_ = 0x0400'0000,
                mode_ = 0, interrupts_ = 0;
  std::uint32_t from_ = 0, send_ = 0, to_ = 0, receive_ = 0, received_ = 0, ended_ = 0,
                stopped_ = 0;
  bool runs_ = false, stops_ = false;
  unsigned done_ = 0, left_us_ = 0;
  std::uint32_t player_enable_ = 0, player_stopped_ = 0;
};

class Stm32SpiParts : public Stm32Timers, public SpiParts {
public:
  bool dma_fails = false;    // at the next byte that comes
  bool dma_is_late = false;  // it takes no byte that comes

  void pass_microsecond();
  bool interrupt() const;
  bool is_on() const { return (control_ & 1U << 6) != 0; }
  // A pin of port A has the SPI's function.
  bool has_pin(unsigned bit);
  bool has_pins() { return has_pin(5) && has_pin(6) && has_pin(7); }

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

  // The board's numbers of its outputs, and the pins of the chip.
  std::map<unsigned, Pin> selects{{45, {'C', 0}}, {0, {'A', 1}}, {2, {'D', 14}}, {10, {'A', 2}}};

private:
  struct Channel {
    std::uint32_t control = 0, count = 0, peripheral = 0, memory = 0, moved = 0;
  };
  void write_channel(Channel& channel, std::uintptr_t offset, std::uint32_t value);
  void write_own(std::uintptr_t offset, std::uint32_t value);
  volatile std::uint8_t* dma(Channel& channel, unsigned number, std::uint32_t control);
  void fill();
  void empty();
  void reset();
  void pass_tick();
  std::vector<unsigned> selected() const;

  std::uint32_t ahb1_ = 0, apb2_ = 0, resets_ = 0, select_ = 0, flags_ = 0;
  std::uint32_t control_ = 0, control2_ = 0x700, lost_ = 0;
  Channel to_memory_, from_memory_;        // 2 and 3
  std::deque<std::uint8_t> sends_, came_;  // four bytes at most
  unsigned left_ = 0,
           tail_ = 0;  // of the present byte, and of the clock after it: tenths of a microsecond
  std::uint8_t byte_ = 0;
};

}  // namespace robosync::tests
