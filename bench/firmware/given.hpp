// The input of a bench firmware from bench/counting.py: an image and readings, which QEMU's loader places in RAM next to the
// firmware before it starts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "vm/image.hpp"

namespace robosync::bench {

// counting.py: IMAGE_ADDRESS, READINGS_ADDRESS
inline constexpr std::uintptr_t kImageAddress = 0x21000000;
inline constexpr std::uintptr_t kReadingsAddress = 0x21100000;

// As long as its header says; not verified.
inline std::span<const std::byte> given_image() {
  const auto* const bytes = reinterpret_cast<const std::byte*>(kImageAddress);
  vm::ImageHeader header;
  std::memcpy(&header, bytes, sizeof header);
  return {bytes, header.total_length};
}

// The count precedes the readings.
inline std::span<const vm::Value> given_readings() {
  const auto* const words = reinterpret_cast<const vm::Value*>(kReadingsAddress);
  return {words + 1, static_cast<std::size_t>(words[0])};
}

}  // namespace robosync::bench
