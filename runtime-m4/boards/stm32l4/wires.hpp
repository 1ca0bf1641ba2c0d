// The kinds of wires between the chip and a board's header and parts. boards/NAME/wiring.hpp builds its tables from them.
//
// A board's pins have the numbers printed on its header (3 is D3). Pins without a printed number get one from the board's
// profile.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/stm32l4/registers.hpp"

namespace robosync::boards::stm32l4 {

struct Pin {  // on the chip
  Port port;
  unsigned bit;
};

struct Output {  // for pulses; each has its own timer channel
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
  unsigned bit;  // different for each input
};

struct AnalogInput {
  std::uint16_t pin;
  Port port;
  unsigned bit;
  unsigned channel;  // of ADC1
};

struct Enable {  // the enable input of a chip on the bus
  std::uint16_t pin;
  Port port;
  unsigned bit;
};

struct Bus {
  I2cRegisters master;
  unsigned clock, data;           // pins of kPortOfI2c
  DmaChannel to_send, to_memory;  // connected to this master
};

struct SerialPins {
  Usart usart;
  Port port;
  std::uint32_t function;  // of the port, for both pins
  unsigned transmit;
  unsigned receive = 0;  // unused if the line only sends
};

struct SpiPins {                // of SPI1, with one function
  std::uint16_t clock, output;  // pins for pulses
  Pin input;
  std::uint32_t function;
};

struct PanelPin {  // of SPI1
  std::uint16_t pin;
  std::uint32_t function;
};

}  // namespace robosync::boards::stm32l4
