// See panel.hpp. ST's RM0351, 42 (SPI) and 11 (DMA): a DMA channel fetches the picture from memory, without any interrupt.
#include "runtime-m4/boards/stm32l4/panel.hpp"

#include "runtime-m4/boards/common/panel_signal.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/wiring.hpp"

namespace robosync::boards::stm32l4 {
namespace {

struct Spi1 {  // for PanelSignal
  static constexpr std::uint32_t kHz = spi::kHz;
  // A zero is high for 0.4 us of 1.2 us, a one for 0.8 us.
  static constexpr unsigned kBitsOfBit = 3;
  static constexpr std::uint64_t kZero = 0b100;
  static constexpr std::uint64_t kOne = 0b110;

  static void let_go() {
    pins::take_back(wiring::kPanel.pin);
    spi::kDma.control().write(0);
    spi::kControl.write(0);
  }

  // The SPI still holds two or three bytes of a dropped picture, and sends them first.
  static void send(std::uint16_t pin, std::span<const std::byte> bytes) {
    if (pin != wiring::kPanel.pin) return;
    rcc::give_clock(rcc::kAhb1, rcc::kDma1);
    rcc::give_clock(rcc::kApb2, rcc::kSpi1);
    spi::kDma.control().write(0);
    kDmaSelect.set_field(spi::kDma.number - 1, 4, spi::kDmaForSpi);
    kDmaForget.write(spi::kDma.flags());
    spi::kDma.peripheral().write(static_cast<std::uint32_t>(spi::kData.address));
    spi::kDma.memory().write(port::bus_address(bytes.data()));
    spi::kDma.count().write(static_cast<std::uint32_t>(bytes.size()));
    spi::kControl2.write(spi::kBytesByDma);
    spi::kControl.write(spi::kSendsAt2500kHz);
    pins::hand_over(wiring::kPanel.pin, wiring::kPanel.function);
    spi::kDma.control().write(DmaChannel::kBytesFromMemory | DmaChannel::kOn);
  }
};

constinit PanelSignal<Spi1> signal;

}  // namespace

PanelOutput& panel_output() {
  return signal;
}

}  // namespace robosync::boards::stm32l4
