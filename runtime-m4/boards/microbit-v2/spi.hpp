// The SPI bus for parts: pins 13 (clock), 14 (data from the part) and 15 (data to it) of the edge connector, on SPIM3, at 1 MHz.
// While it is open, the sound player's line, which is pin 15, is closed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::boards::microbit::spi {

// As in boards::Board (spi_open(), spi_close(), spi_transfer() after ask_buses()).
void open(std::uint16_t select);
void close();
[[nodiscard]] bool transfer(bool ahead, std::uint16_t select, std::span<const std::byte> out,
                            std::span<std::byte> in);
[[nodiscard]] bool is_busy();
void on_interrupt();
// The bus no longer drives its pins, until it is opened again after start-up. [any processor state]
void switch_off();

}  // namespace robosync::boards::microbit::spi
