// How the board of this firmware wires the chip: boards/NAME/wiring.hpp, which says in stm32l4::wiring
//
//   kName            of the board
//   kOutputs         pins that give pulses, by the timers 2 to 5
//   kEnable          the one for the enable input of a chip
//   kHeldHigh        pins of the chip that are high from the start on, and stay so
//   kInputs          pins that are read, and whose edges end an echo; kEchoInterrupts: those of all their lines
//   kAnalogInputs    of ADC1
//   kBuses           I2C, at least one, two at most
//   kLink            the serial line that the board makes a serial port of USB
//   kPlayer          the one to a sound player: its transmitter alone
//   kPanel           where SPI1's data go to a panel of lights; one of kOutputs
//
// Tables say how long they are: those whose length std::array finds out by itself, GCC 12 puts in RAM.
#pragma once

#include ROBOSYNC_BOARD_WIRING
