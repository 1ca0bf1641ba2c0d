// The chip's interrupts that the firmware uses with this board's wiring, for boards/common/vectors.cpp.
#pragma once

#include "runtime-m4/boards/common/vectors.hpp"
#include "runtime-m4/boards/stm32l4/wiring.hpp"

extern "C" void Link_Handler();
extern "C" void Player_Handler();
extern "C" void Echo_Handler();
extern "C" void HeaderBus_Handler();
extern "C" void OwnBus_Handler();
extern "C" void Spi_Handler();

namespace robosync::boards {

inline constexpr std::size_t kInterrupts = 82;

constexpr auto used_interrupts() {
  using namespace stm32l4;
  std::array<Interrupt, 3 + wiring::kEchoInterrupts.size() + 2 * wiring::kBuses.size()> used{};
  std::size_t count = 0;
  used[count++] = {wiring::kLink.usart.interrupt, Link_Handler};
  used[count++] = {wiring::kPlayer.usart.interrupt, Player_Handler};
  used[count++] = {spi::kInterrupt, Spi_Handler};
  for (const unsigned edges : wiring::kEchoInterrupts)
    used[count++] = {edges, Echo_Handler};
  for (std::size_t bus = 0; bus < wiring::kBuses.size(); ++bus) {
    const auto handler = bus == 0 ? HeaderBus_Handler : OwnBus_Handler;
    used[count++] = {wiring::kBuses[bus].master.event_interrupt, handler};
    used[count++] = {wiring::kBuses[bus].master.event_interrupt + 1, handler};
  }
  return used;
}
inline constexpr auto kUsedInterrupts = used_interrupts();

}  // namespace robosync::boards
