// An AT24C512 on the I2C bus as the board's store: pages of 128 bytes, two address bytes. Microchip
// AT24C512C, DS20006218: a page write takes up to 5 ms, in which the device does not acknowledge.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/mps2-an386/i2c.hpp"
#include "runtime-m4/boards/store.hpp"

namespace robosync::boards::mps2 {

class Eeprom final : public Store {
public:
  explicit constexpr Eeprom(I2c& bus) : bus_(bus) {}

  std::uint32_t size() const override { return ROBOSYNC_STORE_BYTES; }
  std::uint32_t page() const override { return 128; }

  Outcome read(std::uint32_t at, std::span<std::byte> bytes) override {
    return exchange(place(at), bytes);
  }
  Outcome write(std::uint32_t at, std::span<const std::byte> bytes) override {
    std::array<std::byte, 2 + kPiece> out{};
    const auto address = place(at);
    const auto behind = std::copy(address.begin(), address.end(), out.begin());
    std::copy_n(bytes.begin(), std::min(bytes.size(), kPiece), behind);
    return exchange(std::span(out).first(address.size() + bytes.size()), {});
  }

private:
  static constexpr std::uint8_t kAddress = 0x50;

  // What was asked of the bus comes first.
  Outcome exchange(std::span<const std::byte> out, std::span<std::byte> in) {
    LineMaster::hurry();
    return bus_.free() ? bus_.master().transfer_between(kAddress, out, in) : Outcome::busy;
  }
  static constexpr std::array<std::byte, 2> place(std::uint32_t at) {
    return {static_cast<std::byte>(at >> 8), static_cast<std::byte>(at)};
  }

  I2c& bus_;
};

}  // namespace robosync::boards::mps2
