// The shipped clock for a board that has only SysTick, against a model of SysTick (ARMv7-M manual, B3.3): it returns the number
// of counts that have passed, whatever sleeps and wakes.
#include "runtime-m4/port/cortex-m4/systick.hpp"

#include <random>

#include <catch2/catch.hpp>

#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/strikes_systick.hpp"
#include "tests/runtime-m4/boards/registers.hpp"

extern "C" std::uint32_t robosync_read_clock();

const std::uint32_t robosync::port::hooks::kTickCounts = 80'000;

using namespace robosync;
namespace core = port::core;
namespace strikes = port::strikes;

namespace {

constexpr std::uint32_t kTick = 80'000;

class SysTick : public tests::RegisterModel {
public:
  std::uint32_t read(std::uintptr_t address) override {
    access();
    if (address == core::kSystCvr) return current_;
    if (address == core::kSystRvr) return reload_;
    REQUIRE(address == core::kSystCsr);
    const std::uint32_t answer = control_ | (begun_again_ ? 1U << 16 : 0U);
    begun_again_ = false;
    return answer;
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    access();
    if (address == core::kSystRvr) {
      reload_ = value & 0xFF'FFFF;
    } else if (address == core::kSystCvr) {
      current_ = 0;
      begun_again_ = false;
    } else {
      REQUIRE(address == core::kSystCsr);
      control_ = value & 7;
    }
  }
  void pass(std::uint32_t counts) {
    passed += counts;
    while (counts > 0 && (control_ & 1) != 0) {
      if (current_ == 0) {
        if (reload_ == 0) return;
        current_ = reload_;
        --counts;
        continue;
      }
      const std::uint32_t step = std::min(counts, current_);
      current_ -= step;
      counts -= step;
      if (current_ == 0) begun_again_ = pending = true;
    }
  }
  // The interrupt comes, and is reported once.
  bool strike() { return std::exchange(pending, false); }

  std::uint64_t passed = 0;
  bool pending = false;

private:
  // An access takes a few counts, or none: a slow clock.
  void access() { pass(accesses_++ % 4); }

  std::uint32_t control_ = 0, reload_ = 0, current_ = 0, accesses_ = 0;
  bool begun_again_ = false;
};

// Uses it as tick.cpp does, and checks that the clock is right and never goes back.
struct Run {
  SysTick chip;
  std::mt19937 random;
  std::uint32_t begin_clock = 0, last = 0;
  std::uint64_t begin_passed = 0;
  std::int64_t most_off = 0;
  unsigned restarts = 0;

  explicit Run(unsigned seed) : random(seed) {
    strikes::sleep_for(2 * kTick);  // all runs share the state
    strikes::begin(kTick);
    begin_clock = last = robosync_read_clock();
    begin_passed = chip.passed;
  }
  std::uint32_t drawn(std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); }

  void look() {
    const std::uint32_t clock = robosync_read_clock();
    REQUIRE(last - clock < 0x8000'0000);  // it counts down
    last = clock;
    const auto said = static_cast<std::int64_t>(begin_clock - clock);
    const auto true_count = static_cast<std::int64_t>(chip.passed - begin_passed);
    most_off = std::max(most_off, std::abs(said - true_count));
  }
  // Threads run and read the clock now and then; SysTick's handler is delayed for a while.
  void work() {
    for (unsigned i = drawn(6); i > 0; --i) {
      chip.pass(drawn(kTick / 3));
      if (chip.strike()) {
        chip.pass(drawn(kTick / 4));
        look();
      }
      if (drawn(2) == 0) look();
    }
  }
  // Until the end, or an earlier interrupt, or the core wakes late.
  void sleep() {
    const std::uint32_t counts = 1 + drawn(40 * kTick);
    look();
    strikes::sleep_for(counts);
    chip.strike();
    const std::uint32_t wakes = drawn(2) == 0 ? drawn(counts) : counts + drawn(3 * kTick);
    chip.pass(counts <= kTick ? std::min(wakes, kTick / 2) : wakes);
    look();
    strikes::begin(1 + drawn(kTick));
    restarts += 2;
  }
};

}  // namespace

TEST_CASE("while threads run the clock says exactly what has passed") {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Run run(seed);
    while (run.chip.passed < 0x8000'0000 / 16) {
      run.work();
      run.look();
      strikes::sleep_for(1 + run.drawn(kTick));  // ends with the next tick: nothing is restarted
      strikes::begin(1 + run.drawn(kTick));
    }
    CHECK(run.most_off <= 8);  // an access or two
  }
}

TEST_CASE(
    "sleeps of any length, ended early or late, cost it a few counts each, and it never goes "
    "back") {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Run run(seed);
    for (unsigned round = 0; round < 300 && run.chip.passed < 0x7000'0000; ++round) {
      run.work();
      run.sleep();
    }
    REQUIRE(run.restarts > 100);
    CHECK(run.most_off <= 8 + 16 * static_cast<std::int64_t>(run.restarts));
  }
}

TEST_CASE("a sleep ends when it shall, and ticks follow where they were asked for") {
  Run run(1);
  strikes::sleep_for(5 * kTick);
  run.chip.strike();
  run.chip.pass(5 * kTick - 100);
  CHECK_FALSE(run.chip.strike());
  run.chip.pass(200);
  CHECK(run.chip.strike());
  strikes::begin(1000);
  const std::uint64_t begun = run.chip.passed;
  for (unsigned tick = 0; tick < 5; ++tick) {
    while (!run.chip.strike())
      run.chip.pass(1);
    run.look();
    const auto after = static_cast<std::int64_t>(run.chip.passed - begun);
    CHECK(std::abs(after - (1000 + std::int64_t{tick} * kTick)) < 100);
  }
}
