// The interrupts of the board that the firmware uses, for boards/common/vectors.cpp.
#pragma once

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"
#include "runtime-m4/boards/common/vectors.hpp"

extern "C" void Usart1_Handler();
extern "C" void Uart4_Handler();
extern "C" void Echo_Handler();
extern "C" void HeaderBus_Handler();
extern "C" void OwnBus_Handler();

namespace robosync::boards {

inline constexpr std::size_t kInterrupts = 82;
inline constexpr std::array kUsedInterrupts{
    Interrupt{l475::kUsart1.interrupt, Usart1_Handler},
    Interrupt{l475::kUart4.interrupt, Uart4_Handler},
    Interrupt{l475::exti::kInterrupt2, Echo_Handler},
    Interrupt{l475::exti::kInterrupt4, Echo_Handler},
    Interrupt{l475::exti::kInterrupt5To9, Echo_Handler},
    Interrupt{l475::exti::kInterrupt10To15, Echo_Handler},
    Interrupt{l475::kI2c1.event_interrupt, HeaderBus_Handler},
    Interrupt{l475::kI2c1.event_interrupt + 1, HeaderBus_Handler},
    Interrupt{l475::kI2c2.event_interrupt, OwnBus_Handler},
    Interrupt{l475::kI2c2.event_interrupt + 1, OwnBus_Handler}};

}  // namespace robosync::boards
