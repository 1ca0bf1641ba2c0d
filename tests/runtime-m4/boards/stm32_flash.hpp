// A model of the second bank of the flash of an STM32L475, from ST's reference manual (RM0351) and errata sheet (ES0250). It is
// independent of the driver: addresses, fields and values are defined here again.
//
// Time passes when the flash's state is polled, and by pass_ms(). Everything else that it can do is left out; using it
// throws an exception.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include "tests/runtime-m4/boards/registers.hpp"

namespace robosync::tests {

class Stm32Flash : public RegisterModel {
public:
  static constexpr std::uint32_t kBegin = 0x0808'0000, kPage = 2048;

  explicit Stm32Flash(std::uint32_t bytes) : pairs_(bytes / 8) {}

  std::uint32_t bytes() const { return static_cast<std::uint32_t>(8 * pairs_.size()); }
  void restart();  // the power is back
  void pass_us(unsigned us) {
    if (!stuck) busy_us_ -= std::min(busy_us_, us);
  }
  void pass_ms(unsigned ms) { pass_us(ms * 1000); }
  void damage(std::uint32_t address) { pairs_.at((address - kBegin) / 8).damaged = true; }

  std::optional<unsigned>
      power_for;  // pages or pairs of words until the power is cut; the next one is spoiled
  unsigned operations = 0;
  std::map<std::uint32_t, unsigned> erased;  // how often, by page
  std::function<void()> nmi;
  unsigned nmis = 0;
  bool of_bank_1 = false;  // the damage is reported for bank 1
  bool stuck = false;      // an operation never ends
  bool answers = true;     // false: its registers are 0 and nothing happens, as in QEMU

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

private:
  struct Pair {  // of words, under one checksum
    std::uint32_t low = ~0U, high = ~0U;
    bool damaged = false;
    bool blank() const { return !damaged && low == ~0U && high == ~0U; }
  };

  bool is_busy() const { return busy_us_ != 0; }
  bool goes_wrong();
  void write_control(std::uint32_t value);
  void write_access(std::uint32_t value);
  void erase();
  void program(std::uintptr_t address, std::uint32_t value);
  std::uint32_t read_word(std::uintptr_t address);

  std::vector<Pair> pairs_;
  std::uint32_t access_ = 0x704, status_ = 0, control_ = 0b11U << 30, damage_ = 0;
  unsigned keys_ = 0;
  std::optional<std::uint32_t> low_;  // the first word of a pair, waiting for the second
  std::uintptr_t low_at_ = 0;
  unsigned busy_us_ = 0;
  bool cache_is_stale_ = false;
  bool dead_ = false;
  std::mt19937 random_{1};
};

}  // namespace robosync::tests
