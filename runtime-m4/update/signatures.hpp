// Ed25519 and SHA-512 (RFC 8032). A board only verifies and hashes: it has no secret. On the board the code is TinySSH's
// (signatures_tinyssh.cpp), on the host libsodium's.
#pragma once

#include <cstddef>
#include <span>

#include "link/messages.hpp"
#include "link/order.hpp"

namespace robosync::update {

// The longest text that is_signed() takes, in bytes.
inline constexpr std::size_t kMaxSigned = link::kMaxOrderText;
[[nodiscard]] bool is_signed(std::span<const std::byte> text, const link::Signature& signature,
                             const link::PublicKey& key);

// The first half of the SHA-512 of `bytes`.
[[nodiscard]] link::ImageHash hash_of(std::span<const std::byte> bytes);

}  // namespace robosync::update
