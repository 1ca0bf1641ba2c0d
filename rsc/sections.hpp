// An image's size, section by section.
#pragma once

#include <cstddef>
#include <vector>

#include "vm/image.hpp"

namespace robosync::tool {

struct SectionSize {
  vm::Section section;
  std::size_t records = 0;
  std::size_t bytes = 0;  // padding included
};

// Those that are not empty, in the order they stand in the image; together they are the image.
[[nodiscard]] std::vector<SectionSize> section_sizes(const vm::Image& image);

}  // namespace robosync::tool
