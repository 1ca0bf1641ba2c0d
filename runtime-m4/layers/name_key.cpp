// See name_key.hpp.
#include "runtime-m4/layers/name_key.hpp"

#include <cstddef>
#include <span>

#include "vm/image.hpp"

namespace robosync::layers {

std::uint32_t name_key(std::string_view name, std::uint32_t seed) {
  std::uint32_t key = seed;
  for (const char letter : name) {
    const bool capital = letter >= 'A' && letter <= 'Z';
    const auto byte = static_cast<std::byte>(capital ? letter - 'A' + 'a' : letter);
    key = vm::crc32(std::span(&byte, 1), key);
  }
  return key;
}

}  // namespace robosync::layers
