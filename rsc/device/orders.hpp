// The host's part in who may give a robot orders: signs them with the owner's key, and says in words why one was not taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "link/messages.hpp"
#include "rsc/device/owner_key.hpp"

namespace robosync::tool {

class Orders {
public:
  // Else it is default_key_file(). It is read when it is needed first.
  void use_key(const std::string& file) { file_ = file; }

  // As the board said last.
  void learn(link::Pairing pairing) { pairing_ = pairing; }
  void learn(const link::Authority& authority);
  bool are_signed() const { return pairing_ == link::Pairing::paired; }
  bool know_how() const { return authority_.has_value(); }  // the next one must be signed

  // The payload of the signed order; know_how() is true. Throws Failure (outside) when there is no key, or another one than
  // the robot's owner has.
  std::vector<std::byte> sign(link::MessageType type, std::span<const std::byte> payload);

private:
  std::string file_;
  std::unique_ptr<const OwnerKey> key_;
  link::Pairing pairing_ = link::Pairing::unpaired;
  std::optional<link::Authority> authority_;
};

// What the signed `begin` of an upload ends with.
[[nodiscard]] link::Grant grant_of(std::span<const std::byte> image, const link::Activate& how);

// Why the board has not taken an order, when asking again is of no use. Empty: it is.
[[nodiscard]] std::string denial_text(const link::Authority& authority);

// Who gives the robot orders, in a line, and for JSON.
[[nodiscard]] std::string owner_text(const link::Authority& authority);
[[nodiscard]] nlohmann::ordered_json owner_json(const link::Authority& authority);

}  // namespace robosync::tool
