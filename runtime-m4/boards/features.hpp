// Which kinds of parts the board has, according to its profile (stdlib/boards/NAME.json, profile.cmake): all that portable code
// knows about it at compile time. The host has every part that any board has.
#pragma once

namespace robosync::boards {

inline constexpr bool kHasLights = ROBOSYNC_LIGHTS != 0;
inline constexpr bool kHasSpeaker = ROBOSYNC_SPEAKER != 0;
inline constexpr bool kHasMicrophone = ROBOSYNC_MICROPHONE != 0;
inline constexpr bool kHasParts = ROBOSYNC_PARTS != 0;
inline constexpr bool kHasPanel = ROBOSYNC_HAS_PANELS != 0;
inline constexpr bool kHasI2c = ROBOSYNC_HAS_I2C_BUSES != 0;
inline constexpr bool kHasSpi = ROBOSYNC_HAS_SPI_BUSES != 0;
inline constexpr bool kHasSerialLine = ROBOSYNC_HAS_SERIAL_LINES != 0;

}  // namespace robosync::boards
