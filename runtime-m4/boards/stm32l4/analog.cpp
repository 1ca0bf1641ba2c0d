// See analog.hpp. ST's RM0351, 18 (ADC): the steps follow 18.4.6 to 18.4.9.
//
// A measurement takes 15 and 653 cycles of 40 MHz, 17 us: less than two thread switches take, so the thread polls. Interrupts are
// still taken.
#include "runtime-m4/boards/stm32l4/analog.hpp"

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/inputs.hpp"
#include "runtime-m4/boards/stm32l4/wiring.hpp"

namespace robosync::boards::stm32l4::analog {

namespace {

constexpr const auto& kInputs = wiring::kAnalogInputs;

// One poll takes at least four cycles of the core's 80 MHz: 25 us in all, and 50 us for the regulator, which needs 20.
constexpr unsigned kLooks = 500;
constexpr unsigned kLooksOfRegulator = 1000;

bool is_up = false;

bool becomes(Register state, std::uint32_t bit, bool set) {
  for (unsigned i = 0; i < kLooks; ++i)
    if (state.has(bit) == set) return true;
  return false;
}

void wait_for_regulator() {
  for (unsigned i = 0; i < kLooksOfRegulator; ++i)
    static_cast<void>(adc::kControl.read());
}

// For some cycles after the calibration the converter cannot be switched on, so the command is repeated.
bool switch_on() {
  adc::kState.write(adc::kReady);
  for (unsigned i = 0; i < kLooks; ++i) {
    adc::kControl.write(adc::kRegulator | adc::kOn);
    if (adc::kState.has(adc::kReady)) return true;
  }
  return false;
}

// The first write to kControl ends the deep power-down.
bool bring_up() {
  adc::kCommon.write(adc::kClockByTwo);
  adc::kControl.write(0);
  adc::kControl.write(adc::kRegulator);
  wait_for_regulator();
  adc::kControl.write(adc::kRegulator | adc::kCalibrate);
  return becomes(adc::kControl, adc::kCalibrate, false) && switch_on();
}

}  // namespace

void start() {
  for (const AnalogInput& input : kInputs) {
    input.port.mode().set_field(input.bit, 2, kModeOfAnalog);
    input.port.pulls().set_field(input.bit, 2, 0);
    input.port.analog().set(1U << input.bit);
  }
  rcc::kSources.set(rcc::kAdcBySystemClock);
  rcc::give_clock(rcc::kAhb2, rcc::kAdc);
  is_up = bring_up();
  if (!is_up) return;
  adc::kConfiguration.write(adc::kNewestOf12Bits);
  for (const AnalogInput& input : kInputs)
    adc::samples(input.channel)
        .set_field(input.channel % adc::kSamplesARegister, adc::kSampleBits, adc::k640Cycles);
}

// If an earlier conversion was told to stop and has not stopped, no new one is started.
bool read(std::uint16_t pin, std::uint16_t& voltage) {
  const std::size_t i = find_input(kInputs, pin);
  if (i == kInputs.size() || !is_up || adc::kControl.has(adc::kStart)) return false;
  adc::kSequence.write(adc::discard_and_convert(kInputs[i].channel));
  adc::kState.write(adc::kEnded);
  adc::kControl.set(adc::kStart);
  if (!becomes(adc::kState, adc::kEnded, true)) {
    adc::kControl.set(adc::kStop);
    return false;
  }
  voltage = static_cast<std::uint16_t>(adc::kData.read() & kAnalogFull);
  return true;
}

}  // namespace robosync::boards::stm32l4::analog
