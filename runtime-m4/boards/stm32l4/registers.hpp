// The peripherals of the STM32L475 and the STM32L476 that the firmware uses. Sources: ST's RM0351 (the registers of both),
// DS10969 and DS10198 (their pins and interrupts).
#pragma once

#include <cstdint>

#include "runtime-m4/port/cortex-m4/register.hpp"

namespace robosync::boards::stm32l4 {

using port::Register;

inline constexpr std::uint32_t kClockHz = 80'000'000;  // of the core, and of both peripheral buses

namespace rcc {  // reset and clock control
inline constexpr Register kControl{0x4002'1000};
inline constexpr std::uint32_t kPllOn = 1U << 24;
inline constexpr std::uint32_t kPllReady = 1U << 25;
inline constexpr Register kConfiguration{0x4002'1008};
inline constexpr std::uint32_t kSwitchToPll = 0b11;
inline constexpr std::uint32_t kRunsOnPll = 0b11 << 2;
inline constexpr Register kPll{0x4002'100C};
// From MSI, which has 4 MHz after reset: times 40, divided by 2.
inline constexpr std::uint32_t kPllOf80MHz = 0b01U | 40U << 8 | 1U << 24;
inline constexpr Register kResetApb2{0x4002'1040};
inline constexpr Register kAhb1{0x4002'1048};
inline constexpr std::uint32_t kDma1 = 1U << 0;
inline constexpr Register kAhb2{0x4002'104C};
inline constexpr std::uint32_t kPortsAToD = 0b1111;
inline constexpr std::uint32_t kAdc = 1U << 13;
inline constexpr Register kApb1{0x4002'1058};
inline constexpr std::uint32_t kTimers2To5 = 0b1111;
inline constexpr std::uint32_t kUsart2 = 1U << 17;
inline constexpr std::uint32_t kUart4 = 1U << 19;
inline constexpr std::uint32_t kI2c1 = 1U << 21;
inline constexpr std::uint32_t kI2c2 = 1U << 22;
inline constexpr Register kApb2{0x4002'1060};
inline constexpr std::uint32_t kSpi1 = 1U << 12;
inline constexpr std::uint32_t kUsart1 = 1U << 14;
inline constexpr std::uint32_t kSystemConfiguration = 1U << 0;
inline constexpr Register kSources{0x4002'1088};
inline constexpr std::uint32_t kAdcBySystemClock = 0b11U << 28;
inline constexpr Register kStatus{0x4002'1094};
inline constexpr std::uint32_t kWatchdogReset = 1U << 29;
inline constexpr std::uint32_t kForgetReset = 1U << 23;

// A peripheral ignores accesses in the first cycles of its clock: the read waits for them.
inline void give_clock(Register clocks, std::uint32_t peripherals) {
  clocks.set(peripherals);
  static_cast<void>(clocks.read());
}
}  // namespace rcc

namespace flash {
inline constexpr Register kAccess{0x4002'2000};
inline constexpr std::uint32_t kFourWaits = 4;  // what 80 MHz need
inline constexpr std::uint32_t kPrefetchAndCaches = 0b111U << 8;
inline constexpr std::uint32_t kDataCache = 1U << 10;
inline constexpr std::uint32_t kEmptyDataCache = 1U << 12;
inline constexpr Register kKey{0x4002'2008};  // both, one after the other, unlock kControl
inline constexpr std::uint32_t kFirstKey = 0x4567'0123;
inline constexpr std::uint32_t kSecondKey = 0xCDEF'89AB;
inline constexpr Register kStatus{0x4002'2010};
inline constexpr std::uint32_t kBusy = 1U << 16;
inline constexpr std::uint32_t kErrors = 0xC3FA;  // write 1 to clear; set bits block programming
inline constexpr Register kControl{0x4002'2014};
inline constexpr std::uint32_t kProgram = 1U << 0;
inline constexpr std::uint32_t kErasePage = 1U << 1;
constexpr std::uint32_t page_of_bank_2(std::uint32_t page) {
  return page << 3 | 1U << 11;
}
inline constexpr std::uint32_t kStart = 1U << 16;
inline constexpr std::uint32_t kLock = 1U << 31;
// The fields above; OPTLOCK, next to kLock, reads as 1 all the time.
inline constexpr std::uint32_t kOrder =
    kProgram | kErasePage | page_of_bank_2(0xFF) | kStart | kLock;
inline constexpr Register kDamage{0x4002'2018};
inline constexpr std::uint32_t kInBank2 = 1U << 19;
inline constexpr std::uint32_t kDamaged = 1U << 31;   // uncorrectable: NMI; write 1 to clear
inline constexpr std::uint32_t kBank2 = 0x0808'0000;  // the firmware is in bank 1
inline constexpr std::uint32_t kBytesOfBank = 512 * 1024;
}  // namespace flash

struct Port {  // of pins
  std::uintptr_t base;
  constexpr Register mode() const { return {base}; }         // 2 bits a pin
  constexpr Register open() const { return {base + 0x04}; }  // a bit a pin: open drain
  constexpr Register pulls() const { return {base + 0x0C}; }
  constexpr Register levels() const { return {base + 0x10}; }
  constexpr Register change() const { return {base + 0x18}; }  // 1 << pin: high; 1 << 16 + pin: low
  // 4 bits a pin, of eight pins.
  constexpr Register function(unsigned pin) const {
    return {base + 0x20 + std::uintptr_t{4} * (pin / 8)};
  }
  constexpr Register analog() const {
    return {base + 0x2C};
  }  // a bit a pin: connected to the converters
};
inline constexpr Port kPortA{0x4800'0000};
inline constexpr Port kPortB{0x4800'0400};
inline constexpr Port kPortC{0x4800'0800};
inline constexpr Port kPortD{0x4800'0C00};
constexpr std::uint32_t number_of(Port port) {  // A: 0
  return static_cast<std::uint32_t>((port.base - kPortA.base) / (kPortB.base - kPortA.base));
}
inline constexpr std::uint32_t kModeOfAnalog = 0b11;
inline constexpr std::uint32_t kModeOfInput = 0b00;
inline constexpr std::uint32_t kModeOfOutput = 0b01;
inline constexpr std::uint32_t kModeOfFunction = 0b10;
inline constexpr std::uint32_t kPullUp = 0b01;

// A general-purpose timer, 2 to 5, with four channels.
struct Timer {
  std::uintptr_t base;
  constexpr Register control() const { return {base}; }
  constexpr Register event() const { return {base + 0x14}; }
  // A byte a channel, of two channels.
  constexpr Register mode(unsigned channel) const {
    return {base + 0x18 + std::uintptr_t{4} * (channel / 2)};
  }
  constexpr Register enable() const { return {base + 0x20}; }  // 4 bits a channel
  constexpr Register count() const { return {base + 0x24}; }
  constexpr Register prescaler() const { return {base + 0x28}; }
  constexpr Register last() const { return {base + 0x2C}; }  // last count of a period
  constexpr Register compare(unsigned channel) const {
    return {base + 0x34 + std::uintptr_t{4} * channel};
  }

  static constexpr unsigned kChannels = 4;  // numbered from 0; ST numbers them from 1
  static constexpr std::uint32_t kOn =
      1U << 0 | 1U << 7;  // and a new `last` takes effect with the next period
  static constexpr std::uint32_t kUpdate = 1U << 0;
  static constexpr std::uint32_t kOutput = 1U << 0;
  // High while the count is below `compare`.
  static constexpr std::uint32_t kPulse = 0b110U << 4;
  // The same, and a new `compare` takes effect with the next period.
  static constexpr std::uint32_t kPulseFromNextPeriod = kPulse | 1U << 3;
};
inline constexpr Timer kTimer2{0x4000'0000};
inline constexpr Timer kTimer3{0x4000'0400};
inline constexpr Timer kTimer4{0x4000'0800};
inline constexpr Timer kTimer5{0x4000'0C00};

namespace adc {                                 // ADC1, and registers it shares with ADC2
inline constexpr Register kState{0x5004'0000};  // write 1 to clear
inline constexpr std::uint32_t kReady = 1U << 0;
inline constexpr std::uint32_t kEnded = 1U << 3;  // of the whole sequence
inline constexpr Register kControl{0x5004'0008};  // in deep power-down after reset
inline constexpr std::uint32_t kOn = 1U << 0;
inline constexpr std::uint32_t kStart = 1U << 2;
inline constexpr std::uint32_t kStop = 1U << 4;
inline constexpr std::uint32_t kRegulator = 1U << 28;
inline constexpr std::uint32_t kCalibrate = 1U << 31;
inline constexpr Register kConfiguration{0x5004'000C};
// 12 bits; a new value overwrites one that was not read; bit 31 has its reset value.
inline constexpr std::uint32_t kNewestOf12Bits = 1U << 12 | 1U << 31;
inline constexpr unsigned kSampleBits = 3;
inline constexpr unsigned kSamplesARegister = 10;
inline constexpr Register samples(unsigned channel) {  // a field a channel
  return {0x5004'0014 + std::uintptr_t{4} * (channel / kSamplesARegister)};
}
inline constexpr std::uint32_t k640Cycles = 0b111;
inline constexpr Register kSequence{0x5004'0030};
// Two conversions, of which kData keeps the second. ES0250: the first one after a pause of more than a millisecond may be wrong,
// so it is one of the internal channel 0, with the sampling time that it has after reset, the shortest.
constexpr std::uint32_t discard_and_convert(unsigned channel) {
  return channel << 12 | 0U << 6 | 1U;
}
inline constexpr Register kData{0x5004'0040};
inline constexpr Register kCommon{0x5004'0308};
inline constexpr std::uint32_t kClockByTwo = 1U << 18;
}  // namespace adc

struct DmaChannel {  // of DMA1
  unsigned number;   // from 1
  std::uintptr_t base;
  constexpr DmaChannel(unsigned from_1)  // NOLINT(google-explicit-constructor)
      : number(from_1), base(0x4002'0008 + std::uintptr_t{20} * (from_1 - 1)) {}
  constexpr Register control() const { return {base}; }
  constexpr Register count() const { return {base + 4}; }  // bytes that are left
  constexpr Register peripheral() const { return {base + 8}; }
  constexpr Register memory() const { return {base + 12}; }

  static constexpr std::uint32_t kOn = 1U << 0;
  static constexpr std::uint32_t kBytesFromMemory = 1U << 7 | 1U << 4;
  static constexpr std::uint32_t kBytesToMemory = 1U << 7;
  static constexpr std::uint32_t kInterrupts =
      1U << 1 | 1U << 3;  // when all bytes are moved, or it fails
  // Its flags in kDmaState.
  constexpr std::uint32_t ended() const { return 1U << (4 * (number - 1) + 1); }
  constexpr std::uint32_t failed() const { return 1U << (4 * (number - 1) + 3); }
  // … and in kDmaForget.
  constexpr std::uint32_t flags() const { return 0xFU << 4 * (number - 1); }
};
inline constexpr Register kDmaState{0x4002'0000};
inline constexpr Register kDmaForget{
    0x4002'0004};  // 4 bits a channel: a channel that failed stays off until they are cleared
inline constexpr Register kDmaSelect{0x4002'00A8};  // 4 bits a channel; channel 1 has the lowest
inline constexpr std::uint32_t kDmaForI2c = 3;

struct I2cRegisters {
  std::uintptr_t base;
  unsigned event_interrupt;  // the error interrupt is the next one
  std::uint32_t clock;       // of rcc::kApb1
  constexpr Register control() const { return {base}; }
  constexpr Register transfer() const { return {base + 0x04}; }
  constexpr Register timing() const { return {base + 0x10}; }
  constexpr Register state() const { return {base + 0x18}; }
  constexpr Register forget() const { return {base + 0x1C}; }
  constexpr Register received() const { return {base + 0x24}; }
  constexpr Register send() const { return {base + 0x28}; }

  // NACK, stop, end of the write, and errors interrupt; DMA moves the bytes.
  static constexpr std::uint32_t kOn = 1U << 0 | 0b1111U << 4 | 1U << 14 | 1U << 15;
  static constexpr std::uint32_t kRead = 1U << 10;
  static constexpr std::uint32_t kStart = 1U << 13;
  static constexpr std::uint32_t kStopBehind = 1U << 25;
  static constexpr std::uint32_t to(std::uint32_t address, std::size_t bytes) {
    return address << 1 | static_cast<std::uint32_t>(bytes) << 16;
  }
  // In counts of 80 MHz / 2: low for 60, high for 36. With the master's delay in sampling the clock, that is 390 kHz at most;
  // data changes 225 ns after the clock's edge, and is stable 400 ns before the next one.
  static constexpr std::uint32_t kAlmost400kHz = 1U << 28 | 15U << 20 | 9U << 16 | 35U << 8 | 59U;
  static constexpr std::uint32_t kRefused = 1U << 4;
  static constexpr std::uint32_t kStopped = 1U << 5;
  static constexpr std::uint32_t kWritten = 1U << 6;
  static constexpr std::uint32_t kBusError = 1U << 8;
  static constexpr std::uint32_t kOutvoted = 1U << 9;  // another master drives the lines
};
inline constexpr Port kPortOfI2c = kPortB;
inline constexpr std::uint32_t kFunctionOfI2c = 4;
inline constexpr I2cRegisters kI2c1{0x4000'5400, 31, rcc::kI2c1};
inline constexpr I2cRegisters kI2c2{0x4000'5800, 33, rcc::kI2c2};

namespace exti {  // edge interrupts: a line for each pin number, connected to one port
inline constexpr Register port(unsigned line) {  // 4 bits a line
  return {0x4001'0008 + std::uintptr_t{4} * (line / 4)};
}
inline constexpr Register kMask{0x4001'0400};  // 1: it interrupts
inline constexpr Register kRising{0x4001'0408};
inline constexpr Register kFalling{0x4001'040C};
inline constexpr Register kPending{0x4001'0414};  // write 1 to clear
// For lines 2 and 4, 5 to 9, and 10 to 15.
inline constexpr unsigned kInterrupt2 = 8;
inline constexpr unsigned kInterrupt4 = 10;
inline constexpr unsigned kInterrupt5To9 = 23;
inline constexpr unsigned kInterrupt10To15 = 40;
}  // namespace exti

struct Usart {
  std::uintptr_t base;
  unsigned interrupt;
  Register clocks;      // in rcc
  std::uint32_t clock;  // its bit in `clocks`

  constexpr Register control() const { return {base}; }
  constexpr Register control3() const { return {base + 0x08}; }
  constexpr Register baud_divider() const { return {base + 0x0C}; }
  constexpr Register state() const { return {base + 0x1C}; }
  constexpr Register received() const { return {base + 0x24}; }
  constexpr Register transmit() const { return {base + 0x28}; }

  static constexpr std::uint32_t kSendsOnly = 1U << 0 | 1U << 3;
  static constexpr std::uint32_t kOn =
      kSendsOnly | 1U << 2 | 1U << 5;  // a received byte interrupts
  static constexpr std::uint32_t kInterruptWhenEmpty = 1U << 7;
  // A byte that comes too early overwrites the one before, and no error flag has to be cleared.
  static constexpr std::uint32_t kNoOverrun = 1U << 12;
  static constexpr std::uint32_t kReceived = 1U << 5;
  static constexpr std::uint32_t kEmpty = 1U << 7;
  static constexpr std::uint32_t divider_of(std::uint32_t baud) {
    return (kClockHz + baud / 2) / baud;
  }
};
inline constexpr Usart kUsart1{0x4001'3800, 37, rcc::kApb2, rcc::kUsart1};
inline constexpr Usart kUsart2{0x4000'4400, 38, rcc::kApb1, rcc::kUsart2};
inline constexpr Usart kUart4{0x4000'4C00, 52, rcc::kApb1, rcc::kUart4};

// SPI1: for a panel of lights, without a clock pin, and receiving nothing; or for parts. Both need pin 11 of the header.
namespace spi {
inline constexpr Register kControl{0x4001'3000};
inline constexpr std::uint32_t kHz = kClockHz / 32;
// Transmit only; master, with the select pin ignored; enabled.
inline constexpr std::uint32_t kSendsAt2500kHz =
    0b11U << 14 | 0b11U << 8 | 1U << 6 | 0b100U << 3 | 1U << 2;
inline constexpr Register kControl2{0x4001'3004};
inline constexpr std::uint32_t kBytesByDma = 7U << 8 | 1U << 1;
// Both ways; master, with the select pin ignored; enabled; mode 0. Twice as fast would be 1.25 MHz.
inline constexpr std::uint32_t kBothWaysAt625kHz = 0b11U << 8 | 1U << 6 | 0b110U << 3 | 1U << 2;
// … and a single byte in the FIFO counts as received.
inline constexpr std::uint32_t kBytesByDmaBothWays = kBytesByDma | 1U << 12 | 1U << 0;
inline constexpr Register kState{0x4001'3008};
inline constexpr std::uint32_t kBusy = 1U << 7;
inline constexpr Register kData{0x4001'300C};
inline constexpr DmaChannel kDma{3};
inline constexpr DmaChannel kDmaToMemory{2};
inline constexpr unsigned kInterrupt = 12;  // of kDmaToMemory
inline constexpr std::uint32_t kDmaForSpi = 1;
}  // namespace spi

namespace iwdg {  // the independent watchdog, on its own 32 kHz oscillator
inline constexpr Register kKey{0x4000'3000};
inline constexpr std::uint32_t kStart = 0xCCCC;
inline constexpr std::uint32_t kUnlock = 0x5555;
inline constexpr std::uint32_t kKick = 0xAAAA;  // also locks
inline constexpr Register kPrescaler{0x4000'3004};
inline constexpr std::uint32_t kByFour = 0;
inline constexpr Register kReload{0x4000'3008};
inline constexpr std::uint32_t kHz = 32'000 / 4;
}  // namespace iwdg

}  // namespace robosync::boards::stm32l4
