// See signatures.hpp: on the host.
#include <algorithm>
#include <array>

#include <sodium.h>

#include "runtime-m4/update/signatures.hpp"

namespace robosync::update {
namespace {

const unsigned char* raw(std::span<const std::byte> bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

bool is_signed(std::span<const std::byte> text, const link::Signature& signature,
               const link::PublicKey& key) {
  return crypto_sign_verify_detached(signature.data(), raw(text), text.size(), key.data()) == 0;
}

link::ImageHash hash_of(std::span<const std::byte> bytes) {
  std::array<unsigned char, crypto_hash_sha512_BYTES> whole{};
  crypto_hash_sha512(whole.data(), raw(bytes), bytes.size());
  link::ImageHash half{};
  std::copy_n(whole.begin(), half.size(), half.begin());
  return half;
}

}  // namespace robosync::update
