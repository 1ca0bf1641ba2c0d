// The SPI of the reference board against a model of its PL022, written from ARM DDI 0194 by the author of the driver: a transfer
// takes its time here, which it does not in QEMU, and may never end.
#include <array>
#include <deque>
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/boards/mps2-an386/spi.hpp"
#include "tests/runtime-m4/boards/registers.hpp"

using namespace robosync;
namespace spi = boards::mps2::spi;

namespace {

constexpr std::size_t kPlaces = 8;

// Each access takes five cycles, the least that a poll can.
struct Pl022 : tests::RegisterModel {
  static constexpr unsigned kAccess = 5;

  std::uint32_t read(std::uintptr_t address) override {
    pass();
    switch (address - boards::mps2::kSpi0) {
      case 0x08: {
        tests::demand(!received.empty(), "nothing has been received");
        const std::uint8_t byte = received.front();
        received.pop_front();
        return byte;
      }
      case 0x0C:
        return (sending.empty() ? 1U : 0U) | (sending.size() < kPlaces ? 2U : 0U) |
               (received.empty() ? 0U : 4U) | (received.size() < kPlaces ? 0U : 8U) |
               (sending.empty() ? 0U : 16U);
      default:
        tests::no_register(address);
    }
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    pass();
    switch (address - boards::mps2::kSpi0) {
      case 0x00:
        control = value;
        return;
      case 0x04:
        on = (value & 2) != 0;
        tests::demand((value & ~2U) == 0, "the other bits stay 0: no loop, a master");
        return;
      case 0x08:
        tests::demand(sending.size() < kPlaces, "the FIFO is full");
        if (sending.empty()) left = byte_cycles();
        sending.push_back(static_cast<std::uint8_t>(value));
        return;
      case 0x10:
        prescale = value;
        return;
      default:
        tests::no_register(address);
    }
  }

  unsigned byte_cycles() const { return 8 * prescale * (1 + (control >> 8)); }
  void pass() { pass(kAccess); }
  void pass(unsigned cycles) {
    accesses += 1;
    for (; on && clocks && cycles != 0 && !sending.empty(); --cycles)
      if (--left == 0) {
        sent.push_back(sending.front());
        sending.pop_front();
        if (received.size() < kPlaces) received.push_back(static_cast<std::uint8_t>(answer++));
        left = byte_cycles();
      }
  }

  std::uint32_t control = 0, prescale = 0;
  bool on = false, clocks = true;
  unsigned left = 0, accesses = 0, answer = 0x50;
  std::deque<std::uint8_t> sending, received;
  std::vector<std::uint8_t> sent;
};

struct Bus {
  Bus() { spi::start(); }
  std::optional<std::array<std::byte, 2>> read(std::uint8_t command) {
    const std::array out{std::byte{command}};
    std::array<std::byte, 2> in{};
    return spi::transfer(out, in) ? std::optional(in) : std::nullopt;
  }
  Pl022 model;
};

}  // namespace

TEST_CASE("PL022: bytes in mode 0, highest bit first, at 1 MHz at most") {
  Bus bus;
  CHECK(bus.model.control % 256 ==
        7);  // 8 bits, Motorola's format, clock low at rest, read at its first edge
  CHECK(bus.model.prescale % 2 == 0);
  CHECK(bus.model.byte_cycles() >= 8 * 25);
  CHECK(bus.model.on);
}

TEST_CASE("PL022: writes a byte, then zeros, and gives what comes with those") {
  Bus bus;
  CHECK(bus.read(0xA5) == std::array{std::byte{0x51}, std::byte{0x52}});
  CHECK(bus.model.sent == std::vector<std::uint8_t>{0xA5, 0, 0});
  CHECK(bus.read(0x81) == std::array{std::byte{0x54}, std::byte{0x55}});
}

TEST_CASE("PL022: a transfer that does not end is given up, and those after it at once") {
  Bus bus;
  bus.model.clocks = false;
  CHECK(bus.read(1) == std::nullopt);
  CHECK(bus.model.accesses < 250);
  bus.model.accesses = 0;
  CHECK(bus.read(2) == std::nullopt);
  CHECK(bus.model.accesses < 5);
  // What comes late is not taken for the answer of the next one.
  bus.model.clocks = true;
  bus.model.pass(10'000);
  CHECK(bus.model.received.size() == 3);
  CHECK(bus.read(3) == std::array{std::byte{0x54}, std::byte{0x55}});
}

TEST_CASE("PL022: a transfer that does not fit is refused") {
  Bus bus;
  std::array<std::byte, 3> in{};
  const std::array out{std::byte{1}};
  CHECK_FALSE(spi::transfer(out, in));
  CHECK(bus.model.sent.empty());
}
