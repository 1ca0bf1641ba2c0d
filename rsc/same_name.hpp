// How names that a person gives on the command line or in a TEST are compared: in any case.
#pragma once

#include <algorithm>
#include <cctype>
#include <string_view>

namespace robosync::tool {

inline bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace robosync::tool
