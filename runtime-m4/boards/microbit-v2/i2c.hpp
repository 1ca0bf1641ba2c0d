// An I2C bus by one of the chip's masters with memory access of its own (TWIM), at 390 kHz. The processor says what is wanted,
// and is told by an interrupt when it is there: nobody waits. So it is asked ahead (boards::Board::i2c_ask()).
//
// Bounded: who is not acknowledged, or does not get the clock, has failed. A transfer that is not over when its answer is due
// is given up, and the bus let go. A data line found held down gets clocks, nine at most, some 30 us, before a transfer;
// while a line stays held down no transfer begins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {

class I2c {
public:
  struct Lines {
    Pin clock, data;
  };
  constexpr I2c(Twim master, Lines lines) : master_(master), lines_(lines) {}

  void start();
  // As boards::Board says, with `ahead` as it was asked last. What is longer than a request can be fails.
  //  [one thread at a time]
  bool transfer(bool ahead, std::uint8_t address, std::span<const std::byte> out,
                std::span<std::byte> in);
  bool is_busy() const { return running_ != nullptr; }
  BusState state() const { return {clears_, static_cast<std::uint8_t>(held_)}; }
  // A transfer is over. [its interrupt]
  void on_end();

private:
  static constexpr std::size_t kMostWritten = 19;  // a portion of a display's picture
  static constexpr std::size_t kMostRead = 16;
  static constexpr std::size_t kMostRequests = 6;

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

  Request* find(std::uint8_t address, std::span<const std::byte> out, std::size_t read);
  Request* place();
  bool ask(Request* request, std::uint8_t address, std::span<const std::byte> out,
           std::size_t read);
  bool collect(Request& request, std::span<std::byte> in);
  Request* next();
  void go_on();
  void begin(Request& request);
  void give_up();
  bool free_lines();
  void clock_out();

  Twim master_;
  Lines lines_;
  std::array<Request, kMostRequests> requests_{};
  Request* running_ = nullptr;
  std::uint32_t turn_ = 0;
  std::uint16_t clears_ = 0;
  bool held_ = false;
  bool wrong_ = false;  // the one that runs
};

}  // namespace robosync::boards::microbit
