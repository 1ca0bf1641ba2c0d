// Converts payload structs to bytes and back. Both ends are little-endian, so a struct without padding
// is its own wire form. Only this file relies on that.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace robosync::link {

static_assert(std::endian::native == std::endian::little, "payloads are copied as they stand");

template <typename T>
concept Payload =
    std::is_trivially_copyable_v<T> && std::has_unique_object_representations_v<T>;  // no padding

// The bytes of `payload`, for encode_frame().
template <Payload T>
std::span<const std::byte> wire_bytes(const T& payload) {
  return std::as_bytes(std::span<const T, 1>(&payload, 1));
}

// Reads the struct that a message begins with (Data, ImageData). False if there are too few bytes.
template <Payload T>
[[nodiscard]] bool read_prefix(std::span<const std::byte> bytes, T& payload) {
  if (bytes.size() < sizeof(T)) return false;
  std::memcpy(&payload, bytes.data(), sizeof(T));
  return true;
}

// Reads a struct that is the whole message. False if the length differs.
template <Payload T>
[[nodiscard]] bool read_payload(std::span<const std::byte> bytes, T& payload) {
  return bytes.size() == sizeof(T) && read_prefix(bytes, payload);
}

}  // namespace robosync::link
