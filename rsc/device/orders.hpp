// The host's side of order signing: signs orders with the owner's key, and explains why an order was refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "link/messages.hpp"
#include "rsc/device/owner_key.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

class Orders {
public:
  // The key file; default_key_file() if not set. It is read when first needed.
  void use_key(const std::string& file) { file_ = file; }

  // The board's latest report.
  void learn(link::Pairing pairing) { pairing_ = pairing; }
  void learn(const link::Authority& authority);
  bool are_signed() const { return pairing_ == link::Pairing::paired; }
  bool know_how() const { return authority_.has_value(); }  // the next order must be signed

  // The payload of the signed order; requires know_how(). Throws Failure (outside) if there is no key, or it is not the
  // owner's.
  std::vector<std::byte> sign(link::MessageType type, std::span<const std::byte> payload);

private:
  std::string file_;
  std::unique_ptr<const OwnerKey> key_;
  link::Pairing pairing_ = link::Pairing::unpaired;
  std::optional<link::Authority> authority_;
};

// The last part of an upload's signed `begin`.
[[nodiscard]] link::Grant grant_of(std::span<const std::byte> image, const link::Activate& how);

// Why the board refused an order, if repeating it is of no use. Empty: repeat it.
[[nodiscard]] std::string denial_text(const link::Authority& authority);

// Who may give the robot orders, as one line and as JSON.
[[nodiscard]] std::string owner_text(const link::Authority& authority);
[[nodiscard]] Json owner_json(const link::Authority& authority);

}  // namespace robosync::tool
