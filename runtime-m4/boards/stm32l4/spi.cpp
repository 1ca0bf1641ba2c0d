// See spi.hpp. ST's RM0351, 42 (SPI) and 11 (DMA): a transfer follows the steps of 42.4.9 for DMA, with the SPI on all the time:
// when it is off it does not drive its clock.
#include "runtime-m4/boards/stm32l4/spi.hpp"

#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/boards/stm32l4/wiring.hpp"

namespace robosync::boards::stm32l4 {
namespace {

using spi::kDma, spi::kDmaToMemory, wiring::kSpi;

// The last bit has been received half a clock before its end, 0.8 us, and a poll takes at least four cycles of 80 MHz: 16 polls, and
// some more.
constexpr unsigned kLooks = 20;

void set_up(const DmaChannel& channel) {
  kDmaSelect.set_field(channel.number - 1, 4, spi::kDmaForSpi);
  channel.peripheral().write(static_cast<std::uint32_t>(spi::kData.address));
}

static_assert(vm::kMostSpiBytes <= 4, "the FIFO has room for four bytes");

// Inlined, because a sensor's thread has no stack to spare for another frame.
[[gnu::always_inline]] inline void move(const DmaChannel& channel, std::uint32_t memory,
                                        std::size_t bytes, std::uint32_t how) {
  channel.memory().write(memory);
  channel.count().write(static_cast<std::uint32_t>(bytes));
  channel.control().write(how | DmaChannel::kOn);
}

void stop_channels() {
  kDma.control().write(0);
  kDmaToMemory.control().write(0);
  kDmaForget.write(kDma.flags() | kDmaToMemory.flags());
}

// Only a reset empties its FIFOs for certain.
void reset() {
  rcc::kResetApb2.set(rcc::kSpi1);
  rcc::kResetApb2.clear(rcc::kSpi1);
}

// Its clock is low before it has its pin.
void switch_on() {
  spi::kControl2.write(spi::kBytesByDmaBothWays);
  spi::kControl.write(spi::kBothWaysAt625kHz);
}

bool has_ended() {
  for (unsigned i = 0; i < kLooks; ++i)
    if (!spi::kState.has(spi::kBusy)) return true;
  return false;
}

}  // namespace

struct SpiMaster {  // for AskedSpi
  static void open() {
    rcc::give_clock(rcc::kAhb1, rcc::kDma1);
    rcc::give_clock(rcc::kApb2, rcc::kSpi1);
    stop_channels();
    set_up(kDma);
    set_up(kDmaToMemory);
    reset();
    switch_on();
    kSpi.input.port.function(kSpi.input.bit).set_field(kSpi.input.bit % 8, 4, kSpi.function);
    kSpi.input.port.mode().set_field(kSpi.input.bit, 2, kModeOfFunction);
    pins::hand_over(kSpi.clock, kSpi.function);
    pins::hand_over(kSpi.output, kSpi.function);
  }

  static void close() {
    pins::take_back(kSpi.clock);
    pins::take_back(kSpi.output);
    kSpi.input.port.mode().set_field(kSpi.input.bit, 2, kModeOfInput);
    stop_channels();
    reset();
  }

  // What comes fits into the FIFO, so no byte is lost. The bytes leave as soon as the second channel is on.
  static void begin(std::span<const std::byte> out, std::span<std::byte> in) {
    move(kDmaToMemory, port::bus_address(in.data()), in.size(),
         DmaChannel::kBytesToMemory | DmaChannel::kInterrupts);
    move(kDma, port::bus_address(out.data()), out.size(), DmaChannel::kBytesFromMemory);
  }

  static Transfer on_interrupt() {
    const std::uint32_t state = kDmaState.read() & (kDmaToMemory.ended() | kDmaToMemory.failed());
    if (state == 0) return Transfer::goes_on;
    const bool whole = state == kDmaToMemory.ended() && has_ended();
    stop_channels();
    if (whole) return Transfer::done;
    let_go();
    return Transfer::failed;
  }

  static void let_go() {
    stop_channels();
    reset();
    switch_on();
  }

  static void begin_select(std::uint16_t pin) { pins::begin_select(pin); }
  static void select(std::uint16_t pin, bool on) { pins::select(pin, on); }
  static void end_select(std::uint16_t pin) { pins::take_back(pin); }
};

void switch_spi_off() {
  for (const Output& output : wiring::kOutputs)
    pins::take_back(output.pin);
}

}  // namespace robosync::boards::stm32l4

template class robosync::boards::AskedSpi<robosync::boards::stm32l4::SpiMaster>;
