// The serial line to a sound player, on pin 15 of the edge connector.
#pragma once

#include <cstddef>
#include <span>

namespace robosync::boards::microbit::player {

void start();
// Begins to send it (boards::Board::say()).
void say(std::span<const std::byte> command);

}  // namespace robosync::boards::microbit::player
