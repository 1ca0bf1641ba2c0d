// The pins that give pulses (wiring::kOutputs), by the timers 2 to 5. A frame is 20 ms.
//
// From reset until start() they are not driven. One that belongs to the debugger may be pulled up then, by the chip: so a board's
// profile lets that one have servo pulses only.
//
// One pin is for the enable input of a chip on the bus, and nothing else (wiring::kEnable). Others, which no program knows, are high
// from the start on, and stay so, whatever is switched off (wiring::kHeldHigh).
#pragma once

#include <cstdint>

namespace robosync::boards::stm32l4::pins {

// All pins low, but those that are held high, and the one at an enable input (boards::Board::enable()), which is high. Their ports
// have their clock.
void start();

// The pulse in microseconds, from the next frame on: no frame has part of one. 0 is off, at once. A pin that gives no
// pulses is left alone. [under a lock: pins of a timer share its registers]
void write(std::uint16_t pin, std::uint32_t pulse_us);
std::uint32_t read(std::uint16_t pin);

// One pulse of 11 or 12 us, from now on; the timer ends it. [under a lock, as above]
void pulse(std::uint16_t pin);

// The pin has this function of its port until it is taken back, when its timer has it again. It gives no pulses.
void hand_over(std::uint16_t pin, std::uint32_t function);
void take_back(std::uint16_t pin);

// The pin at an enable input is low from now on, or high. Another one is left alone.
void enable(std::uint16_t pin, bool on);

// All of them, at once. Any state of the machine.
void switch_off();

}  // namespace robosync::boards::stm32l4::pins
