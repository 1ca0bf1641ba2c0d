// See analog.hpp. Nordic's nRF52833 Product Specification, SAADC.
//
// A conversion takes 12 us: less than two thread switches take, so the thread polls. Interrupts are still taken.
#include "runtime-m4/boards/microbit-v2/analog.hpp"

#include <algorithm>
#include <array>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/microphone.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::analog {

namespace {

struct Input {
  std::uint16_t pin;       // of the edge connector
  std::uint32_t selected;  // AIN0 is P0.02
};
constexpr std::array kInputs{Input{0, 1}, Input{1, 2}, Input{2, 3}};

// Polls (happens()): 31 us in all, and 6 more until the converter has stopped.
constexpr unsigned kLooks = 500;
constexpr unsigned kLooksAtStop = 100;
constexpr unsigned kLooksAtCalibration = 10'000;

alignas(4) volatile std::int16_t result;  // slightly negative values count as 0

// Waits until it has stopped: after an earlier start, results are undefined.
void stop() {
  unsigned looks = kLooksAtStop;
  forget(saadc::kStopped);
  saadc::kStop.write(kDoIt);
  static_cast<void>(happens(saadc::kStopped, looks));
}

}  // namespace

void configure() {
  saadc::kResolution.write(saadc::k12Bits);
  saadc::kOversampling.write(saadc::kNone);
  saadc::kResultsTo.write(port::bus_address(&result));
  saadc::kResultCount.write(1);
}

// If the calibration does not end, read() does not get an answer later, either.
void start() {
  saadc::kInput.write(saadc::kNoInput);
  saadc::kConfiguration.write(saadc::kPartOfSupply);
  configure();
  saadc::kEnable.write(saadc::kOn);
  unsigned looks = kLooksAtCalibration;
  forget(saadc::kCalibrated);
  saadc::kCalibrate.write(kDoIt);
  static_cast<void>(happens(saadc::kCalibrated, looks));
  stop();
}

// Stops the converter and disconnects the pin at the end, which saves current.
bool read(std::uint16_t pin, std::uint16_t& voltage) {
  const std::size_t i = find_input(kInputs, pin);
  if (i == kInputs.size() || microphone::is_on()) return false;
  unsigned looks = kLooks;
  saadc::kInput.write(kInputs[i].selected);
  forget(saadc::kStarted);
  forget(saadc::kEnded);
  saadc::kStart.write(kDoIt);
  bool measured = happens(saadc::kStarted, looks);
  if (measured) {
    saadc::kSample.write(kDoIt);
    measured = happens(saadc::kEnded, looks);
  }
  stop();
  saadc::kInput.write(saadc::kNoInput);
  voltage = static_cast<std::uint16_t>(std::clamp<int>(result, 0, kAnalogFull));
  return measured;
}

}  // namespace robosync::boards::microbit::analog
