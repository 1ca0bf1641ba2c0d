// See microphone.hpp. Nordic's nRF52833 Product Specification: SAADC, PPI, TIMER.
//
// A timer asks for 64,000 conversions a second, and the converter means each eight, which also takes some of the sound away that
// is too high for 8,000 samples a second. It fills two buffers in turn: the end of one begins the other. The pointer for the next
// buffer is taken over when one begins, so hear() has a block's time to set it. A counter of ends says whether it did.
#include "runtime-m4/boards/microbit-v2/microphone.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "runtime-m4/boards/microbit-v2/analog.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::microphone {

namespace {

constexpr Pin kPower{0, 20};
constexpr std::uint32_t kInput = 4;                       // AIN3
constexpr std::uint32_t kCounts = 16'000'000 / 8000 / 8;  // of 16 MHz, for each conversion
// The first block is half as long. So the others end in the middle between two calls of hear(), which come every 20 ms by a clock
// with the same crystal.
constexpr std::uint32_t kFirstBlock = kSoundBlock / 2;
// Channels of the PPI; echoes.cpp has the first ones.
constexpr unsigned kGoOn = 6, kCount = 7, kSample = 8;
constexpr std::uint32_t kChannels = 1U << kGoOn | 1U << kCount | 1U << kSample;

constexpr unsigned kLooks = 200;  // polls (happens()): 12 us

// 14 bits become 16. The mean voltage follows the samples like a low-pass filter: 8000 / 128 / 2 pi is 10 Hz.
constexpr std::int32_t kSteps = 4;
constexpr std::int32_t kMeanParts = 128;

using Block = std::array<volatile std::int16_t, kSoundBlock>;
alignas(4) std::array<Block, 2> blocks;
bool on, runs;
bool knows_mean;
std::uint32_t heard;  // blocks, since it runs
std::int32_t mean;    // in parts of a step

void next_to(Block& block, std::uint32_t count) {
  saadc::kResultsTo.write(port::bus_address(block.data()));
  saadc::kResultCount.write(count);
}

std::uint32_t ended() {
  kBlockCounter.capture(0).write(kDoIt);
  return kBlockCounter.value(0).read();
}

void begin() {
  heard = 0;
  kBlockCounter.clear().write(kDoIt);
  next_to(blocks[0], kFirstBlock);
  forget(saadc::kStarted);
  saadc::kStart.write(kDoIt);
  unsigned looks = kLooks;
  runs = happens(saadc::kStarted, looks);
  if (!runs) return;
  next_to(blocks[1], kSoundBlock);
  ppi::kOn.write(kChannels);
  kSampleTimer.clear().write(kDoIt);
  kSampleTimer.start().write(kDoIt);
}

void end() {
  kSampleTimer.stop().write(kDoIt);
  ppi::kOff.write(kChannels);
  forget(saadc::kStopped);
  saadc::kStop.write(kDoIt);
  unsigned looks = kLooks;
  static_cast<void>(happens(saadc::kStopped, looks));
  runs = false;
}

void configure() {
  saadc::kSoundConfiguration.write(saadc::kFourTimes);
  saadc::kResolution.write(saadc::k14Bits);
  saadc::kOversampling.write(saadc::kMeanOf8);
  saadc::kSoundInput.write(kInput);
}

std::int16_t without_mean(std::int32_t sample) {
  sample *= kSteps;
  if (!knows_mean) mean = sample * kMeanParts;
  knows_mean = true;
  mean += sample - mean / kMeanParts;
  using Limits = std::numeric_limits<std::int16_t>;
  return static_cast<std::int16_t>(
      std::clamp<std::int32_t>(sample - mean / kMeanParts, Limits::min(), Limits::max()));
}

// The buffer is the next one but one.
void take(Block& block, std::size_t count, SoundBlock sound) {
  for (std::size_t i = 0; i < count; ++i)
    sound[i] = without_mean(block[i]);
  saadc::kResultsTo.write(port::bus_address(block.data()));
}

}  // namespace

void start() {
  kPower.set_low().write(kPower.mask());
  kPower.configuration().write(Pin::kStrongOutput);
  ppi::join(kGoOn, saadc::kEnded, saadc::kStart);
  ppi::join(kCount, saadc::kEnded, kBlockCounter.count());
  ppi::join(kSample, kSampleTimer.reached(0), saadc::kSample);
  kSampleTimer.shortcuts().write(Timer::kBeginAgain);
  kSampleTimer.prescaler().write(Timer::kEachCount);
  kSampleTimer.value(0).write(kCounts);
  kBlockCounter.mode().write(Timer::kCountsTasks);
  kBlockCounter.width().write(Timer::k32Bits);
  kBlockCounter.start().write(kDoIt);
}

void listen(bool wanted) {
  if (on) end();
  if (on == wanted) return;
  on = wanted;
  knows_mean = false;
  (on ? kPower.set_high() : kPower.set_low()).write(kPower.mask());
  if (on) {
    configure();
  } else {
    saadc::kSoundInput.write(saadc::kNoInput);
    analog::configure();
  }
}

bool is_on() {
  return on;
}

// A block more has ended since the last call; else it begins anew, so that they end in the middle again. A block that ended while
// this one was taken may be in its place already.
bool hear(SoundBlock sound) {
  if (!on) return false;
  const bool is_next = runs && ended() == heard + 1;
  const bool is_first = heard == 0;
  if (is_next) take(blocks[heard % 2], is_first ? kFirstBlock : kSoundBlock, sound);
  if (is_next && ended() == ++heard) return !is_first;
  end();
  begin();
  return false;
}

}  // namespace robosync::boards::microbit::microphone
