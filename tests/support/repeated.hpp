// A text so many times over.
#pragma once

#include <cstddef>
#include <string>

namespace robosync::testing {

inline std::string repeated(const std::string& part, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += part;
  return text;
}

}  // namespace robosync::testing
