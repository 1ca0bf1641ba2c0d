// A board with an STM32L475 or STM32L476 (Cortex-M4F, 80 MHz, 1 MB of flash, 96 + 32 KB of RAM). Its wiring defines the rest
// (wiring.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/asking_board.hpp"
#include "runtime-m4/boards/common/flash_store.hpp"
#include "runtime-m4/boards/pins.hpp"
#include "runtime-m4/boards/stm32l4/flash.hpp"
#include "runtime-m4/boards/stm32l4/i2c.hpp"
#include "runtime-m4/boards/stm32l4/panel.hpp"
#include "runtime-m4/boards/stm32l4/spi.hpp"
#include "runtime-m4/boards/stm32l4/usart.hpp"

namespace robosync::boards::stm32l4 {

struct Buses {  // for AskingBoard
  using Spi = PartBus;
  template <std::size_t... kBus>
  static constexpr std::array<I2c, sizeof...(kBus)> these(std::index_sequence<kBus...> /*all*/) {
    return {I2c(i2c_master(kBus))...};
  }
  static constexpr auto i2c() { return these(std::make_index_sequence<wiring::kBuses.size()>{}); }
};

}  // namespace robosync::boards::stm32l4

extern template class robosync::boards::AskingBoard<robosync::boards::stm32l4::Buses>;

namespace robosync::boards::stm32l4 {

class Board final : public AskingBoard<Buses> {
public:
  static constexpr std::uint32_t kWatchdogMs = 100;

  // Starts the core's clock.
  Board();

  const char* name() const override { return wiring::kName; }
  link::ResetReason reset_reason() const override;
  const policy::BoardPins& pins() const override { return boards::kPins; }
  static_assert(!meet(kOutputs, kInputs) && !meet(kOutputs, kAnalog), "let_go() does nothing here");
  bool input(std::uint16_t pin) const override;
  void ping(std::uint16_t trigger, std::uint16_t echo) override;
  std::uint32_t take_echo(std::uint16_t echo) override;
  bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                  Turned& turned) override;
  policy::EncoderCount edges_so_far(unsigned number) override;
  void end_edges(unsigned number) override;
  bool analog(std::uint16_t pin, std::uint16_t& voltage) override;
  void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) override;
  std::uint32_t pwm_read(std::uint16_t pin) const override;
  void enable(std::uint16_t pin, bool on) override;
  Store* store() override { return &store_; }
  std::size_t link_write(std::span<const std::byte> bytes) override { return line_.write(bytes); }
  std::size_t link_read(std::span<std::byte> bytes) override { return line_.read(bytes); }
  void link_start(const LineEvents& events) override;
  void say(std::uint8_t line, const policy::PlayerCommand& command) override;
  PanelOutput& panel() override { return panel_output(); }
  void watchdog_start() override;
  void watchdog_kick() override;
  std::uint32_t watchdog_ms() const override { return kWatchdogMs; }

  Line& line() { return line_; }
  Player& player() { return player_; }

private:
  bool watchdog_reset_ = false;  // the watchdog reset the chip
  Line line_;
  Player player_;
  static_assert(ROBOSYNC_STORE_BYTES == flash::kBytesOfBank);
  FlashStore<Flash> store_{flash::kBank2, ROBOSYNC_STORE_BYTES};
};

extern Board board;

}  // namespace robosync::boards::stm32l4
