// The micro:bit's microphone against a model of what measures it: SAADC that writes buffer after buffer, the timer that asks for
// its conversions, the counter of its blocks, and the PPI between them. Written from Nordic's nRF52833 Product Specification, by
// the author of the driver.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <random>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/analog.hpp"
#include "runtime-m4/boards/microbit-v2/microphone.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"

using namespace robosync;
namespace microphone = boards::microbit::microphone;

namespace {

constexpr double kSupply = 3.3, kBias = 0.1;
constexpr std::uint64_t kMs = 16'000;  // cycles of 16 MHz
constexpr std::size_t kBlock = boards::kSoundBlock;
constexpr std::uint32_t kMostAccesses = 700;

enum class Breaks { nothing, starts, ends };

// Each access takes a cycle; pass() takes more.
class Chip : public tests::Nrf52833 {
public:
  static constexpr std::uintptr_t kSaadc = 0x4000'7000, kTimer = 0x4001'B000,
                                  kCounter = 0x4000'A000, kPpi = 0x4001'F000;
  static constexpr Pin kPower{0, 20};

  Chip() {
    boards::microbit::pins::start();
    microphone::start();
    boards::microbit::analog::start();
    // The driver's state is that of the tests before.
    microphone::listen(true);
    microphone::listen(false);
    written.clear();
    accesses = 0;
  }
  ~Chip() override { microphone::listen(false); }
  Chip(const Chip&) = delete;
  Chip& operator=(const Chip&) = delete;

  std::uint32_t read(std::uintptr_t address) override {
    ++accesses;
    pass(1);
    const std::uintptr_t offset = address & 0xFFF;
    switch (address - offset) {
      case kSaadc:
        tests::demand(offset >= 0x100 && offset <= 0x114, "an event of the converter");
        return events[(offset - 0x100) / 4];
      case kCounter:
        tests::demand(offset == 0x540, "the value that was captured");
        return captured;
      default:
        return Nrf52833::read(address);
    }
  }
  void write(std::uintptr_t address, std::uint32_t value) override {
    ++accesses;
    pass(1);
    const std::uintptr_t offset = address & 0xFFF;
    switch (address - offset) {
      case kSaadc:
        return write_saadc(offset, value);
      case kTimer:
        return write_timer(offset, value);
      case kCounter:
        return write_counter(offset, value);
      case kPpi:
        return write_ppi(offset, value);
      default:
        return Nrf52833::write(address, value);
    }
  }

  void pass(std::uint64_t cycles) {
    for (; cycles > 0; --cycles) {
      ++now;
      if (starts_at == now) start_now();
      if (stops_at == now) events[5] = 1;
      if (converts_until == now) convert();
      if (timer_runs && ++timer == compare) {
        tests::demand((shortcuts & 1) != 0, "it begins again");
        timer = 0;
        happened(kTimer + 0x140);
      }
    }
  }

  // What the buffers got, sample by sample.
  std::deque<std::int16_t> written;
  std::function<double(double)> volts = [](double) { return kBias; };  // by seconds
  std::function<void()> on_pointer;  // the address of the next buffer is set
  Breaks broken = Breaks::nothing;
  std::uint64_t now = 0;
  unsigned accesses = 0;
  double ring_0 = 1.65;

  bool converts() const { return started || timer_runs || ppi_on != 0; }
  bool is_connected() const { return inputs[1] != 0; }
  bool has_power() const { return is_set(kPower) && configuration_of(kPower) == 0x303; }
  bool has_no_power() const { return !is_set(kPower) && configuration_of(kPower) == 0x303; }

private:
  void write_saadc(std::uintptr_t offset, std::uint32_t value) {
    switch (offset) {
      case 0x000:
        return task(value, [this] { begin(); });
      case 0x004:
        return task(value, [this] { sample(); });
      case 0x008:
        return task(value, [this] {
          started = false;
          starts_at = converts_until = 0;
          stops_at = now + 16;
        });
      case 0x00C:
        return task(value, [this] { events[4] = 1; });
      case 0x500:
        return;
      case 0x510:
      case 0x520:
        inputs[offset == 0x510 ? 0 : 1] = value;
        return;
      case 0x518:
      case 0x528:
        demand_stopped();
        configurations[offset == 0x518 ? 0 : 1] = value;
        return;
      case 0x5F0:
        demand_stopped();
        resolution = value;
        return;
      case 0x5F4:
        demand_stopped();
        oversampling = value;
        return;
      case 0x62C:
        if (on_pointer) on_pointer();
        pointer = value;
        return;
      case 0x630:
        count = value;
        return;
      default:
        tests::demand(offset >= 0x100 && offset <= 0x114 && value == 0, "a register that it has");
        events[(offset - 0x100) / 4] = 0;
    }
  }
  static void task(std::uint32_t value, const std::function<void()>& does) {
    tests::demand(value == 1, "a task is started by 1");
    does();
  }
  void demand_stopped() const { tests::demand(!started, "it is configured while it measures"); }

  void begin() {
    tests::demand(!started && converts_until == 0, "started while it measures");
    tests::demand(inputs[0] == 0 || inputs[1] == 0, "one channel at a time");
    if (broken != Breaks::starts) starts_at = now + 16;
  }
  // It takes the pointer over, so the next one can be set.
  void start_now() {
    started = true;
    filled = 0;
    latched = pointer;
    latched_count = count;
    conversions = 0;
    sum = 0;
    events[0] = 1;
  }
  void sample() {
    if (!started) return;
    tests::demand(converts_until == 0, "a sample is asked for before the last one is there");
    const unsigned channel = inputs[1] != 0 ? 1 : 0;
    tests::demand(inputs[channel] == (channel == 1 ? 4U : 1U), "its input");
    if (channel == 1) tests::demand(is_set(kPower), "the microphone has no power");
    const unsigned acquires = configurations[channel] >> 16 & 7;
    static constexpr std::array kTimes{3, 5, 10, 15, 20, 40};
    converts_until = now + std::uint64_t{16} * (kTimes.at(acquires) + 2);
  }
  void convert() {
    converts_until = 0;
    static constexpr std::array kGains{1.0 / 6, 1.0 / 5, 1.0 / 4, 1.0 / 3, 1.0 / 2, 1.0, 2.0, 4.0};
    const unsigned channel = inputs[1] != 0 ? 1 : 0;
    const std::uint32_t configuration = configurations[channel];
    tests::demand((configuration >> 20) == 0 && (configuration & 0xFF) == 0,
                  "single-ended, unbiased");
    const double reference = (configuration >> 12 & 1) != 0 ? kSupply / 4 : 0.6;
    const double voltage = channel == 1 ? volts(static_cast<double>(now) / 16e6) : ring_0;
    sum += voltage * kGains.at(configuration >> 8 & 7) / reference;
    if (++conversions < 1U << oversampling) return;
    const int full = 256 << 2 * resolution;
    const double result = sum / conversions * full;
    put(static_cast<std::int16_t>(std::clamp(std::lround(result), -8L, full - 1L)));
    conversions = 0;
    sum = 0;
  }
  void put(std::int16_t result) {
    auto* const buffer =
        static_cast<volatile std::int16_t*>(const_cast<volatile void*>(tests::memory_at(latched)));
    buffer[filled++] = result;
    written.push_back(result);
    if (filled < latched_count || broken == Breaks::ends) {
      filled = std::min<std::uint32_t>(filled, latched_count - 1);
      return;
    }
    started = false;
    events[1] = 1;
    happened(kSaadc + 0x104);
  }

  void write_timer(std::uintptr_t offset, std::uint32_t value) {
    switch (offset) {
      case 0x000:
        timer_runs = value == 1;
        return;
      case 0x004:
        timer_runs = false;
        return;
      case 0x00C:
        timer = 0;
        return;
      case 0x200:
        shortcuts = value;
        return;
      case 0x510:
        tests::demand(value == 0, "16 MHz");
        return;
      case 0x540:
        compare = value;
        return;
      default:
        tests::no_register(kTimer + offset);
    }
  }
  void write_counter(std::uintptr_t offset, std::uint32_t value) {
    switch (offset) {
      case 0x000:
        tests::demand(counts_events && has_32_bits, "a counter of 32 bits");
        return;
      case 0x008:
        ++counter;
        return;
      case 0x00C:
        counter = 0;
        return;
      case 0x040:
        captured = counter;
        return;
      case 0x504:
        counts_events = value == 1;
        return;
      case 0x508:
        has_32_bits = value == 3;
        return;
      default:
        tests::no_register(kCounter + offset);
    }
  }
  void write_ppi(std::uintptr_t offset, std::uint32_t value) {
    if (offset == 0x504) {
      ppi_on |= value;
    } else if (offset == 0x508) {
      ppi_on &= ~value;
    } else {
      tests::demand(offset >= 0x510 && offset < 0x510 + 20 * 8, "a channel of the PPI");
      const std::size_t channel = (offset - 0x510) / 8;
      tests::demand(channel > 3, "the first channels are those of the echoes");
      ((offset & 4) == 0 ? sources : tasks)[channel] = value;
    }
  }
  void happened(std::uintptr_t event) {
    for (const auto& [channel, source] : sources)
      if (source == event && (ppi_on >> channel & 1) != 0) run(tasks[channel]);
  }
  void run(std::uintptr_t task) {
    const std::uintptr_t offset = task & 0xFFF;
    if (task - offset == kSaadc) return write_saadc(offset, 1);
    if (task - offset == kCounter) return write_counter(offset, 1);
    tests::no_register(task);
  }

  bool started = false, timer_runs = false, counts_events = false, has_32_bits = false;
  std::uint64_t starts_at = 0, stops_at = 0, converts_until = 0;
  std::array<std::uint32_t, 6> events{};
  std::array<std::uint32_t, 2> inputs{}, configurations{};
  std::uint32_t resolution = 1, oversampling = 0, pointer = 0, count = 0, latched = 0,
                latched_count = 0, filled = 0, conversions = 0;
  double sum = 0;
  std::uint32_t timer = 0, compare = 0, shortcuts = 0, counter = 0, captured = 0, ppi_on = 0;
  std::map<std::size_t, std::uintptr_t> sources, tasks;
};

using Block = std::array<std::int16_t, kBlock>;
constexpr std::int16_t kUntouched = 12'345;

std::optional<Block> hear() {
  Block block;
  block.fill(kUntouched);
  if (!microphone::hear(block)) return std::nullopt;
  return block;
}

// A microphone that is on, and looked at.
class Listening {
public:
  explicit Listening(Chip& chip) : chip_(chip), begin_(chip.now) { microphone::listen(true); }

  // So many ms after it was switched on.
  std::optional<Block> at(double ms) {
    ms_ = ms;
    const auto due = begin_ + static_cast<std::uint64_t>(ms * kMs);
    if (chip_.now < due) chip_.pass(due - chip_.now);
    return hear();
  }
  std::optional<Block> after(double ms) { return at(ms_ + ms); }
  // The next ones, 20 ms apart, go to nobody.
  void pass_over(unsigned calls) {
    for (; calls > 0; --calls)
      static_cast<void>(after(20));
  }

private:
  Chip& chip_;
  std::uint64_t begin_;
  double ms_ = 0;
};

// Another voltage every 125 us.
double noise(double seconds) {
  std::seed_seq seed{static_cast<unsigned>(seconds * 8000)};
  std::minstd_rand draw(seed);
  return kBias + std::uniform_real_distribution<double>(-0.04, 0.04)(draw);
}

// Where in what was written the samples of `block` are: those without the mean differ from one to the next as those with it do,
// but for what the mean follows. nullopt: nowhere, or not in a row.
std::optional<std::size_t> place_of(const Block& block, const std::deque<std::int16_t>& written) {
  for (std::size_t from = 0; from + kBlock <= written.size(); ++from) {
    std::size_t i = 1;
    while (i < kBlock) {
      const int wanted = 4 * (written[from + i] - written[from + i - 1]);
      if (std::abs(block[i] - block[i - 1] - wanted) > 150) break;
      ++i;
    }
    if (i == kBlock) return from;
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("microphone: it has power as long as it is on, and off nothing converts") {
  Chip chip;
  CHECK(chip.has_no_power());
  CHECK_FALSE(hear());
  microphone::listen(true);
  CHECK(chip.has_power());
  CHECK_FALSE(hear());
  CHECK(chip.converts());
  microphone::listen(false);
  CHECK(chip.has_no_power());
  CHECK_FALSE(chip.converts());
  CHECK_FALSE(chip.is_connected());
  const unsigned before = chip.accesses;
  CHECK_FALSE(hear());
  CHECK(chip.accesses == before);
}

TEST_CASE("microphone: 8,000 samples a second") {
  Chip chip;
  Listening(chip).pass_over(51);
  CHECK(std::abs(static_cast<int>(chip.written.size()) - 8000) <= 1);
}

TEST_CASE(
    "microphone: all blocks come complete and in their order, however early or late it is called") {
  Chip chip;
  chip.volts = noise;
  Listening listening(chip);
  std::mt19937 draw(1);
  std::uniform_real_distribution<double> late(-9.5, 9.5);
  CHECK_FALSE(listening.at(0));
  CHECK_FALSE(listening.at(20));  // the first one is half a block
  for (int i = 2; i < 60; ++i) {
    const auto block = listening.at(20 * i + late(draw));
    REQUIRE(block);
    const auto place = place_of(*block, chip.written);
    CAPTURE(i);
    REQUIRE(place);
    CHECK(*place == kBlock / 2 + (static_cast<std::size_t>(i) - 2) * kBlock);
  }
}

TEST_CASE(
    "microphone: a block that is not the next one is not given away, and after that they go on") {
  Chip chip;
  chip.volts = noise;
  Listening listening(chip);
  std::mt19937 draw(GENERATE(range(1, 6)));
  std::uniform_real_distribution<double> gap(1, 55);
  std::size_t next = 0;
  unsigned given = 0;
  for (int i = 0; i < 60; ++i) {
    const auto block = listening.after(gap(draw));
    if (!block) continue;
    ++given;
    const auto place = place_of(*block, chip.written);
    REQUIRE(place);
    CHECK(*place >= next);
    next = *place + kBlock;
  }
  CHECK(given > 0);
  listening.pass_over(3);
  for (int i = 0; i < 3; ++i)
    CHECK(listening.after(20));
}

TEST_CASE("microphone: a block that is overwritten while it is taken is not given away") {
  Chip chip;
  chip.volts = noise;
  Listening listening(chip);
  listening.pass_over(3);
  CHECK(listening.after(20));
  chip.on_pointer = [&] {
    chip.on_pointer = {};
    chip.pass(25 * kMs);
  };
  CHECK_FALSE(listening.after(20));
  chip.on_pointer = {};
  CHECK_FALSE(listening.after(45));
  CHECK(listening.after(20));
}

TEST_CASE("microphone: the mean voltage is taken away, and a tone stays") {
  for (const double bias : {0.02, 0.1, 0.18}) {
    Chip chip;
    const double height = GENERATE(0.0, 0.01);
    chip.volts = [=](double seconds) {
      return bias + height * std::sin(2 * std::numbers::pi * 440 * seconds);
    };
    Listening listening(chip);
    listening.pass_over(10);
    const auto block = listening.after(20);
    REQUIRE(block);
    // A step is a quarter of the supply, divided by 4 times 2^16; the converter rounds to four of them.
    const double full = kSupply / 4 / 4;
    const double wanted = height / full * 65536;
    const auto [low, high] = std::ranges::minmax(*block);
    CAPTURE(bias, height, low, high);
    CHECK(std::abs(high - wanted) <= 8 + 0.02 * wanted);
    CHECK(std::abs(low + wanted) <= 8 + 0.02 * wanted);
  }
}

TEST_CASE("microphone: louder than the converter can take is as loud as it can be") {
  Chip chip;
  chip.volts = [](double seconds) {
    return kBias + 0.5 * std::sin(2 * std::numbers::pi * 440 * seconds);
  };
  Listening listening(chip);
  listening.pass_over(10);
  const auto block = listening.after(20);
  REQUIRE(block);
  CHECK(std::ranges::max(*block) > 30'000);
  CHECK(std::ranges::min(*block) < -30'000);
}

TEST_CASE(
    "microphone: a converter that does not answer is looked at a little, and heard when it does") {
  for (const Breaks breaks : {Breaks::starts, Breaks::ends}) {
    Chip chip;
    Listening listening(chip);
    listening.pass_over(5);
    chip.broken = breaks;
    listening.pass_over(2);  // it may have a block from before
    for (int i = 0; i < 10; ++i) {
      const unsigned before = chip.accesses;
      CHECK_FALSE(listening.after(20));
      CHECK(chip.accesses - before <= kMostAccesses);
    }
    chip.broken = Breaks::nothing;
    listening.pass_over(3);
    CHECK(listening.after(20));
  }
}

TEST_CASE("microphone: while it is on, no ring is measured; afterwards they are as before") {
  Chip chip;
  std::uint16_t voltage = 0;
  REQUIRE(boards::microbit::analog::read(0, voltage));
  Listening listening(chip);
  listening.pass_over(3);
  CHECK_FALSE(boards::microbit::analog::read(0, voltage));
  CHECK(listening.after(20));
  microphone::listen(false);
  REQUIRE(boards::microbit::analog::read(0, voltage));
  CHECK(voltage == 2048);
  microphone::listen(true);
  listening.pass_over(2);
  CHECK(listening.after(20));
}
