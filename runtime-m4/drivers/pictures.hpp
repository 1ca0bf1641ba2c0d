// The pictures of 5 x 5 lights that a face shows: the drivers' and those of the tool's time line. Bit 5 * row + column is the light
// there, from the top left.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "vm/pictures.hpp"

namespace robosync::drivers {

using Picture = std::uint32_t;

constexpr Picture picture_of(std::string_view a, std::string_view b, std::string_view c,
                             std::string_view d, std::string_view e) {
  Picture picture = 0;
  unsigned first = 0;
  for (const std::string_view row : {a, b, c, d, e}) {
    for (unsigned column = 0; column < row.size(); ++column)
      picture |= Picture{row[column] == '#'} << (first + column);
    first += vm::kPictureSide;
  }
  return picture;
}

inline constexpr std::array kPictures = {
#define PICTURE(name, a, b, c, d, e) picture_of(a, b, c, d, e),
#include "runtime-m4/drivers/pictures.def"
#undef PICTURE
};

struct Digit {
  Picture alone;
  Picture one_of_two;  // at the left
};
inline constexpr std::array kDigits = {
#define DIGIT(a, b, c, d, e, f, g, h, i, j) \
  Digit{picture_of(a, b, c, d, e), picture_of(f, g, h, i, j)},
#include "runtime-m4/drivers/digits.def"
#undef DIGIT
};
inline constexpr auto kMostShown = static_cast<vm::Value>(kDigits.size() * kDigits.size() - 1);

// The picture of robot.json in an item below 0; else the one with this number among the named ones, in thousandths.
constexpr Picture named_picture(vm::Value item) {
  if (item < 0) return vm::picture_of_item(item);
  const auto index = static_cast<std::uint32_t>(item / vm::kScale);
  return index < kPictures.size() ? kPictures[index] : 0;
}

// A number in thousandths, rounded: the nearest that there is a picture of.
constexpr Picture number_picture(vm::Value number) {
  constexpr vm::Value kHalf = vm::kScale / 2;
  if (number < 0) number = 0;
  if (number > kMostShown * vm::kScale) number = kMostShown * vm::kScale;
  const auto whole = static_cast<std::uint32_t>(number + kHalf) / vm::kScale;
  const Digit& last = kDigits[whole % kDigits.size()];
  if (whole < kDigits.size()) return last.alone;
  return kDigits[whole / kDigits.size()].one_of_two | last.one_of_two << 3;
}

}  // namespace robosync::drivers
