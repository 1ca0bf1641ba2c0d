// The name of an image: the beginning of the SHA-256 of what runs of it. So who changes a byte of a program changes its
// name, and two programs of one name are the same.
//
// Counted as zero are what says how long the image is and the checksums in its header; source lines, which only a host
// reads, are not counted at all: with them and without, it is the same program.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vm/image.hpp"

namespace robosync::vm {

using Digest = std::array<std::uint32_t, 8>;  // SHA-256 as words, the first one first

class Identity {
public:
  // Takes what is new of an image of which these first bytes have come, without keeping them. May assume nothing of them.
  void follow(std::span<const std::byte> received);
  // All of it has come: what is left is taken, and the digest given.
  [[nodiscard]] Digest finish(std::span<const std::byte> image);

private:
  void take_block(std::span<const std::byte> image, std::uint32_t end, std::uint32_t bits_at);

  static constexpr Digest kInitial = {0x6A09E667, 0xBB67AE85, 0x3C6EF372, 0xA54FF53A,
                                      0x510E527F, 0x9B05688C, 0x1F83D9AB, 0x5BE0CD19};
  Digest state_ = kInitial;
  std::uint32_t taken_ = 0;  // bytes
};

[[nodiscard]] ProgramHash name_of(const Digest& digest);
// Is an image, of which all has been followed, what its header says that it is? Not when there is no whole header.
[[nodiscard]] bool is_named(std::span<const std::byte> image, Identity identity);

// Puts the name and the CRC-32 into the header, after bytes were changed. `image` has a whole header.
void seal(std::span<std::byte> image);

}  // namespace robosync::vm
