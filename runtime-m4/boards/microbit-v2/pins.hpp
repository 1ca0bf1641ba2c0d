// The pins for pulses: those of the edge connector that nothing on the board uses, numbered as printed there. The modules
// PWM0 and PWM1 drive them. A frame is 20 ms.
//
// From reset until start() they are not driven.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::pins {

// Sets all pins low, except the one at an enable input (boards::Board::enable()), which is high.
void start();

// The pulse in microseconds, from the next frame on, or the one after: no frame contains part of a pulse. 0 switches off
// immediately; after that, the pin gives pulses again 60 ms later at the earliest. No effect on pins that are not for pulses.
void write(std::uint16_t pin, std::uint32_t pulse_us);
// The last pulse that was written.
std::uint32_t read(std::uint16_t pin);

// Nothing drives the pin between let_go() and take_back(); then it is low. Meanwhile it is pulled up if its level is read. It
// must give no pulses. No effect on other pins.
void let_go(std::uint16_t pin, Reads what);
void take_back(std::uint16_t pin);

// Sets the pin at an enable input low (on) or high (off). No effect on other pins.
void enable(std::uint16_t pin, bool on);

// Sets the select pin of a part on SPI low (on) or high: the pin at an enable input, or one for pulses, which must give none. No
// effect on other pins.
void select(std::uint16_t pin, bool on);
// Sets a pin for pulses that was a select pin low again. No effect on other pins.
void end_select(std::uint16_t pin);

// The chip's pin; null if it is not for pulses.
const Pin* chip_pin(std::uint16_t pin);

// Switches all of them off, immediately, until start(). [any processor state]
void switch_off();

// A module's period has ended. [its interrupt]
void on_period_end();

}  // namespace robosync::boards::microbit::pins
