#include "runtime-m4/boards/microbit-v2/board.hpp"

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/boards/microbit-v2/analog.hpp"
#include "runtime-m4/boards/microbit-v2/clock.hpp"
#include "runtime-m4/boards/microbit-v2/echoes.hpp"
#include "runtime-m4/boards/microbit-v2/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/lights.hpp"
#include "runtime-m4/boards/microbit-v2/logo.hpp"
#include "runtime-m4/boards/microbit-v2/microphone.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/player.hpp"
#include "runtime-m4/boards/microbit-v2/speaker.hpp"
#include "runtime-m4/boards/microbit-v2/thermometer.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

namespace robosync::boards::microbit {

Board board;

// The pins come first, so that they are low as soon as possible.
Board::Board() : chip_reset_(take_reset_cause()) {
  pins::start();
  if (inputs::free_from_nfc()) port::core::reset();
  inputs::start();
  echoes::start();
  port::core::enable_interrupt(gpiote::kInterrupt);
  lights::start();
  speaker::start();
  microphone::start();
  logo::start();
  player::start();
  port::core::enable_interrupt(kRowInterrupt);
  for (const Pwm& module : {kPwm0, kPwm1})
    port::core::enable_interrupt(module.interrupt);
  start_i2c();
  for (const Twim& master : {kTwim0, kTwim1})
    port::core::enable_interrupt(master.interrupt);
  port::core::enable_interrupt(kPartSpi.interrupt);
  if (!start_clock()) port::core::reset();
  analog::start();
}

// A watchdog reset comes without warning, and so does one after a nested fault (lockup): neither could be recorded in
// memory.
link::ResetReason Board::reset_reason() const {
  switch (chip_reset_) {
    case ChipReset::watchdog:
      return ResetReason::watchdog;
    case ChipReset::lockup:
      return ResetReason::software;
    case ChipReset::other:
      break;
  }
  return last_reset();
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
  return echoes::take_edges(number, a, b, most, turned);
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

void Board::listen(bool on) {
  microphone::listen(on);
}

bool Board::hear(SoundBlock sound) {
  return microphone::hear(sound);
}

bool Board::measure(Part part, std::int32_t& raw) {
  switch (part) {
    case Part::logo:
      return logo::measure(raw);
    case Part::thermometer:
      return thermometer::measure(raw);
  }
  return false;
}

void Board::let_go(std::uint16_t pin, Reads what) {
  pins::let_go(pin, what);
}

void Board::take_back(std::uint16_t pin) {
  pins::take_back(pin);
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

void Board::show(std::uint32_t picture) {
  lights::show(picture);
}

void Board::sound(std::uint32_t hertz) {
  speaker::sound(hertz);
}

void Board::say(std::uint8_t line, const policy::PlayerCommand& command) {
  if (line == kPlayerLine) player::say(command);
}

}  // namespace robosync::boards::microbit

robosync::boards::Board& robosync_board = robosync::boards::microbit::board;

void robosync::boards::switch_outputs_off() {
  microbit::switch_spi_off();
  microbit::pins::switch_off();
  microbit::lights::show(0);
  microbit::speaker::sound(0);
}

const std::uint32_t robosync::port::hooks::kTickCounts =
    robosync::boards::microbit::Timer::kHz / 1'000'000 * robosync::kernel::kTick;

extern "C" {

void NMI_Handler();
void Uart0_Handler();
void Row_Handler();
void Pwm_Handler();
void Echo_Handler();
void Spi_Handler();

// Nothing in the chip causes one.
void NMI_Handler() {
  robosync::boards::reset_after({});
}

void Uart0_Handler() {
  using robosync::boards::microbit::Uart0;
  auto& line = robosync::boards::microbit::board.line();
  if (Uart0::has_received()) line.on_receive();
  if (Uart0::holds())
    robosync::port::core::pend_interrupt(robosync::boards::microbit::uart::kInterrupt);
  if (Uart0::wants_to_send() && Uart0::can_send()) line.on_transmit();
}

void Row_Handler() {
  robosync::boards::microbit::lights::next_row();
}

void Spi_Handler() {
  robosync::boards::microbit::board.spi().on_interrupt();
}

void Echo_Handler() {
  robosync::boards::microbit::echoes::on_edge();
}

void Pwm_Handler() {
  robosync::boards::microbit::pins::on_period_end();
}

}  // extern "C"
