// The pins that give pulses: those of the edge connector that nothing on the board uses, numbered as printed there, by the
// modules PWM0 and PWM1. A frame is 20 ms.
//
// From reset until start() they are not driven.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::pins {

// All pins low, but the one at an enable input (boards::Board::enable()), which is high.
void start();

// The pulse in microseconds, from the next frame on, or the one after: no frame has part of one. 0 is off, at once; who was
// switched off gives pulses again 60 ms later at the earliest. A pin that gives no pulses is left alone.
void write(std::uint16_t pin, std::uint32_t pulse_us);
// What was written last.
std::uint32_t read(std::uint16_t pin);

// Nobody drives it until it is taken back: it is low then. It gives no pulses. What is no output is left alone.
void let_go(std::uint16_t pin);
void take_back(std::uint16_t pin);

// The pin at an enable input is low from now on, or high. Another one is left alone.
void enable(std::uint16_t pin, bool on);

// Which pin of the chip it is; null: none that gives pulses.
const Pin* chip_pin(std::uint16_t pin);

// All of them off, at once, and for good: until start(). Any state of the machine.
void switch_off();

// A module's period has ended. [its interrupt]
void on_period_end();

}  // namespace robosync::boards::microbit::pins
