// The peripherals of the MPS2 board with FPGA image AN386 (Cortex-M4) that the firmware uses.
// Sources: application note AN386, and the CMSDK manual for UART and watchdog.
#pragma once

#include <cstddef>
#include <cstdint>

namespace robosync::boards::mps2 {

inline constexpr std::uint32_t kClockHz = 25'000'000;

struct UartRegisters {  // CMSDK APB UART
  volatile std::uint32_t data;
  volatile std::uint32_t state;
  volatile std::uint32_t control;
  volatile std::uint32_t interrupt;  // read: pending, write 1: clear
  volatile std::uint32_t baud_divider;
};
inline constexpr std::uintptr_t kUart0 = 0x4000'4000;
inline constexpr unsigned kUart0ReceiveInterrupt = 0;
inline constexpr unsigned kUart0TransmitInterrupt = 1;
inline constexpr std::uintptr_t kUart1 = 0x4000'5000;
inline constexpr unsigned kUart1TransmitInterrupt = 3;
inline constexpr std::uint32_t kUartStateTransmitFull = 1U << 0;
inline constexpr std::uint32_t kUartStateReceiveFull = 1U << 1;
inline constexpr std::uint32_t kUartControlOn = 0b1111;  // transmitter, receiver, their interrupts
inline constexpr std::uint32_t kUartSendsOnly = 0b0101;  // transmitter, its interrupt
inline constexpr std::uint32_t kUartTransmitted = 1U << 0;
inline constexpr std::uint32_t kUartReceived = 1U << 1;

// SBCon: two open-drain lines that software drives.
inline constexpr std::uintptr_t kI2c0 = 0x4002'A000;  // QEMU attaches -device to this bus
inline constexpr std::uintptr_t kI2cLines = 0x00;  // read: their state; write 1: releases the line
inline constexpr std::uintptr_t kI2cPull = 0x04;   // write 1: pulls the line low
inline constexpr std::uint32_t kI2cClock = 1U << 0;
inline constexpr std::uint32_t kI2cData = 1U << 1;

// PL022 (ARM DDI 0194), whose clock is the processor's.
inline constexpr std::uintptr_t kSpi0 = 0x4002'7000;  // shield 1; QEMU attaches -device to this bus
inline constexpr std::uintptr_t kSpiControl0 = 0x00, kSpiControl1 = 0x04, kSpiData = 0x08,
                                kSpiStatus = 0x0C, kSpiPrescale = 0x10;
inline constexpr std::uint32_t kSpiBytes = 8 - 1;  // frames of 8 bits, mode 0
inline constexpr std::uint32_t kSpiOn = 1U << 1;   // as master
inline constexpr std::uint32_t kSpiSentAll = 1U << 0;
inline constexpr std::uint32_t kSpiReceived = 1U << 2;

struct WatchdogRegisters {  // CMSDK APB watchdog
  volatile std::uint32_t load;
  volatile std::uint32_t value;
  volatile std::uint32_t control;
  volatile std::uint32_t interrupt_clear;
  volatile std::uint32_t raw_interrupt;
  volatile std::uint32_t interrupt;
  std::uint32_t reserved[762];
  volatile std::uint32_t lock;
};
static_assert(offsetof(WatchdogRegisters, lock) == 0xC00);
inline constexpr std::uintptr_t kWatchdog = 0x4000'8000;
inline constexpr std::uint32_t kWatchdogOn = 0b11;  // first time-out: NMI, second: reset
inline constexpr std::uint32_t kWatchdogUnlock = 0x1ACC'E551;

struct TimerRegisters {  // CMSDK APB timer: counts down, and restarts from `reload`
  volatile std::uint32_t control;
  volatile std::uint32_t value;  // timer 1's is robosync_clock in the linker script
  volatile std::uint32_t reload;
  volatile std::uint32_t interrupt;
};
inline constexpr std::uintptr_t kTimer0 = 0x4000'0000;
inline constexpr std::uintptr_t kTimerControl = 0x00, kTimerValue = 0x04, kTimerReload = 0x08,
                                kTimerInterrupt = 0x0C;
inline constexpr std::uintptr_t kTimer1 = 0x4000'1000;
inline constexpr unsigned kTimer0Interrupt = 8;
inline constexpr unsigned kFreeInterrupt = 20;  // no device uses it
inline constexpr std::uint32_t kTimerOn = 1U << 0;
inline constexpr std::uint32_t kTimerInterrupts = 1U << 3;

struct OneShotRegisters {  // CMSDK APB dual timer, the first of the two: counts down
  volatile std::uint32_t load;
  volatile std::uint32_t value;
  volatile std::uint32_t control;
  volatile std::uint32_t interrupt_clear;
};
inline constexpr std::uintptr_t kDualTimer = 0x4000'2000;
inline constexpr unsigned kDualTimerInterrupt = 10;
inline constexpr std::uint32_t kOneShot = 0b10'0011;  // one-shot, 32 bits, interrupt enabled
inline constexpr std::uint32_t kOneShotOn = kOneShot | 1U << 7;

template <typename Registers>
Registers& at(std::uintptr_t address) {
  return *reinterpret_cast<Registers*>(address);
}

}  // namespace robosync::boards::mps2
