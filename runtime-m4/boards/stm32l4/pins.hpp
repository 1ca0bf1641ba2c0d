// The pins for pulses (wiring::kOutputs), driven by timers 2 to 5. A frame is 20 ms.
//
// From reset until start() they are not driven. In that time the chip may pull up a debugger pin, so a board's profile allows
// only servo pulses on it.
//
// One pin drives the enable input of a chip on the bus, and nothing else (wiring::kEnable). Others, which programs cannot use,
// are high from start() on and stay high, whatever is switched off (wiring::kHeldHigh).
#pragma once

#include <cstdint>

namespace robosync::boards::stm32l4::pins {

// Sets all pins low, except those that are held high and the one at an enable input (boards::Board::enable()), which is high.
// Their ports must have their clocks.
void start();

// The pulse in microseconds, from the next frame on: no frame contains part of a pulse. 0 switches off immediately. No effect
// on pins that are not for pulses. [under a lock: pins of a timer share its registers]
void write(std::uint16_t pin, std::uint32_t pulse_us);
std::uint32_t read(std::uint16_t pin);

// One pulse of 11 or 12 us, starting now; the timer ends it. [under a lock, as above]
void pulse(std::uint16_t pin);

// Gives the pin another function of its port, or makes it the select pin of a part on SPI, which is high, until take_back()
// returns it to its timer. It must give no pulses.
void hand_over(std::uint16_t pin, std::uint32_t function);
void begin_select(std::uint16_t pin);
void take_back(std::uint16_t pin);

// Sets the pin at an enable input low (on) or high (off). No effect on other pins.
void enable(std::uint16_t pin, bool on);

// Sets a select pin low (on) or high: that pin, or the one at an enable input.
void select(std::uint16_t pin, bool on);

// All pins, immediately. [any processor state]
void switch_off();

}  // namespace robosync::boards::stm32l4::pins
