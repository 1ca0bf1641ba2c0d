// See signatures.hpp: the implementation on the board. It uses the code that scripts/signatures unpacks from Debian's source
// package of TinySSH, the smallest there for this. One verification takes 3.6 KB of stack, most of it for a table.
#include <algorithm>
#include <array>

#include "runtime-m4/update/signatures.hpp"

extern "C" {
#include <crypto_hash_sha512.h>
#include <crypto_sign_ed25519.h>

// TinySSH's version wipes working memory. Everything in it is public here.
void cleanup_(void* /*bytes*/, long long /*count*/) {}
}

namespace robosync::update {

// TinySSH's function takes signature and text in one buffer, and may write the text back into it.
bool is_signed(std::span<const std::byte> text, const link::Signature& signature,
               const link::PublicKey& key) {
  std::array<unsigned char, sizeof(link::Signature) + kMaxSigned> bytes;
  if (text.size() > kMaxSigned) return false;
  const auto end = std::ranges::copy(signature, bytes.begin()).out;
  std::ranges::transform(text, end,
                         [](std::byte byte) { return static_cast<unsigned char>(byte); });
  unsigned long long length = 0;
  return crypto_sign_ed25519_open(bytes.data(), &length, bytes.data(),
                                  signature.size() + text.size(), key.data()) == 0;
}

link::ImageHash hash_of(std::span<const std::byte> bytes) {
  std::array<unsigned char, crypto_hash_sha512_BYTES> whole;
  crypto_hash_sha512(whole.data(), reinterpret_cast<const unsigned char*>(bytes.data()),
                     bytes.size());
  link::ImageHash half{};
  std::copy_n(whole.begin(), half.size(), half.begin());
  return half;
}

}  // namespace robosync::update
