// How this firmware's board wires the chip: boards/NAME/wiring.hpp. It defines in stm32l4::wiring
//
//   kName            the board's name
//   kOutputs         pins for pulses, driven by timers 2 to 5
//   kEnable          the pin for the enable input of a chip
//   kHeldHigh        pins of the chip that are high from start() on, and stay high
//   kInputs          pins that are read, and whose edges end an echo; kEchoInterrupts: the interrupts of all their lines
//   kAnalogInputs    inputs of ADC1
//   kBuses           I2C buses, at least one, at most two
//   kLink            the serial line that the board connects to USB as a serial port
//   kPlayer          the serial line to a sound player: only its transmitter
//   kPanel           SPI1's data pin, for a panel of lights; one of kOutputs
//   kSpi             SPI1's pins, for parts; its input is one of kInputs, too
//
// Tables state their length: GCC 12 puts those whose length std::array deduces in RAM.
#pragma once

#include ROBOSYNC_BOARD_WIRING
