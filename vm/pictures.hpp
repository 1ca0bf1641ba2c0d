// The pictures of robot.json have no number: the `item` of a word for one is the picture, and below 0. Bit 5 * row + column is the
// light there, from the top left.
#pragma once

#include <cstdint>

#include "vm/value.hpp"

namespace robosync::vm {

inline constexpr unsigned kPictureSide = 5;
inline constexpr std::uint32_t kAllLights = (1U << kPictureSide * kPictureSide) - 1;

constexpr Value item_of_picture(std::uint32_t lights) {
  return -1 - static_cast<Value>(lights);
}
// The lights of an item below 0.
constexpr std::uint32_t picture_of_item(Value item) {
  return static_cast<std::uint32_t>(-1 - item) & kAllLights;
}

}  // namespace robosync::vm
