// A panel or a strip of WS2812 lights, which are wired as a chain: the place of each light of a picture in it. Pure.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

// A picture of 64 lights takes 1.9 ms, with 0.3 ms of silence before and after it (boards/common/panel_signal.hpp).
inline constexpr std::uint16_t kPanelGapMs = 4;

inline constexpr unsigned kPictureSide = 5;
inline constexpr unsigned kPictureLights = kPictureSide * kPictureSide;

struct Panel {
  std::uint16_t pin = 0;
  std::uint8_t side = kPictureSide;  // lights in a row, and rows
  bool goes_back = false;            // every second row is wired from right to left
  std::uint32_t color = 0;           // of a lit one, 0xRRGGBB
  std::uint8_t strip = 0;  // lights that all have the colour of the picture; 0: they show a picture

  [[nodiscard]] constexpr unsigned lights() const {
    return strip != 0 ? strip : unsigned{side} * side;
  }
  // The place in the chain of light number `light` of a picture (boards::Board::show()), which is centred on the panel.
  [[nodiscard]] constexpr unsigned place_of(unsigned light) const {
    const unsigned margin = (side - kPictureSide) / 2;
    const unsigned row = light / kPictureSide + margin;
    const unsigned column = light % kPictureSide + margin;
    const bool back = goes_back && row % 2 != 0;
    return row * side + (back ? side - 1 - column : column);
  }
};

// `actuator` is of a verified image.
constexpr Panel panel_of(const vm::Actuator& actuator) {
  if (vm::is_strip(actuator.driver)) return {.pin = actuator.pin, .strip = actuator.bus};
  return {.pin = actuator.pin,
          .side = static_cast<std::uint8_t>((actuator.bus & vm::kPanelIsLarge) != 0 ? 8 : 5),
          .goes_back = (actuator.bus & vm::kPanelGoesBack) != 0,
          .color = static_cast<std::uint32_t>(actuator.speed_limit)};
}

// A colour, 0xRRGGBB, of which no component exceeds vm::kMostLight.
constexpr std::uint32_t limited_color(std::uint32_t color) {
  std::uint32_t limited = 0;
  for (unsigned part = 0; part < 24; part += 8)
    limited |= std::min(color >> part & 0xFF, std::uint32_t{vm::kMostLight}) << part;
  return limited;
}

}  // namespace robosync::policy
