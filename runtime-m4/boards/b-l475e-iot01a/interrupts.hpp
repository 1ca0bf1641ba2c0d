// The interrupts of the board that the firmware uses, for boards/common/vectors.cpp.
#pragma once

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"
#include "runtime-m4/boards/common/vectors.hpp"

extern "C" void Usart1_Handler();

namespace robosync::boards {

inline constexpr std::size_t kInterrupts = 82;
inline constexpr std::array kUsedInterrupts{Interrupt{l475::usart1::kInterrupt, Usart1_Handler}};

}  // namespace robosync::boards
