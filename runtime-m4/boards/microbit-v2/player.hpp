// The serial line to a sound player, on pin 15 of the edge connector.
#pragma once

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards::microbit::player {

void start();
// Gives the pin back until start(): a command that is on its way ends with its present byte, and say() has no effect.
void close();
// Begins to send a command (boards::Board::say()).
void say(const policy::PlayerCommand& command);

}  // namespace robosync::boards::microbit::player
