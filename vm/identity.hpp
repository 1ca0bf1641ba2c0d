// The name of an image: the first bytes of a SHA-256 over the parts that run. So a change of any byte of a program changes its
// name, and two programs with one name are the same.
//
// The lengths, the checksum and the name in the header are hashed as zeros. Source lines, which only a host reads, are left
// out: a program has the same name with and without them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vm/image.hpp"

namespace robosync::vm {

using Digest = std::array<std::uint32_t, 8>;  // SHA-256 as words, in order

class Identity {
public:
  // Hashes the new bytes of an image of which `received` has arrived so far, without keeping them. Assumes nothing about them.
  void follow(std::span<const std::byte> received);
  // The image is complete: hashes the rest, and returns the digest.
  [[nodiscard]] Digest finish(std::span<const std::byte> image);

private:
  void take_block(std::span<const std::byte> image, std::uint32_t end, std::uint32_t bits_at);

  static constexpr Digest kInitial = {0x6A09E667, 0xBB67AE85, 0x3C6EF372, 0xA54FF53A,
                                      0x510E527F, 0x9B05688C, 0x1F83D9AB, 0x5BE0CD19};
  Digest state_ = kInitial;
  std::uint32_t taken_ = 0;  // bytes
};

[[nodiscard]] ProgramHash name_of(const Digest& digest);
// Does the name in the header of a fully followed image match its bytes? False if the header is incomplete.
[[nodiscard]] bool is_named(std::span<const std::byte> image, Identity identity);

// Writes the name and the CRC-32 into the header, after bytes were changed. `image` must have a complete header.
void seal(std::span<std::byte> image);

}  // namespace robosync::vm
