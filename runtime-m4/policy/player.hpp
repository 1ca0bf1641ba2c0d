// What a sound player is told: the serial commands of a DFPlayer Mini, and of what has its chip (DFRobot DFR0299, "Serial Control
// Cmd"; Flyron FN-M16P, 3). 9,600 baud, 8 bits, no parity, one stop bit. It is asked for no answer. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace robosync::policy {

using PlayerCommand = std::array<std::byte, 10>;
inline constexpr std::uint32_t kPlayerBaud = 9'600;

// Who is told something sooner after the last command may miss it.
inline constexpr std::uint16_t kPlayerGapMs = 50;

// Plays sound number `sound` of its card's folder mp3, 1 to 3000, instead of what it plays; 0: is silent.
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
