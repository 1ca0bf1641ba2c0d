// The board's interrupts that the firmware uses, for boards/common/vectors.cpp.
#pragma once

#include "runtime-m4/boards/common/vectors.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"

extern "C" {
void Uart0Receive_Handler();
void Uart0Transmit_Handler();
void Uart1Transmit_Handler();
void Timer0_Handler();
// Unused in the firmware; the kernel's tests define it (mps2_an386.ld).
void TestsOwn_Handler();
}

namespace robosync::boards {

inline constexpr std::size_t kInterrupts = 32;
inline constexpr std::array kUsedInterrupts{
    Interrupt{mps2::kUart0ReceiveInterrupt, Uart0Receive_Handler},
    Interrupt{mps2::kUart0TransmitInterrupt, Uart0Transmit_Handler},
    Interrupt{mps2::kUart1TransmitInterrupt, Uart1Transmit_Handler},
    Interrupt{mps2::kTimer0Interrupt, Timer0_Handler},
    Interrupt{mps2::kFreeInterrupt, TestsOwn_Handler}};

}  // namespace robosync::boards
