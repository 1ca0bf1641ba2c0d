// How ST's B-L475E-IOT01A wires its STM32L475, according to UM2153 (boards/stm32l4/wiring.hpp describes the tables). QEMU
// emulates the board, without timers and watchdog.
#pragma once

#include <array>

#include "runtime-m4/boards/stm32l4/wires.hpp"

namespace robosync::boards::stm32l4::wiring {

inline constexpr const char* kName = "b-l475e-iot01a";

// 13 is also the green LED. 5 belongs to the debugger until start(). The chip pulls it up in that time, so the board's profile
// allows only servo pulses on it.
inline constexpr std::array<Output, 9> kOutputs{
    Output{0, kPortA, 1, 2, kTimer5, 1},  Output{2, kPortD, 14, 2, kTimer4, 2},
    Output{3, kPortB, 0, 2, kTimer3, 2},  Output{4, kPortA, 3, 2, kTimer5, 3},
    Output{5, kPortB, 4, 2, kTimer3, 0},  Output{6, kPortB, 1, 2, kTimer3, 3},
    Output{10, kPortA, 2, 2, kTimer5, 2}, Output{11, kPortA, 7, 2, kTimer3, 1},
    Output{13, kPortA, 5, 1, kTimer2, 0}};
inline constexpr Enable kEnable{45, kPortC, 0};  // A5

// XSHUT, which holds the board's distance sensor (VL53L0X) in standby while it is low.
inline constexpr std::array<Pin, 1> kHeldHigh{Pin{kPortC, 6}};

// 9 belongs to the debugger until start(). 32 is the blue button; it is on no header.
inline constexpr std::array<Input, 5> kInputs{Input{7, kPortA, 4}, Input{8, kPortB, 2},
                                              Input{9, kPortA, 15}, Input{12, kPortA, 6},
                                              Input{32, kPortC, 13}};
inline constexpr std::array<unsigned, 4> kEchoInterrupts{
    exti::kInterrupt2, exti::kInterrupt4, exti::kInterrupt5To9, exti::kInterrupt10To15};

// A0 to A4.
inline constexpr std::array<AnalogInput, 5> kAnalogInputs{
    AnalogInput{40, kPortC, 5, 14}, AnalogInput{41, kPortC, 4, 13}, AnalogInput{42, kPortC, 3, 4},
    AnalogInput{43, kPortC, 2, 3}, AnalogInput{44, kPortC, 1, 2}};

// 0: the Arduino header's, D15 and D14; 1: the bus of the parts on the board.
inline constexpr std::array<Bus, 2> kBuses{
    Bus{kI2c1, 8, 9, {6}, {7}},
    Bus{kI2c2, 10, 11, {4}, {5}},
};

inline constexpr SerialPins kLink{kUsart1, kPortB, 7, 6, 7};  // to the ST-LINK
inline constexpr SerialPins kPlayer{kUart4, kPortA, 8, 0};    // D1
inline constexpr PanelPin kPanel{11, 5};
inline constexpr SpiPins kSpi{13, 11, {kPortA, 6}, 5};  // D13, D11, D12

}  // namespace robosync::boards::stm32l4::wiring
