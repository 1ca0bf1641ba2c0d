// The peripherals of the nRF52833 that the firmware uses, and how the micro:bit V2 wires them. Sources: Nordic's nRF52833
// Product Specification (the chip) and tech.microbit.org (the board).
#pragma once

#include <cstdint>

#include "runtime-m4/port/cortex-m4/register.hpp"

namespace robosync::boards::microbit {

using port::Register;

inline constexpr std::uint32_t kClockHz = 64'000'000;  // of the core

// Writing 1 starts a task; an event stays set until 0 is written.
inline constexpr std::uint32_t kDoIt = 1;

// A write reaches a peripheral a few cycles later. If it clears an interrupt, the handler must not end before that: the read
// waits for it.
inline void forget(Register event) {
  event.write(0);
  static_cast<void>(event.read());
}

// Polls, at most as often as `looks` says, which counts down: a poll takes at least a cycle of the peripherals' 16 MHz.
inline bool happens(Register event, unsigned& looks) {
  for (; looks > 0; --looks)
    if (event.read() != 0) return true;
  return false;
}

namespace clock {
inline constexpr Register kStartCrystal{0x4000'0000};
inline constexpr Register kCrystalRuns{0x4000'0100};  // event
}  // namespace clock

namespace power {
inline constexpr Register kResetReason{0x4000'0400};  // accumulates; write 1 to clear
inline constexpr std::uint32_t kPinReset = 1U << 0;
inline constexpr std::uint32_t kWatchdogReset = 1U << 1;
inline constexpr std::uint32_t kLockup = 1U << 3;
}  // namespace power

namespace information {                             // FICR
inline constexpr Register kPageBytes{0x1000'0010};  // of the flash
inline constexpr std::uint32_t kOfNrf52833 = 4096;
}  // namespace information

namespace settings {  // UICR: flash that is written like a program, and read at a reset
inline constexpr Register kNfcPins{0x1000'120C};
inline constexpr std::uint32_t kAreForNfc = 1U << 0;
}  // namespace settings

namespace flash {
inline constexpr std::uint32_t kBytes = 512 * 1024;  // from 0 on
inline constexpr Register kReady{0x4001'E400};       // the last operation has ended
inline constexpr std::uint32_t kIsReady = 1U << 0;
inline constexpr Register kConfiguration{0x4001'E504};
inline constexpr std::uint32_t kReadOnly = 0;
inline constexpr std::uint32_t kMayWrite = 1;
inline constexpr std::uint32_t kMayErase = 2;
inline constexpr Register kErasePartially{0x4001'E518};  // the page at that address, for kEraseMs
inline constexpr Register kEraseMs{0x4001'E51C};
inline constexpr Register kInstructionCache{0x4001'E540};
inline constexpr std::uint32_t kOn = 1;
}  // namespace flash

struct Pin {  // {0, 6} is P0.06
  std::uint8_t port, bit;

  constexpr std::uint32_t mask() const { return 1U << bit; }
  // The value that selects this pin in a peripheral's register.
  constexpr std::uint32_t number() const { return std::uint32_t{port} << 5 | bit; }
  constexpr Register set_high() const { return {base() + 0x508}; }
  constexpr Register set_low() const { return {base() + 0x50C}; }
  constexpr Register levels() const { return {base() + 0x510}; }
  constexpr Register configuration() const { return {base() + 0x700 + std::uintptr_t{4} * bit}; }

  static constexpr std::uint32_t kOutput = 0b11;                    // input buffer disconnected
  static constexpr std::uint32_t kStrongOutput = 3 << 8 | kOutput;  // H0H1: 10 mA instead of 2
  static constexpr std::uint32_t kClockOutput = 0b01;  // a serial master hears its own clock
  static constexpr std::uint32_t kInput = 0;
  static constexpr std::uint32_t kInputPulledUp = 0b1100;
  static constexpr std::uint32_t kAnalog = 0b10;  // nothing drives it, and no level is read
  // Pulled up, open drain: S0D1. TWIM wants its pins as inputs.
  static constexpr std::uint32_t kBusLine = 6 << 8 | 0b1100;
  static constexpr std::uint32_t kDrivenBusLine = kBusLine | 1;

private:
  constexpr std::uintptr_t base() const { return 0x5000'0000 + std::uintptr_t{0x300} * port; }
};
inline constexpr std::uint32_t kNoPin = 1U << 31;  // instead of a pin's number

namespace uart {  // UART0, the one without DMA, to the interface chip, which is a USB serial port
inline constexpr unsigned kInterrupt = 2;
inline constexpr Pin kTransmitPin{0, 6};
inline constexpr Pin kReceivePin{1, 8};
inline constexpr Register kStartReceiving{0x4000'2000};
inline constexpr Register kStartTransmitting{0x4000'2008};
inline constexpr Register kReceived{0x4000'2108};     // event: the next byte is in kReceive
inline constexpr Register kSent{0x4000'211C};         // event: the byte has left
inline constexpr Register kInterruptOn{0x4000'2304};  // reads the enabled interrupts
inline constexpr Register kInterruptOff{0x4000'2308};
inline constexpr std::uint32_t kWhenReceived = 1U << 2;
inline constexpr std::uint32_t kWhenSent = 1U << 7;
inline constexpr Register kEnable{0x4000'2500};
inline constexpr std::uint32_t kOn = 4;
inline constexpr Register kTransmitPinSelect{0x4000'250C};
inline constexpr Register kReceivePinSelect{0x4000'2514};
inline constexpr Register kReceive{0x4000'2518};
inline constexpr Register kTransmit{0x4000'251C};
inline constexpr Register kBaudRate{0x4000'2524};
inline constexpr std::uint32_t k115200 = 0x01D7'E000;
}  // namespace uart

namespace player_uart {  // UARTE1, with DMA, to a sound player on pin 15 of the edge connector
inline constexpr std::uintptr_t kBase = 0x4002'8000;
inline constexpr Pin kTransmitPin{0, 13};
inline constexpr Register kStartTransmitting{kBase + 0x008};
inline constexpr Register kStopTransmitting{kBase + 0x00C};
inline constexpr Register kStopped{kBase + 0x158};  // event: nothing is on its way
inline constexpr Register kEnable{kBase + 0x500};
inline constexpr std::uint32_t kOn = 8;
inline constexpr Register kTransmitPinSelect{kBase + 0x50C};
inline constexpr Register kBaudRate{kBase + 0x524};
inline constexpr std::uint32_t k9600 = 0x0027'5000;  // policy::kPlayerBaud
inline constexpr Register kSendFrom{kBase + 0x544};
inline constexpr Register kSendCount{kBase + 0x548};
}  // namespace player_uart

// An SPI master with DMA (SPIM). Without a clock pin whose input buffer is connected, it sends nothing.
struct Spim {
  std::uintptr_t base;
  unsigned interrupt;

  constexpr Register start() const { return {base + 0x010}; }
  constexpr Register stop() const { return {base + 0x014}; }
  constexpr Register stopped() const { return {base + 0x104}; }  // event
  constexpr Register ended() const {
    return {base + 0x118};
  }  // event: everything has left, and come
  constexpr Register interrupt_on() const { return {base + 0x304}; }
  constexpr Register enable() const { return {base + 0x500}; }
  constexpr Register clock_pin() const { return {base + 0x508}; }
  constexpr Register output_pin() const { return {base + 0x50C}; }
  constexpr Register input_pin() const { return {base + 0x510}; }
  constexpr Register frequency() const { return {base + 0x524}; }
  constexpr Register receive_to() const { return {base + 0x534}; }
  constexpr Register receive_count() const { return {base + 0x538}; }
  constexpr Register received() const { return {base + 0x53C}; }  // bytes
  constexpr Register send_from() const { return {base + 0x544}; }
  constexpr Register send_count() const { return {base + 0x548}; }  // of 16 bits
  constexpr Register configuration() const { return {base + 0x554}; }

  static constexpr std::uint32_t kOn = 7;
  static constexpr std::uint32_t kWhenEnded = 1U << 6;  // interrupt
  static constexpr std::uint32_t k1MHz = 0x1000'0000;
  static constexpr std::uint32_t k4MHz = 0x4000'0000;
  static constexpr std::uint32_t kMode0 = 0;  // and the highest bit first
};
// SPIM2, for a panel of lights; it receives nothing. The board connects its clock, P0.27, to nothing.
inline constexpr Spim kPanelSpi{0x4002'3000, 35};
inline constexpr Pin kPanelClock{0, 27};
// SPIM3, for parts on pins 13 (clock), 14 (input) and 15 (output) of the edge connector. It shares its number with no I2C master.
inline constexpr Spim kPartSpi{0x4002'F000, 47};
inline constexpr Pin kPartClock{0, 17};
inline constexpr Pin kPartInput{0, 1};
inline constexpr Pin kPartOutput = player_uart::kTransmitPin;

struct Timer {
  std::uintptr_t base;

  constexpr Register start() const { return {base}; }
  constexpr Register stop() const { return {base + 0x004}; }
  constexpr Register count() const { return {base + 0x008}; }
  constexpr Register clear() const { return {base + 0x00C}; }
  constexpr Register capture(unsigned channel) const {
    return {base + 0x040 + std::uintptr_t{4} * channel};
  }
  constexpr Register reached(unsigned channel) const {  // event
    return {base + 0x140 + std::uintptr_t{4} * channel};
  }
  constexpr Register shortcuts() const { return {base + 0x200}; }
  constexpr Register interrupts_on() const { return {base + 0x304}; }
  constexpr Register interrupts_off() const { return {base + 0x308}; }
  constexpr Register mode() const { return {base + 0x504}; }
  constexpr Register width() const { return {base + 0x508}; }
  constexpr Register prescaler() const { return {base + 0x510}; }
  constexpr Register value(unsigned channel) const {
    return {base + 0x540 + std::uintptr_t{4} * channel};
  }

  static constexpr std::uint32_t kHz = 16'000'000;
  static constexpr std::uint32_t kEachCount = 0;     // prescaler
  static constexpr std::uint32_t kMicroseconds = 4;  // 16 MHz / 16
  static constexpr std::uint32_t k32Bits = 3;        // 16 after reset
  static constexpr std::uint32_t kCountsTasks = 1;
  static constexpr std::uint32_t kBeginAgain = 1U << 0;  // when channel 0 is reached
  static constexpr std::uint32_t interrupt(unsigned channel) { return 1U << (16 + channel); }
};
// TIMER0, which counts while the core sleeps; SysTick does not.
inline constexpr Timer kClockTimer{0x4000'8000};
inline constexpr unsigned kClockInterrupt = 8;
// TIMER1, which switches to the next row of the lights.
inline constexpr Timer kRowTimer{0x4000'9000};
inline constexpr unsigned kRowInterrupt = 9;
// TIMER2, which counts blocks of sound, and TIMER4, which asks for its samples.
inline constexpr Timer kBlockCounter{0x4000'A000};
inline constexpr Timer kSampleTimer{0x4001'B000};
// TIMER3, which measures echoes in microseconds.
inline constexpr Timer kEchoTimer{0x4001'A000};

namespace gpiote {  // channels that drive a pin by tasks, or report its edges as events
inline constexpr unsigned kInterrupt = 6;
inline constexpr std::uintptr_t kBase = 0x4000'6000;
constexpr Register set_high(unsigned channel) {
  return {kBase + 0x030 + std::uintptr_t{4} * channel};
}
constexpr Register set_low(unsigned channel) {
  return {kBase + 0x060 + std::uintptr_t{4} * channel};
}
constexpr Register edge(unsigned channel) {  // event
  return {kBase + 0x100 + std::uintptr_t{4} * channel};
}
inline constexpr Register kInterruptOn{kBase + 0x304};  // a bit a channel
inline constexpr Register kInterruptOff{kBase + 0x308};
constexpr Register configuration(unsigned channel) {
  return {kBase + 0x510 + std::uintptr_t{4} * channel};
}
inline constexpr std::uint32_t kOff = 0;
constexpr std::uint32_t edges_of(Pin pin) {
  return 1U | pin.number() << 8 | 3U << 16;
}
constexpr std::uint32_t rising_edge_of(Pin pin) {
  return 1U | pin.number() << 8 | 1U << 16;
}
constexpr std::uint32_t drives(Pin pin) {  // initially low
  return 3U | pin.number() << 8;
}
}  // namespace gpiote

namespace ppi {  // connects events to tasks in hardware
inline constexpr std::uintptr_t kBase = 0x4001'F000;
inline constexpr Register kOn{kBase + 0x504};  // a bit a channel
inline constexpr Register kOff{kBase + 0x508};
constexpr Register event(unsigned channel) {
  return {kBase + 0x510 + std::uintptr_t{8} * channel};
}
constexpr Register task(unsigned channel) {
  return {kBase + 0x514 + std::uintptr_t{8} * channel};
}
// No effect before the channel is on.
inline void join(unsigned channel, Register its_event, Register its_task) {
  event(channel).write(static_cast<std::uint32_t>(its_event.address));
  task(channel).write(static_cast<std::uint32_t>(its_task.address));
}
}  // namespace ppi

namespace saadc {  // measures voltages, and writes the results to memory by DMA
inline constexpr std::uintptr_t kBase = 0x4000'7000;
inline constexpr Register kStart{kBase};
inline constexpr Register kSample{kBase + 0x004};
inline constexpr Register kStop{kBase + 0x008};
inline constexpr Register kCalibrate{kBase + 0x00C};
inline constexpr Register kStarted{kBase + 0x100};     // event: it has the results' address
inline constexpr Register kEnded{kBase + 0x104};       // event: all results are there
inline constexpr Register kCalibrated{kBase + 0x110};  // event
inline constexpr Register kStopped{kBase + 0x114};     // event
inline constexpr Register kEnable{kBase + 0x500};
inline constexpr std::uint32_t kOn = 1;
inline constexpr Register kInput{kBase + 0x510};  // of channel 0: 1 is AIN0
inline constexpr std::uint32_t kNoInput = 0;
inline constexpr Register kConfiguration{kBase + 0x518};
// A quarter of the voltage is compared with a quarter of the supply after 10 us of acquisition, which suits sources up to
// 100 kΩ.
inline constexpr std::uint32_t kPartOfSupply = 2U << 8 | 1U << 12 | 2U << 16;
inline constexpr Register kSoundInput{kBase + 0x520};  // of channel 1
inline constexpr Register kSoundConfiguration{kBase + 0x528};
// Four times the voltage is compared with a quarter of the supply, after 3 us of acquisition.
inline constexpr std::uint32_t kFourTimes = 7U << 8 | 1U << 12;
inline constexpr Register kResolution{kBase + 0x5F0};
inline constexpr std::uint32_t k12Bits = 2;
inline constexpr std::uint32_t k14Bits = 3;
inline constexpr Register kOversampling{kBase + 0x5F4};
inline constexpr std::uint32_t kNone = 0;
inline constexpr std::uint32_t kMeanOf8 = 3;
inline constexpr Register kResultsTo{kBase + 0x62C};
inline constexpr Register kResultCount{kBase + 0x630};
}  // namespace saadc

namespace temperature {  // TEMP, of the chip
inline constexpr Register kStart{0x4000'C000};
inline constexpr Register kStop{0x4000'C004};
inline constexpr Register kIsReady{0x4000'C100};   // event
inline constexpr Register kQuarters{0x4000'C508};  // of a degree; a signed number
}  // namespace temperature

namespace watchdog {  // WDT, on the 32,768 Hz oscillator
inline constexpr std::uint32_t kHz = 32'768;
inline constexpr Register kStart{0x4001'0000};
inline constexpr Register kReload{0x4001'0504};  // counts - 1
inline constexpr Register kKicksAsked{0x4001'0508};
inline constexpr std::uint32_t kFirst = 1U << 0;
inline constexpr Register kConfiguration{0x4001'050C};
inline constexpr std::uint32_t kRunsInSleep = 1U << 0;  // but not while a debugger halts the core
inline constexpr Register kKick{0x4001'0600};           // the first one
inline constexpr std::uint32_t kKicked = 0x6E52'4635;
}  // namespace watchdog

// An I2C master with DMA in both directions.
struct Twim {
  std::uintptr_t base;
  unsigned interrupt;

  constexpr Register start_reading() const { return {base + 0x000}; }
  constexpr Register start_writing() const { return {base + 0x008}; }
  constexpr Register stop() const { return {base + 0x014}; }
  constexpr Register stopped() const { return {base + 0x104}; }  // event
  constexpr Register error() const { return {base + 0x124}; }    // event: it has not stopped
  constexpr Register shortcuts() const { return {base + 0x200}; }
  constexpr Register interrupt_on() const { return {base + 0x304}; }
  constexpr Register errors() const { return {base + 0x4C4}; }  // which; write 1 to clear
  constexpr Register enable() const { return {base + 0x500}; }
  constexpr Register clock_pin() const { return {base + 0x508}; }
  constexpr Register data_pin() const { return {base + 0x50C}; }
  constexpr Register frequency() const { return {base + 0x524}; }
  constexpr Register read_to() const { return {base + 0x534}; }
  constexpr Register read_count() const { return {base + 0x538}; }
  constexpr Register bytes_read() const { return {base + 0x53C}; }
  constexpr Register write_from() const { return {base + 0x544}; }
  constexpr Register write_count() const { return {base + 0x548}; }
  constexpr Register bytes_written() const { return {base + 0x54C}; }
  constexpr Register address() const { return {base + 0x588}; }

  static constexpr std::uint32_t kOn = 6;
  static constexpr std::uint32_t kReadWhenWritten = 1U << 7;
  static constexpr std::uint32_t kStopWhenWritten = 1U << 9;
  static constexpr std::uint32_t kStopWhenRead = 1U << 12;
  static constexpr std::uint32_t kWhenStopped = 1U << 1;  // interrupts
  static constexpr std::uint32_t kWhenWrong = 1U << 9;
  // At 400 kHz the clock's low time is shorter than I2C requires (Nordic's anomaly 219).
  static constexpr std::uint32_t k390kHz = 0x0620'0000;
  static constexpr std::uint32_t kAllErrors = 0b111;
};
inline constexpr Twim kTwim0{0x4000'3000, 3};
inline constexpr Twim kTwim1{0x4000'4000, 4};

// A PWM module: a 15-bit counter and four channels, each with a compare value. The module fetches the compare values from
// memory, anew for each period (pins.cpp).
struct Pwm {
  std::uintptr_t base;
  unsigned interrupt;

  static constexpr unsigned kChannels = 4;
  static constexpr unsigned kSequences = 2;

  constexpr Register play() const { return {base + 0x008}; }
  constexpr Register period_ended() const { return {base + 0x118}; }  // event
  constexpr Register shortcuts() const { return {base + 0x200}; }
  constexpr Register interrupt_on() const { return {base + 0x304}; }
  constexpr Register interrupt_off() const { return {base + 0x308}; }
  constexpr Register enable() const { return {base + 0x500}; }
  constexpr Register top() const { return {base + 0x508}; }
  constexpr Register prescaler() const { return {base + 0x50C}; }
  constexpr Register decoder() const { return {base + 0x510}; }
  constexpr Register loop() const { return {base + 0x514}; }
  constexpr Register values(unsigned sequence) const {
    return {base + 0x520 + std::uintptr_t{0x20} * sequence};
  }
  constexpr Register count(unsigned sequence) const {
    return {base + 0x524 + std::uintptr_t{0x20} * sequence};
  }
  // refresh: further periods in which a value is repeated; end_delay: periods after a sequence.
  constexpr Register refresh(unsigned sequence) const {
    return {base + 0x528 + std::uintptr_t{0x20} * sequence};
  }
  constexpr Register end_delay(unsigned sequence) const {
    return {base + 0x52C + std::uintptr_t{0x20} * sequence};
  }
  constexpr Register pin(unsigned channel) const {
    return {base + 0x560 + std::uintptr_t{4} * channel};
  }

  static constexpr std::uint32_t kOn = 1;
  static constexpr std::uint32_t kPeriodEnds = 1U << 6;  // interrupt
  static constexpr std::uint32_t kPlayAgain = 1U << 2;   // when all loops are done
  static constexpr std::uint32_t kMicroseconds = 4;      // 16 MHz / 16
  static constexpr std::uint32_t kValueEach = 2;         // for each channel
  static constexpr std::uint32_t kValuesAndTop = 3;  // three channels, and where the counter ends
  static constexpr std::uint32_t kMostLoops = 0xFFFF;
  // A compare value: the channel is high (kHighUntil) or low from the beginning of the period until the counter reaches
  // the value; for the whole period, if the value is beyond the counter's top.
  static constexpr std::uint16_t kHighUntil = 1U << 15;
  static constexpr std::uint16_t kNever = 0x7FFF;
};
inline constexpr Pwm kPwm0{0x4001'C000, 28};
inline constexpr Pwm kPwm1{0x4002'1000, 33};
inline constexpr Pwm kPwm2{0x4002'2000, 34};

}  // namespace robosync::boards::microbit
