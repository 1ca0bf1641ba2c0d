// A model of the flash of an nRF52833 (NVMC) and of the bytes that its UART0 receives at the same time, from Nordic's Product
// Specification. It is independent of the driver: addresses, fields and values are defined here again.
//
// Time passes when the core polls whether the flash is ready. Everything else that it can do is left out; using it throws an
// exception.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include "tests/runtime-m4/boards/registers.hpp"

namespace robosync::tests {

class Nrf52833Flash : public RegisterModel {
public:
  static constexpr std::uint32_t kEnd = 512 * 1024, kPage = 4096;

  explicit Nrf52833Flash(std::uint32_t bytes) : begin_(kEnd - bytes), words_(bytes / 4, ~0U) {}

  std::uint32_t begin() const { return begin_; }
  std::uint32_t bytes() const { return kEnd - begin_; }
  void restart();  // the power is back

  std::optional<unsigned>
      power_for;  // words or parts of an erase until the power is cut; the next one is spoiled
  unsigned operations = 0;
  std::map<std::uint32_t, unsigned> erased;  // how often, by page
  unsigned longest_us = 0;                   // longest busy time without a pause

  // Bytes that arrive, one each 87 us, while the flash is busy; and those that were lost.
  std::deque<std::uint8_t> line;
  unsigned lost = 0;

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

private:
  static constexpr std::size_t kFifo = 6;
  struct Page {
    unsigned erased_ms = 0;  // in consecutive parts
  };

  std::uint32_t& word_at(std::uintptr_t address);
  bool goes_wrong();
  void work_for(unsigned us);
  void erase_partially(std::uint32_t page);
  void program(std::uintptr_t address, std::uint32_t value);
  void pass_a_look();

  std::uint32_t begin_;
  std::vector<std::uint32_t> words_;
  std::map<std::uint32_t, Page> pages_;
  std::map<std::uintptr_t, unsigned> written_;  // since the page was erased
  std::uint32_t configuration_ = 0, erase_ms_ = 10;
  unsigned busy_us_ = 0, next_byte_us_ = 0;
  std::deque<std::uint8_t> fifo_;
  std::uint32_t received_ = 0;
  bool dead_ = false;
  std::mt19937 random_{1};
};

}  // namespace robosync::tests
