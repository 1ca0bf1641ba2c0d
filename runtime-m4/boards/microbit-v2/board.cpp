#include "runtime-m4/boards/microbit-v2/board.hpp"

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/boards/microbit-v2/analog.hpp"
#include "runtime-m4/boards/microbit-v2/clock.hpp"
#include "runtime-m4/boards/microbit-v2/echoes.hpp"
#include "runtime-m4/boards/microbit-v2/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/lights.hpp"
#include "runtime-m4/boards/microbit-v2/microphone.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/player.hpp"
#include "runtime-m4/boards/microbit-v2/speaker.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

namespace robosync::boards::microbit {

namespace {

Board board;

}  // namespace

// The pins come first, so that they are low as soon as possible.
Board::Board() : chip_reset_(take_reset_cause()) {
  pins::start();
  inputs::start();
  echoes::start();
  port::core::enable_interrupt(gpiote::kInterrupt);
  lights::start();
  speaker::start();
  microphone::start();
  player::start();
  port::core::enable_interrupt(kRowInterrupt);
  for (const Pwm& module : {kPwm0, kPwm1})
    port::core::enable_interrupt(module.interrupt);
  for (I2c& bus : i2c_)
    bus.start();
  for (const Twim& master : {kTwim0, kTwim1})
    port::core::enable_interrupt(master.interrupt);
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

bool Board::i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                         std::span<std::byte> in) {
  return bus < i2c_.size() && i2c_[bus].transfer(asks_ahead_, address, out, in);
}

// The address comes with the transfer.
bool Board::i2c_select(std::uint8_t bus, std::uint8_t /*address*/,
                       std::span<const std::byte> page) {
  return bus < i2c_.size() && i2c_[bus].select(page);
}

bool Board::i2c_busy() const {
  return is_any_busy(i2c_);
}

BusState Board::buses() const {
  return state_of(i2c_);
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

bool Board::analog(std::uint16_t pin, std::uint16_t& voltage) {
  return analog::read(pin, voltage);
}

void Board::listen(bool on) {
  microphone::listen(on);
}

bool Board::hear(SoundBlock sound) {
  return microphone::hear(sound);
}

void Board::let_go(std::uint16_t pin) {
  pins::let_go(pin);
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
void EdgeBus_Handler();
void OwnBus_Handler();
void Pwm_Handler();
void Echo_Handler();

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

void EdgeBus_Handler() {
  robosync::boards::microbit::board.i2c(0).on_interrupt();
}

void OwnBus_Handler() {
  robosync::boards::microbit::board.i2c(1).on_interrupt();
}

void Echo_Handler() {
  robosync::boards::microbit::echoes::on_edge();
}

void Pwm_Handler() {
  robosync::boards::microbit::pins::on_period_end();
}

}  // extern "C"
