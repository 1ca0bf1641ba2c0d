// An image without what depends on how its source is laid out: the lines of its rules, the hash of the text, and the sum over
// all. Two programs that differ only in their layout have the same one, if it holds no source lines.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "vm/image.hpp"

namespace robosync::test {

inline std::vector<std::byte> without_lines(std::vector<std::byte> bytes) {
  vm::Image image;
  if (!vm::view_image(bytes, image)) return bytes;
  const auto clear = [&bytes](const auto& field) {
    const auto at = reinterpret_cast<const std::byte*>(&field) - bytes.data();
    std::fill_n(bytes.begin() + at, sizeof field, std::byte{});
  };
  clear(image.header->program_hash);
  clear(image.header->seed);
  clear(image.header->crc32);
  for (const vm::Rule& rule : image.rules)
    clear(rule.line);
  return bytes;
}

}  // namespace robosync::test
