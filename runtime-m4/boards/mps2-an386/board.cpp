#include "runtime-m4/boards/mps2-an386/board.hpp"

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/boards/mps2-an386/spi.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

std::array<volatile std::uint32_t, kVirtualPwmPins> robosync_virtual_pwm{};
volatile std::uint32_t robosync_virtual_inputs = (1U << kVirtualInputs) - 1;  // as if pulled up

std::array<volatile std::uint32_t, kVirtualInputs> robosync_virtual_echoes{};
std::array<volatile std::uint32_t, kVirtualInputs> robosync_virtual_edges{};

std::array<volatile std::uint32_t, kVirtualAnalog> robosync_virtual_analog{};

std::array<volatile std::uint32_t, kVirtualEnables> robosync_virtual_enables{1, 1};

namespace robosync::boards::mps2 {

Board board;

namespace {

constexpr std::uint32_t kWatchdogTicks = kClockHz / 1000 * Board::kWatchdogMs;

// A pin at an enable or a select input.
void pull_low(std::uint16_t pin, bool low) {
  const unsigned place = pin - unsigned{kFirstEnable};
  if (place < kVirtualEnables) robosync_virtual_enables[place] = low ? 0 : 1;
}

WatchdogRegisters& watchdog() {
  return at<WatchdogRegisters>(kWatchdog);
}

}  // namespace

Board::Board() {
  auto& clock = at<TimerRegisters>(kTimer1);
  clock.reload = ~std::uint32_t{0};
  clock.value = ~std::uint32_t{0};
  clock.control = kTimerOn;
  spi::start();
  start_i2c();
  port::core::enable_interrupt(kTimer0Interrupt);
}

bool Board::input(std::uint16_t pin) const {
  const unsigned bit = pin - unsigned{kFirstInput};
  return bit < kVirtualInputs && (robosync_virtual_inputs >> bit & 1) != 0;
}

std::uint32_t Board::take_echo(std::uint16_t echo) {
  const unsigned place = echo - unsigned{kFirstInput};
  return place < kVirtualInputs ? robosync_virtual_echoes[place] : 0;
}

// As if the edges had come just now. More than `most` are lost, as they would be on a pin.
bool Board::take_edges(unsigned number, std::uint16_t a, std::uint8_t /*b*/, unsigned most,
                       Turned& turned) {
  const unsigned place = a - unsigned{kFirstInput};
  if (place >= kVirtualInputs) return false;
  Counted& counted = counted_[number];
  const std::uint32_t edges = robosync_virtual_edges[place];
  const bool begins = !counted.begun;
  if (begins) counted = {.begin = edges, .last = edges, .begun = true};
  const auto more = static_cast<std::int32_t>(edges - counted.last);
  counted.last = edges;
  const bool all = static_cast<std::uint32_t>(more < 0 ? -more : more) <= most;
  if (!all) {
    counted.begin += static_cast<std::uint32_t>(more);
    ++counted.losses;
  }
  counted.place = static_cast<std::uint16_t>(place);
  counted.most = static_cast<std::uint16_t>(most);
  turned = {static_cast<std::int32_t>(edges - counted.begin), 0, begins};
  return all;
}

policy::EncoderCount Board::edges_so_far(unsigned number) {
  const Counted& counted = counted_[number];
  if (!counted.begun) return {};
  const std::uint32_t edges = robosync_virtual_edges[counted.place];
  const auto more = static_cast<std::int32_t>(edges - counted.last);
  const bool all = static_cast<std::uint32_t>(more < 0 ? -more : more) <= counted.most;
  return {.edges = static_cast<std::int32_t>((all ? edges : counted.last) - counted.begin),
          .losses = static_cast<std::uint8_t>(counted.losses + (all ? 0 : 1))};
}

void Board::end_edges(unsigned number) {
  counted_[number].begun = false;
}

bool Board::analog(std::uint16_t pin, std::uint16_t& voltage) {
  const unsigned place = pin - unsigned{kFirstAnalog};
  if (place >= kVirtualAnalog) return false;
  const std::uint32_t counts = robosync_virtual_analog[place];
  voltage = static_cast<std::uint16_t>(counts);
  return counts <= kAnalogFull;
}

void Board::pwm_write(std::uint16_t pin, std::uint32_t pulse_us) {
  if (pin < robosync_virtual_pwm.size()) robosync_virtual_pwm[pin] = pulse_us;
}

std::uint32_t Board::pwm_read(std::uint16_t pin) const {
  return pin < robosync_virtual_pwm.size() ? robosync_virtual_pwm[pin] : 0;
}

void Board::enable(std::uint16_t pin, bool on) {
  pull_low(pin, on);
}

bool WaitingSpi::transfer(bool ahead, std::uint16_t select, std::span<const std::byte> out,
                          std::span<std::byte> in) {
  if (ahead) return in.empty();
  pull_low(select, true);
  const bool done = spi::transfer(out, in);
  pull_low(select, false);
  return done;
}

void Board::link_start(const LineEvents& events) {
  uart_.start(events);
  Player::start();
}

void Board::say(std::uint8_t line, const policy::PlayerCommand& command) {
  if (line == kPlayerLine) player_.say(command);
}

void Board::watchdog_start() {
  watchdog().lock = kWatchdogUnlock;
  watchdog().load = kWatchdogTicks;
  watchdog().control = kWatchdogOn;
  watchdog().lock = 0;  // no stray write can stop it now
}

void Board::watchdog_kick() {
  watchdog().lock = kWatchdogUnlock;
  watchdog().interrupt_clear = 1;
  watchdog().lock = 0;
}

}  // namespace robosync::boards::mps2

robosync::boards::Board& robosync_board = robosync::boards::mps2::board;

void robosync::boards::switch_outputs_off() {
  for (volatile std::uint32_t& pulse : robosync_virtual_pwm)
    pulse = 0;
  for (volatile std::uint32_t& level : robosync_virtual_enables)
    level = 1;
}

const std::uint32_t robosync::port::hooks::kTickCounts =
    robosync::boards::mps2::kClockHz / 1'000'000 * robosync::kernel::kTick;

extern "C" {

void NMI_Handler();
void Uart0Receive_Handler();
void Uart0Transmit_Handler();
void Uart1Transmit_Handler();

// The watchdog was not kicked in time. An NMI cannot be masked, so the outputs go off whatever hangs;
// then the second time-out resets the board.
void NMI_Handler() {
  robosync::boards::switch_outputs_off();
  robosync::boards::keep_watchdog_reset();
  while (true)
    asm volatile("" ::: "memory");  // the record is read after the reset: keep the store
}

void Uart0Receive_Handler() {
  robosync::boards::mps2::Uart0::clear_received();
  robosync::boards::mps2::board.uart().on_receive();
}

void Uart0Transmit_Handler() {
  robosync::boards::mps2::Uart0::clear_transmitted();
  robosync::boards::mps2::board.uart().on_transmit();
}

void Uart1Transmit_Handler() {
  robosync::boards::mps2::Uart1::clear_transmitted();
  robosync::boards::mps2::board.player().on_transmit();
}

}  // extern "C"
