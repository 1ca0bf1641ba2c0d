// The SPI bus for parts, on SPI1 and two channels of DMA1, at 625 kHz (wiring::kSpi). A panel of lights needs SPI1, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::boards::stm32l4::parts {

// As in boards::Board (spi_open(), spi_close(), spi_transfer() after ask_buses()).
void open(std::uint16_t select);
void close();
[[nodiscard]] bool transfer(bool ahead, std::uint16_t select, std::span<const std::byte> out,
                            std::span<std::byte> in);
[[nodiscard]] bool is_busy();
void on_interrupt();
// The pins are low, or return to their timers; until it is opened again after start-up. [any processor state]
void switch_off();

}  // namespace robosync::boards::stm32l4::parts
