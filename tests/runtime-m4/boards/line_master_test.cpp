// The reference board's I2C master, which drives the lines itself, against a device that reads them as UM10204 says: in QEMU no
// device stretches the clock or holds a line, and none minds when the lines change.
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/mps2-an386/i2c.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "tests/runtime-m4/boards/registers.hpp"

using namespace robosync;
using namespace robosync::boards;

namespace {

constexpr std::uint8_t kBitDevice = 0x48;

// A device with 256 registers, of which the first byte that is written selects one.
struct BitDevice {
  bool clock = true, data = true;  // the lines
  bool pulls_data = false, holds_clock = false, holds_data = false;
  std::array<std::uint8_t, 256> registers{};
  std::vector<std::uint8_t> written;  // after the register's number
  unsigned starts = 0, stops = 0, rises = 0;

  void see(bool clock_now, bool data_now) {
    if (clock && clock_now && data != data_now) data_now ? stop() : start();
    if (!clock && clock_now) rise(data_now);
    if (clock && !clock_now) fall();
    clock = clock_now;
    data = data_now;
  }

private:
  enum class Does { nothing, takes, acknowledges, gives, awaits } does_ = Does::nothing;
  bool addressed_ = false, selects_ = false, told_ = false;
  unsigned bits_ = 0, byte_ = 0;
  std::uint8_t at_ = 0;

  void start() {
    ++starts;
    does_ = Does::takes;
    addressed_ = false;
    bits_ = byte_ = 0;
    pulls_data = false;
  }
  void stop() {
    ++stops;
    does_ = Does::nothing;
    pulls_data = false;
  }
  void rise(bool bit) {
    ++rises;
    if (does_ == Does::takes || does_ == Does::gives) ++bits_;
    if (does_ == Does::takes) byte_ = byte_ << 1 | (bit ? 1U : 0U);
    if (does_ == Does::awaits) told_ = !bit;
  }
  void fall() {
    switch (does_) {
      case Does::nothing:
        return;
      case Does::takes:
        if (bits_ == 8) does_ = take() ? Does::acknowledges : Does::nothing;
        pulls_data = does_ == Does::acknowledges;
        return;
      case Does::acknowledges:
        does_ = gives_ ? Does::gives : Does::takes;
        bits_ = byte_ = 0;
        return give();
      case Does::gives:
        if (bits_ == 8) does_ = Does::awaits;
        return give();
      case Does::awaits:
        does_ = told_ ? Does::gives : Does::nothing;
        bits_ = 0;
        ++at_;
        return give();
    }
  }
  void give() { pulls_data = does_ == Does::gives && (registers[at_] << bits_ & 0x80) == 0; }
  bool take() {
    if (!addressed_) {
      addressed_ = true;
      gives_ = (byte_ & 1) != 0;
      selects_ = true;
      return byte_ >> 1 == kBitDevice;
    }
    if (selects_)
      at_ = static_cast<std::uint8_t>(byte_);
    else
      written.push_back(static_cast<std::uint8_t>(byte_));
    selects_ = false;
    return true;
  }
  bool gives_ = false;
};

struct BitLines : tests::RegisterModel {
  BitDevice device;
  bool clock = false, data = false;  // as the master leaves them; pulled low at first
  bool on = false;                   // the timer
  std::function<void()>
      between{};  // what an interrupt does between two bits of the store's transfer

  bool clock_line() const { return clock && !device.holds_clock; }
  bool data_line() const { return data && !device.pulls_data && !device.holds_data; }
  std::uint32_t read(std::uintptr_t address) override {
    tests::demand(address == mps2::kI2c0, "only the lines are read");
    return (clock_line() ? 1U : 0U) | (data_line() ? 2U : 0U);
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (address == mps2::kTimer0 + mps2::kTimerControl) on = value != 0;
    if (address != mps2::kI2c0 && address != mps2::kI2c0 + mps2::kI2cPull) return;
    const bool level = address == mps2::kI2c0;
    if ((value & 1) != 0) clock = level;
    if ((value & 2) != 0) data = level;
    device.see(clock_line(), data_line());
    device.see(clock_line(), data_line());  // what the device has done itself
    // The master changes the data line last of all, and only while the clock is low.
    if ((value & 2) != 0 && !clock && between) std::exchange(between, {})();
  }
};

struct LineBus : BitLines {
  mps2::I2c bus{mps2::LineMaster()};
  std::array<std::byte, 16> got{};

  LineBus() {
    bus.start();
    device.starts = device.stops = 0;
    for (unsigned i = 0; i < device.registers.size(); ++i)
      device.registers[i] = static_cast<std::uint8_t>(i ^ 0x5A);
  }
  unsigned run(unsigned most = 1000) {
    unsigned bits = 0;
    for (; on && bits < most; ++bits)
      bus.on_interrupt();
    return bits;
  }
  bool ask(unsigned from, std::size_t count, std::uint8_t who = kBitDevice) {
    return bus.transfer(true, who, std::array{static_cast<std::byte>(from)},
                        std::span(got).first(count));
  }
  bool collect(unsigned from, std::size_t count, std::uint8_t who = kBitDevice) {
    got.fill(std::byte{});
    return bus.transfer(false, who, std::array{static_cast<std::byte>(from)},
                        std::span(got).first(count));
  }
  bool is_at_rest() const { return !on && clock_line() && data_line(); }
  bool has(unsigned from, std::size_t count) const {
    for (unsigned i = 0; i < count; ++i)
      if (got[i] != static_cast<std::byte>(device.registers[from + i])) return false;
    return true;
  }
};

// A transfer that takes the bus from the store.
struct SharedBus : LineBus {
  unsigned bits = 0;

  // Before this bit of the store's transfer.
  void ask_at(unsigned bit) {
    between = [this, bit] {
      if (bits++ != bit) return ask_at(bit);
      CHECK_FALSE(ask(0x20, 2));
    };
  }
  // Giving way takes at most i2c_take_us of the board's costs, 10 us for each bit.
  void check_the_asked() {
    CHECK(run() <= 9 + 9 + 1 + 9 + 2 * 9 + 1 + 11);
    CHECK(is_at_rest());
    CHECK(collect(0x20, 2));
    CHECK(has(0x20, 2));
  }
};

}  // namespace

TEST_CASE("a read is a bit at each interrupt, and its last byte is not acknowledged") {
  LineBus bus;
  CHECK_FALSE(bus.ask(0x10, 3));
  CHECK(bus.bus.is_busy());
  CHECK(bus.run() == 9 + 9 + 1 + 9 + 3 * 9 + 1);
  CHECK_FALSE(bus.bus.is_busy());
  CHECK(bus.is_at_rest());
  CHECK(bus.collect(0x10, 3));
  CHECK(bus.has(0x10, 3));
  CHECK((bus.device.starts == 2 && bus.device.stops == 1));
}

TEST_CASE("what is asked together follows at once, each with its own start and stop") {
  LineBus bus;
  for (unsigned i = 0; i < 4; ++i)
    CHECK_FALSE(bus.ask(0x20 + 4 * i, 4));
  bus.run();
  for (unsigned i = 0; i < 4; ++i) {
    CHECK(bus.collect(0x20 + 4 * i, 4));
    CHECK(bus.has(0x20 + 4 * i, 4));
  }
  CHECK((bus.device.starts == 8 && bus.device.stops == 4));
}

TEST_CASE("a page is selected in a transfer of its own") {
  LineBus bus;
  const auto read = [&](bool ahead) {
    CHECK(bus.bus.select(std::array{std::byte{0x00}, std::byte{7}}));
    return bus.bus.transfer(ahead, kBitDevice, std::array{std::byte{0x8B}},
                            std::span(bus.got).first(2));
  };
  CHECK_FALSE(read(true));
  CHECK(bus.run() == 3 * 9 + 1 + 2 * 9 + 1 + 9 + 2 * 9 + 1);
  CHECK(read(false));
  CHECK(bus.has(0x8B, 2));
  CHECK(bus.device.written == std::vector<std::uint8_t>{7});
}

TEST_CASE("a device that does not answer fails its transfer, and no other") {
  LineBus bus;
  CHECK_FALSE(bus.ask(0x10, 2, 0x33));
  CHECK_FALSE(bus.ask(0x10, 2));
  CHECK(bus.run() == 9 + 1 + (9 + 9 + 1 + 9 + 2 * 9 + 1));
  CHECK(bus.is_at_rest());
  CHECK_FALSE(bus.collect(0x10, 2, 0x33));
  CHECK(bus.collect(0x10, 2));
}

TEST_CASE("a device may stretch the clock, but not for ever") {
  LineBus bus;
  for (unsigned bit = 1; bit < 9 + 9 + 1 + 9 + 9 + 1; ++bit) {
    CAPTURE(bit);
    CHECK_FALSE(bus.ask(0x10, 1));
    bus.run(bit);
    bus.device.holds_clock = true;
    bus.run(100);
    CHECK(bus.on);
    bus.device.holds_clock = false;
    bus.run();
    CHECK(bus.collect(0x10, 1));
    CHECK(bus.has(0x10, 1));
    CHECK_FALSE(bus.ask(0x10, 1));
    bus.run(bit);
    bus.device.holds_clock = true;
    CHECK(bus.run() == 400);
    CHECK_FALSE(bus.collect(0x10, 1));
    CHECK_FALSE(bus.ask(0x11, 1));  // a line stays low: no transfer begins
    CHECK_FALSE(bus.on);
    CHECK(bus.bus.state().held);
    bus.device.holds_clock = false;
    bus.device.see(bus.clock_line(), bus.data_line());
    CHECK_FALSE(bus.ask(0x10, 1));
    bus.run();
    CHECK(bus.collect(0x10, 1));
  }
}

TEST_CASE("a device that was left in the middle of a byte gets its clocks") {
  LineBus bus;
  bus.device.registers[0x10] = 0;
  CHECK_FALSE(bus.ask(0x10, 1));
  bus.run(9 + 9 + 1 + 9 + 3);
  CHECK_FALSE(bus.collect(0x10, 1));  // too late: given up
  CHECK(bus.clock_line());
  CHECK_FALSE(bus.data_line());
  CHECK_FALSE(bus.ask(0x20, 2));
  bus.run();
  CHECK(bus.collect(0x20, 2));
  CHECK(bus.has(0x20, 2));
  CHECK(bus.bus.state().clears == 1);
  CHECK_FALSE(bus.bus.state().held);
}

TEST_CASE("data that stays low fails each transfer at once") {
  LineBus bus;
  bus.device.holds_data = true;
  CHECK_FALSE(bus.ask(0x10, 1));
  CHECK_FALSE(bus.on);
  CHECK(bus.bus.state().held);
  CHECK_FALSE(bus.collect(0x10, 1));
  bus.device.holds_data = false;
  bus.device.see(bus.clock_line(), bus.data_line());
  CHECK_FALSE(bus.ask(0x10, 1));
  bus.run();
  CHECK(bus.collect(0x10, 1));
}

TEST_CASE("data that is low at the second start fails the transfer") {
  LineBus bus;
  CHECK_FALSE(bus.ask(0x10, 1));
  bus.run(9 + 9);
  bus.device.holds_data = true;
  CHECK(bus.run() == 1);
  CHECK_FALSE(bus.collect(0x10, 1));
  bus.device.holds_data = false;
  bus.device.see(bus.clock_line(), bus.data_line());
  CHECK_FALSE(bus.ask(0x10, 1));
  bus.run();
  CHECK(bus.collect(0x10, 1));
}

TEST_CASE("the store's transfer gives way at each of its bits, and to none it comes before") {
  constexpr std::array kWritten = {std::byte{0x30}, std::byte{0xA5}, std::byte{0x5A}};
  constexpr unsigned kBits = (1 + kWritten.size()) * 9;
  const auto store = [&](SharedBus& bus) {
    return bus.bus.master().transfer_between(kBitDevice, kWritten, {});
  };
  SharedBus whole;
  CHECK(store(whole) == Store::Outcome::done);
  CHECK(whole.is_at_rest());
  CHECK(whole.device.written == std::vector<std::uint8_t>{0xA5, 0x5A});
  for (unsigned bit = 0; bit < kBits; ++bit) {
    CAPTURE(bit);
    SharedBus bus;
    bus.ask_at(bit);
    CHECK(store(bus) == Store::Outcome::taken);
    CHECK(store(bus) == Store::Outcome::taken);
    bus.check_the_asked();
    CHECK((bus.device.starts == 3 && bus.device.stops == 2));
    CHECK(store(bus) == Store::Outcome::done);
  }
}

TEST_CASE("data that stays low while the store gives way fails the transfer in the end") {
  SharedBus bus;
  bus.ask_at(0);
  CHECK(bus.bus.master().transfer_between(kBitDevice, std::array{std::byte{0x30}}, {}) ==
        Store::Outcome::taken);
  bus.device.holds_data = true;
  CHECK(bus.run() == 401);
  CHECK_FALSE(bus.collect(0x20, 2));
}

TEST_CASE("the store's read gives way at each of its bits, whatever the device sends") {
  constexpr unsigned kBits = 9 + 9 + 1 + 9 + 2 * 9;
  for (const unsigned sent : {0x00U, 0xFFU, 0xA5U})
    for (unsigned bit = 0; bit < kBits; ++bit) {
      CAPTURE(sent, bit);
      SharedBus bus;
      bus.device.registers[0x30] = bus.device.registers[0x31] = static_cast<std::uint8_t>(sent);
      bus.ask_at(bit);
      std::array<std::byte, 2> got{};
      CHECK(bus.bus.master().transfer_between(kBitDevice, std::array{std::byte{0x30}}, got) ==
            Store::Outcome::taken);
      bus.check_the_asked();
    }
}
