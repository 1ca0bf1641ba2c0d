// The shipped code for the watchdog of the micro:bit V2, the reset cause, the clock and the serial line, against models of the
// chip's registers.
#include <deque>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "link/frame.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/boards/microbit-v2/clock.hpp"
#include "runtime-m4/boards/microbit-v2/resets.hpp"
#include "runtime-m4/boards/microbit-v2/uart.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"

using namespace robosync;
using tests::Nrf52833;
namespace microbit = boards::microbit;

TEST_CASE(
    "micro:bit: the watchdog resets the chip 100 ms after the last kick, and runs while the core "
    "sleeps") {
  Nrf52833 chip;
  microbit::start_watchdog(100);
  CHECK(chip.watchdog().runs);
  CHECK(chip.watchdog().configuration == 1);  // runs in sleep, but not while a debugger halts
  for (unsigned i = 0; i < 50; ++i) {
    chip.pass_slow_counts(3200);  // 97.7 ms
    REQUIRE_FALSE(chip.watchdog().expired);
    microbit::kick_watchdog();
  }
  chip.pass_slow_counts(3275);
  CHECK_FALSE(chip.watchdog().expired);
  chip.pass_slow_counts(3);
  CHECK(chip.watchdog().expired);
}

TEST_CASE("micro:bit: a watchdog that runs already is kicked when it is started") {
  Nrf52833 chip;
  microbit::start_watchdog(100);
  chip.pass_slow_counts(3200);
  microbit::start_watchdog(100);
  chip.pass_slow_counts(3200);
  CHECK_FALSE(chip.watchdog().expired);
}

TEST_CASE("micro:bit: the cause of a reset is told once, and the next one is told as what it is") {
  constexpr std::uint32_t kPin = 1, kDog = 2, kSoft = 4, kLockup = 8;
  using microbit::ChipReset;
  Nrf52833 chip;
  CHECK(microbit::take_reset_cause() == ChipReset::other);  // power
  chip.reset_by(kDog);
  CHECK(microbit::take_reset_cause() == ChipReset::watchdog);
  CHECK(microbit::take_reset_cause() == ChipReset::other);
  chip.reset_by(kLockup);
  CHECK(microbit::take_reset_cause() == ChipReset::lockup);
  chip.reset_by(kSoft);
  CHECK(microbit::take_reset_cause() == ChipReset::other);
  chip.reset_by(kPin);
  chip.reset_by(kDog);  // anomaly 136
  CHECK(microbit::take_reset_cause() == ChipReset::other);
  chip.reset_by(kDog);
  CHECK(microbit::take_reset_cause() == ChipReset::watchdog);
}

namespace {

// TIMER0, the crystal and the flash's cache. An access takes some counts, or none.
class Clocks : public tests::RegisterModel {
public:
  std::uint32_t read(std::uintptr_t address) override {
    access();
    switch (address) {
      case 0x4000'0100:
        return crystal_runs_;
      case 0x4000'8140:
        return reached;
      case 0x4000'8540:
      case 0x4000'8544:
        return compared_[(address - 0x4000'8540) / 4];
      default:
        FAIL("no register at " << address);
        return 0;
    }
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    access();
    switch (address) {
      case 0x4000'0000:
        if (value == 1 && has_crystal) crystal_starts_in_ = 700;
        return;
      case 0x4000'0100:
        crystal_runs_ = value;
        return;
      case 0x4000'8000:
        if (value == 1) runs_ = width_ == 3 && prescaler_ == 0;
        return;
      case 0x4000'8040:
      case 0x4000'8044:
        if (value == 1) compared_[(address - 0x4000'8040) / 4] = counter;
        return;
      case 0x4000'8140:
        REQUIRE(value == 0);
        reached = 0;
        return;
      case 0x4000'8304:
        interrupts |= value;
        return;
      case 0x4000'8308:
        interrupts &= ~value;
        return;
      case 0x4000'8508:
        width_ = value;
        return;
      case 0x4000'8510:
        prescaler_ = value;
        return;
      case 0x4000'8540:
        compared_[0] = value;
        return;
      case 0x4001'E540:
        cache = value;
        return;
      default:
        FAIL("no register at " << address);
    }
  }
  void pass(std::uint32_t counts) {
    for (; counts > 0; --counts) {
      if (runs_ && ++counter == compared_[0]) reached = 1;
      if (crystal_starts_in_ > 0 && --crystal_starts_in_ == 0) crystal_runs_ = 1;
    }
  }
  bool interrupt() const { return reached != 0 && (interrupts & 1U << 16) != 0; }

  bool has_crystal = true;
  std::uint32_t counter = 0, reached = 0, interrupts = 0, cache = 0, slowest = 4;

private:
  void access() { pass(accesses_++ % slowest); }

  bool runs_ = false;
  std::uint32_t crystal_runs_ = 1, crystal_starts_in_ = 0, width_ = 0, prescaler_ = 4,
                accesses_ = 0;
  std::array<std::uint32_t, 2> compared_{};
};

}  // namespace

TEST_CASE("micro:bit: the clock starts with the crystal, and not without") {
  Clocks chip;
  CHECK(microbit::start_clock());
  CHECK(chip.cache == 1);
  const std::uint32_t before = microbit::counted();
  chip.pass(1000);
  const std::uint32_t passed = microbit::counted() - before;
  CHECK(passed >= 1000);
  CHECK(passed < 1000 + 8);
  Clocks broken;
  broken.has_crystal = false;
  CHECK_FALSE(microbit::start_clock());
}

TEST_CASE(
    "micro:bit: an alarm ends a sleep of any length when it shall, and says when it may have "
    "missed it") {
  for (std::uint32_t counts = 1; counts < 3000; counts += 1 + counts / 8) {
    for (std::uint32_t slowest = 2; slowest < 7; ++slowest) {
      Clocks chip;
      chip.slowest = slowest;
      REQUIRE(microbit::start_clock());
      chip.counter = 0xFFFF'FFF0 - counts;  // it wraps
      const std::uint32_t begin = chip.counter;
      const bool missed = microbit::begin_alarm(counts);
      for (std::uint32_t i = 0; i < 2 * counts + 100 && !missed && !chip.interrupt(); ++i)
        chip.pass(1);
      const std::uint32_t passed = chip.counter - begin;
      CAPTURE(counts, slowest, passed);
      if (!missed) CHECK(passed >= counts);
      CHECK(passed <= counts + 40);
      if (counts >= 100) CHECK_FALSE(missed);
      microbit::end_alarm();
      CHECK_FALSE(chip.interrupt());
      chip.pass(5000);
      CHECK_FALSE(chip.interrupt());
    }
  }
}

namespace {

// UART0: six bytes wait, one is on its way.
class UartModel : public tests::RegisterModel {
public:
  std::uint32_t read(std::uintptr_t address) override {
    switch (address) {
      case 0x4000'2108:
        return received_;
      case 0x4000'211C:
        return sent_;
      case 0x4000'2304:
      case 0x4000'2308:
        return interrupts_;
      case 0x4000'2518: {
        const std::uint32_t byte = in_register_;
        has_byte_ = false;
        deliver();
        return byte;
      }
      default:
        FAIL("no register at " << address);
        return 0;
    }
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    if (address >= 0x5000'0000) return write_pin(address, value);
    if (address >= 0x4000'2500 && address != 0x4000'251C) return write_setting(address, value);
    switch (address) {
      case 0x4000'2000:
        receives = value == 1 && enabled_;
        return;
      case 0x4000'2008:
        transmits = value == 1 && enabled_;
        return;
      case 0x4000'2108:
      case 0x4000'211C:
        REQUIRE(value == 0);
        (address == 0x4000'2108 ? received_ : sent_) = 0;
        return;
      case 0x4000'2304:
        interrupts_ |= value;
        return;
      case 0x4000'2308:
        interrupts_ &= ~value;
        return;
      case 0x4000'251C:
        REQUIRE(transmits);
        REQUIRE_FALSE(on_its_way_);  // it would be lost
        leaving_ = static_cast<std::byte>(value);
        on_its_way_ = true;
        return;
      default:
        FAIL("no register at " << address);
    }
  }
  bool is_as_it_should() const {
    return baud_ == 0x01D7'E000 && transmits_at_ == 6 && receives_at_ == 40 && receives &&
           transmits;
  }
  void send_out() {
    if (!on_its_way_) return;
    on_its_way_ = false;
    went.push_back(leaving_);
    sent_ = 1;
  }
  // False if there is no room for it.
  bool come_in(std::byte byte) {
    if (waiting_.size() + (has_byte_ ? 1 : 0) == 6) return false;
    waiting_.push_back(byte);
    deliver();
    return true;
  }
  bool interrupt() const {
    return pending || (received_ != 0 && (interrupts_ & 1U << 2) != 0) ||
           (sent_ != 0 && (interrupts_ & 1U << 7) != 0);
  }
  std::vector<std::byte> went;
  bool pending = false;  // in the NVIC
  bool receives = false, transmits = false;

private:
  void write_pin(std::uintptr_t address, std::uint32_t value) {
    if (address == 0x5000'0508) {
      out_ |= value;
    } else if (address == 0x5000'0718) {  // P0.06
      CHECK(value == 0b11);
      CHECK((out_ & 1U << 6) != 0);  // or the line would fall
    } else {
      REQUIRE(address == 0x5000'0A20);  // P1.08
      CHECK((value & 0b1111) == 0b1100);
    }
  }
  void write_setting(std::uintptr_t address, std::uint32_t value) {
    switch (address) {
      case 0x4000'2500:
        enabled_ = value == 4;
        return;
      case 0x4000'250C:
        transmits_at_ = value;
        return;
      case 0x4000'2514:
        receives_at_ = value;
        return;
      case 0x4000'2524:
        baud_ = value;
        return;
      default:
        FAIL("no register at " << address);
    }
  }
  void deliver() {
    if (has_byte_ || waiting_.empty()) return;
    in_register_ = std::to_integer<std::uint32_t>(waiting_.front());
    waiting_.pop_front();
    has_byte_ = true;
    received_ = 1;
  }

  bool enabled_ = false, on_its_way_ = false, has_byte_ = false;
  std::uint32_t out_ = 0, baud_ = 0, transmits_at_ = 0, receives_at_ = 0, received_ = 0, sent_ = 0,
                interrupts_ = 0, in_register_ = 0;
  std::byte leaving_{};
  std::deque<std::byte> waiting_;
};

UartModel* line_model = nullptr;

// Like the board's, except for the NVIC.
struct TestedUart : microbit::Uart {
  static void start() { open(); }
  static void begin_to_send() {
    wants_to_send(true);
    line_model->pending = true;
  }
  static void nothing_to_send() { wants_to_send(false); }
  using Uart::wants_to_send;
};

}  // namespace

TEST_CASE("micro:bit: the serial line loses no byte, whenever its interrupts come") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    UartModel chip;
    line_model = &chip;
    boards::SerialLine<TestedUart> line;
    line.start({[](void*) {}, [](void*) {}, nullptr});
    REQUIRE(chip.is_as_it_should());
    std::vector<std::byte> written, came, got;
    for (unsigned turn = 0; turn < 20'000; ++turn) {
      if (random() % 8 == 0 && turn < 15'000) {
        std::vector<std::byte> bytes(1 + random() % 20);
        for (std::byte& byte : bytes)
          byte = static_cast<std::byte>(random());
        bytes.resize(line.write(bytes));
        written.insert(written.end(), bytes.begin(), bytes.end());
      }
      if (random() % 3 == 0) chip.send_out();
      const auto next = static_cast<std::byte>(random());
      if (random() % 4 == 0 && chip.come_in(next)) came.push_back(next);
      if (chip.interrupt() && random() % 3 != 0) {
        chip.pending = false;
        if (TestedUart::has_received()) line.on_receive();
        if (TestedUart::wants_to_send() && TestedUart::can_send()) line.on_transmit();
      }
      std::array<std::byte, 64> some{};
      const std::size_t count = line.read(some);
      got.insert(got.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
    }
    CHECK(chip.went.size() > 1000);
    CHECK(chip.went == written);
    CHECK(came.size() > 1000);
    REQUIRE(got.size() <= came.size());
    CHECK(came.size() - got.size() <= 6);  // still in the chip
    CHECK(std::equal(got.begin(), got.end(), came.begin()));
    CHECK_FALSE(TestedUart::wants_to_send());
  }
}
