// See player.hpp. The module fetches the command from memory in the background, without any interrupt.
#include "runtime-m4/boards/microbit-v2/player.hpp"

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::player {

namespace {

policy::PlayerCommand sent;

// A byte takes 1.05 ms, and a poll at least 0.1 us.
constexpr unsigned kLooksAtStop = 12'000;

}  // namespace

// The pin is high, the idle level of a line, before the module takes it.
void start() {
  player_uart::kTransmitPin.set_high().write(player_uart::kTransmitPin.mask());
  player_uart::kTransmitPin.configuration().write(Pin::kOutput);
  player_uart::kTransmitPinSelect.write(player_uart::kTransmitPin.number());
  player_uart::kBaudRate.write(player_uart::k9600);
  player_uart::kEnable.write(player_uart::kOn);
}

void close() {
  unsigned looks = kLooksAtStop;
  forget(player_uart::kStopped);
  player_uart::kStopTransmitting.write(kDoIt);
  static_cast<void>(happens(player_uart::kStopped, looks));
  player_uart::kEnable.write(0);
}

void say(const policy::PlayerCommand& command) {
  sent = command;
  asm volatile("" ::: "memory");  // the module reads it from memory
  player_uart::kSendFrom.write(port::bus_address(sent.data()));
  player_uart::kSendCount.write(sent.size());
  player_uart::kStartTransmitting.write(kDoIt);
}

}  // namespace robosync::boards::microbit::player
