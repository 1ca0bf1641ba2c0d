// The kinds of wires between the chip and a board's header and parts, of which boards/NAME/wiring.hpp makes its tables.
//
// Pins of the board are numbered as printed at its header (3 is D3); what is not printed there as a number has the one that
// the board's profile gives it.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/stm32l4/registers.hpp"

namespace robosync::boards::stm32l4 {

struct Pin {  // of the chip
  Port port;
  unsigned bit;
};

struct Output {  // gives pulses, by a timer's channel, which no other one has
  std::uint16_t pin;
  Port port;
  unsigned bit;
  std::uint32_t function;
  Timer timer;
  unsigned channel;
};

struct Input {
  std::uint16_t pin;
  Port port;
  unsigned bit;  // no two have the same
};

struct AnalogInput {
  std::uint16_t pin;
  Port port;
  unsigned bit;
  unsigned channel;  // of ADC1
};

struct Enable {  // of a chip on the bus
  std::uint16_t pin;
  Port port;
  unsigned bit;
};

struct Bus {
  I2cRegisters master;
  unsigned clock, data;           // pins of kPortOfI2c
  DmaChannel to_send, to_memory;  // that hear this master
};

struct SerialPins {
  Usart usart;
  Port port;
  std::uint32_t function;  // which the pins have for it
  unsigned transmit;
  unsigned receive = 0;  // who only sends has none
};

struct PanelPin {  // of SPI1
  std::uint16_t pin;
  std::uint32_t function;
};

}  // namespace robosync::boards::stm32l4
