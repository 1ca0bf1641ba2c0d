#include "runtime-m4/boards/stm32l4/board.hpp"

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/boards/stm32l4/analog.hpp"
#include "runtime-m4/boards/stm32l4/clock.hpp"
#include "runtime-m4/boards/stm32l4/echoes.hpp"
#include "runtime-m4/boards/stm32l4/inputs.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/port/cortex-m4/clock.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

namespace robosync::boards::stm32l4 {

namespace {

constexpr std::uint32_t kWatchdogCounts = iwdg::kHz * Board::kWatchdogMs / 1000;

}  // namespace

Board board;

// Reads the reset flags and clears them: they accumulate over resets.
Board::Board() : watchdog_reset_(rcc::kStatus.has(rcc::kWatchdogReset)) {
  rcc::kStatus.set(rcc::kForgetReset);
  if (!start_clock()) port::core::reset();
  rcc::give_clock(rcc::kAhb2, rcc::kPortsAToD);
  pins::start();
  inputs::start();
  echoes::start();
  analog::start();
  start_i2c();
  for (const Bus& bus : wiring::kBuses)
    for (const unsigned interrupt : {bus.master.event_interrupt, bus.master.event_interrupt + 1})
      port::core::enable_interrupt(interrupt);
  for (const unsigned interrupt : wiring::kEchoInterrupts)
    port::core::enable_interrupt(interrupt);
  port::core::enable_interrupt(spi::kInterrupt);
}

// A watchdog reset comes without warning, so it could not be recorded in memory.
link::ResetReason Board::reset_reason() const {
  return watchdog_reset_ ? ResetReason::watchdog : last_reset();
}

bool Board::input(std::uint16_t pin) const {
  return inputs::is_high(pin);
}

void Board::ping(std::uint16_t trigger, std::uint16_t echo) {
  echoes::ping(trigger, echo);
}

std::uint32_t Board::take_echo(std::uint16_t echo) {
  return echoes::take(echo);
}

bool Board::take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                       Turned& turned) {
  return echoes::take_edges(number, a, b, most, ~port::read_clock(), turned);
}

policy::EncoderCount Board::edges_so_far(unsigned number) {
  return echoes::edges_so_far(number);
}

void Board::end_edges(unsigned number) {
  echoes::end_edges(number);
}

bool Board::analog(std::uint16_t pin, std::uint16_t& voltage) {
  return analog::read(pin, voltage);
}

void Board::pwm_write(std::uint16_t pin, std::uint32_t pulse_us) {
  pins::write(pin, pulse_us);
}

std::uint32_t Board::pwm_read(std::uint16_t pin) const {
  return pins::read(pin);
}

void Board::enable(std::uint16_t pin, bool on) {
  pins::enable(pin, on);
}

void Board::link_start(const LineEvents& events) {
  line_.start(events);
  Player::start();
}

void Board::say(std::uint8_t line, const policy::PlayerCommand& command) {
  if (line == kPlayerLine) player_.say(command);
}

// The watchdog has no interrupt: it resets the chip, which releases all pins. Its first period is longer, because
// the settings take effect a few of its counts later.
void Board::watchdog_start() {
  iwdg::kKey.write(iwdg::kStart);
  iwdg::kKey.write(iwdg::kUnlock);
  iwdg::kPrescaler.write(iwdg::kByFour);
  iwdg::kReload.write(kWatchdogCounts - 1);
}

void Board::watchdog_kick() {
  iwdg::kKey.write(iwdg::kKick);
}

}  // namespace robosync::boards::stm32l4

robosync::boards::Board& robosync_board = robosync::boards::stm32l4::board;

void robosync::boards::switch_outputs_off() {
  stm32l4::switch_spi_off();
  stm32l4::pins::switch_off();
}

const std::uint32_t robosync::port::hooks::kTickCounts =
    robosync::boards::stm32l4::kClockHz / 1'000'000 * robosync::kernel::kTick;

extern "C" {

void NMI_Handler();
void Link_Handler();
void Player_Handler();
void Echo_Handler();
void Spi_Handler();

// Uncorrectable damage of the flash. Unless it is in the store, the code that runs is not the code that was written.
void NMI_Handler() {
  if (robosync::boards::stm32l4::Flash::forgive_damage()) return;
  robosync::boards::reset_after({});
}

void Link_Handler() {
  using robosync::boards::stm32l4::LinkUsart;
  auto& line = robosync::boards::stm32l4::board.line();
  if (LinkUsart::has_received()) line.on_receive();
  if (LinkUsart::wants_to_send() && LinkUsart::can_send()) line.on_transmit();
}

void Player_Handler() {
  robosync::boards::stm32l4::board.player().on_transmit();
}

// The clock counts down.
void Echo_Handler() {
  robosync::boards::stm32l4::echoes::on_edge(~robosync::port::read_clock());
}

void Spi_Handler() {
  robosync::boards::stm32l4::board.spi().on_interrupt();
}

}  // extern "C"
