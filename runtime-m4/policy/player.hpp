// The serial commands of a sound player: a DFPlayer Mini, or one with its chip (DFRobot DFR0299, "Serial Control Cmd"; Flyron
// FN-M16P, 3). 9,600 baud, 8 bits, no parity, one stop bit. The commands request no answer. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace robosync::policy {

using PlayerCommand = std::array<std::byte, 10>;
inline constexpr std::uint32_t kPlayerBaud = 9'600;

// The least time between two commands: a player may miss one that comes sooner.
inline constexpr std::uint16_t kPlayerGapMs = 50;

// Plays sound number `sound` (1 to 3000) from the folder mp3 of the player's card, instead of the current one; 0 stops it.
constexpr PlayerCommand player_command(std::uint16_t sound) {
  constexpr unsigned kPlayFromFolderMp3 = 0x12, kStop = 0x16;
  const unsigned version = 0xFF, length = 6, answer = 0;
  const unsigned command = sound == 0 ? kStop : kPlayFromFolderMp3;
  const unsigned high = sound >> 8, low = sound & 0xFF;
  const unsigned check = 0 - (version + length + command + answer + high + low);
  const auto byte = [](unsigned value) { return static_cast<std::byte>(value & 0xFF); };
  return {byte(0x7E), byte(version), byte(length),     byte(command), byte(answer),
          byte(high), byte(low),     byte(check >> 8), byte(check),   byte(0xEF)};
}

}  // namespace robosync::policy
