// The board's interrupts that the firmware uses, for boards/common/vectors.cpp. TIMER0's only ends the core's sleep,
// and is never taken.
#pragma once

#include "runtime-m4/boards/common/vectors.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

extern "C" void Uart0_Handler();
extern "C" void Pwm_Handler();
extern "C" void Echo_Handler();
extern "C" void Row_Handler();
extern "C" void EdgeBus_Handler();
extern "C" void OwnBus_Handler();
extern "C" void Spi_Handler();

namespace robosync::boards {

inline constexpr std::size_t kInterrupts = 48;
inline constexpr std::array kUsedInterrupts{Interrupt{microbit::uart::kInterrupt, Uart0_Handler},
                                            Interrupt{microbit::gpiote::kInterrupt, Echo_Handler},
                                            Interrupt{microbit::kRowInterrupt, Row_Handler},
                                            Interrupt{microbit::kTwim0.interrupt, OwnBus_Handler},
                                            Interrupt{microbit::kTwim1.interrupt, EdgeBus_Handler},
                                            Interrupt{microbit::kPartSpi.interrupt, Spi_Handler},
                                            Interrupt{microbit::kPwm0.interrupt, Pwm_Handler},
                                            Interrupt{microbit::kPwm1.interrupt, Pwm_Handler}};

}  // namespace robosync::boards
