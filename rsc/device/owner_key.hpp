// The key with which a person signs orders to robots: a private file made by `rsc keygen`.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "link/messages.hpp"

namespace robosync::tool {

// The default path of the key: in the user's configuration folder (XDG).
[[nodiscard]] std::filesystem::path default_key_file();
// The file that --key names, or the default if `named` is empty.
[[nodiscard]] std::filesystem::path key_file(const std::string& named);

// The fingerprint that people compare: the start of the SHA-256 of a public key, in groups of four digits.
[[nodiscard]] std::string id_of(const link::PublicKey& key);

class OwnerKey {
public:
  // Makes a new key in a file that nobody else may read. Throws Failure (outside) if the file exists.
  static std::unique_ptr<const OwnerKey> make(const std::filesystem::path& file);
  // Throws Failure (outside) if there is no key, others may read it, or it is not a key.
  static std::unique_ptr<const OwnerKey> read(const std::filesystem::path& file);

  ~OwnerKey();  // wipes the secret from memory
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
