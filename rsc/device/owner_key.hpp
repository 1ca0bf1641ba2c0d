// The key with which a person signs the orders to robots: a file of one's own, made by `rsc keygen`.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "link/messages.hpp"

namespace robosync::tool {

// Where the key is when nobody says: in the folder of the user's settings (XDG).
[[nodiscard]] std::filesystem::path default_key_file();
// … or the file that --key names, when it is not empty.
[[nodiscard]] std::filesystem::path key_file(const std::string& named);

// What people compare: the beginning of the SHA-256 of a public key, in groups of four digits.
[[nodiscard]] std::string id_of(const link::PublicKey& key);

class OwnerKey {
public:
  // Makes a new one, in a file that nobody else may read. Throws Failure (outside) when there is one already.
  static std::unique_ptr<const OwnerKey> make(const std::filesystem::path& file);
  // Throws Failure (outside) when there is none, others may read it, or it is no key.
  static std::unique_ptr<const OwnerKey> read(const std::filesystem::path& file);

  ~OwnerKey();  // and its secret is gone from memory
  OwnerKey(const OwnerKey&) = delete;
  OwnerKey& operator=(const OwnerKey&) = delete;

  const link::PublicKey& public_key() const { return public_; }
  link::Signature sign(std::span<const std::byte> text) const;

private:
  static constexpr std::size_t kSeed = 32;
  explicit OwnerKey(std::span<const unsigned char, kSeed> seed);

  link::PublicKey public_{};
  std::array<unsigned char, 64> secret_{};
};

}  // namespace robosync::tool
