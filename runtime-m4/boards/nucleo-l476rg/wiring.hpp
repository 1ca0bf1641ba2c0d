// How ST's Nucleo-L476RG wires its STM32L476, according to UM1724 (boards/stm32l4/wiring.hpp describes the tables). Its Arduino
// header has no usable D0 and D1: their pins are the line to the ST-LINK.
#pragma once

#include <array>

#include "runtime-m4/boards/stm32l4/wires.hpp"

namespace robosync::boards::stm32l4::wiring {

inline constexpr const char* kName = "nucleo-l476rg";

// 13 is also the green LED. 3 and 5 belong to the debugger until start(). The chip pulls up 5 in that time, so the board's
// profile allows only servo pulses on it. 4, 9 and 11 share one timer channel, which 11 uses.
inline constexpr std::array<Output, 6> kOutputs{
    Output{3, kPortB, 3, 1, kTimer2, 1},  Output{5, kPortB, 4, 2, kTimer3, 0},
    Output{6, kPortB, 10, 1, kTimer2, 2}, Output{10, kPortB, 6, 2, kTimer4, 0},
    Output{11, kPortA, 7, 2, kTimer3, 1}, Output{13, kPortA, 5, 1, kTimer2, 0}};
inline constexpr Enable kEnable{45, kPortC, 0};  // A5

inline constexpr std::array<Pin, 0> kHeldHigh{};

// 32 is the blue button; it is on no header, and the board pulls it up.
inline constexpr std::array<Input, 6> kInputs{Input{2, kPortA, 10}, Input{4, kPortB, 5},
                                              Input{7, kPortA, 8},  Input{9, kPortC, 7},
                                              Input{12, kPortA, 6}, Input{32, kPortC, 13}};
inline constexpr std::array<unsigned, 2> kEchoInterrupts{exti::kInterrupt5To9,
                                                         exti::kInterrupt10To15};

// A0 to A4.
inline constexpr std::array<AnalogInput, 5> kAnalogInputs{
    AnalogInput{40, kPortA, 0, 5}, AnalogInput{41, kPortA, 1, 6}, AnalogInput{42, kPortA, 4, 9},
    AnalogInput{43, kPortB, 0, 15}, AnalogInput{44, kPortC, 1, 2}};

// D15 and D14.
inline constexpr std::array<Bus, 1> kBuses{Bus{kI2c1, 8, 9, {6}, {7}}};

inline constexpr SerialPins kLink{kUsart2, kPortA, 7, 2, 3};  // to the ST-LINK
inline constexpr SerialPins kPlayer{kUsart1, kPortA, 7, 9};   // D8
inline constexpr PanelPin kPanel{11, 5};
inline constexpr SpiPins kSpi{13, 11, {kPortA, 6}, 5};  // D13, D11, D12

}  // namespace robosync::boards::stm32l4::wiring
