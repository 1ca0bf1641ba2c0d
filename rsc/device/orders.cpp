// See orders.hpp.
#include "rsc/device/orders.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <sodium.h>

#include "link/order.hpp"
#include "link/wire.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

using link::Denial;
using link::Pairing;

void Orders::learn(const link::Authority& authority) {
  pairing_ = authority.pairing;
  authority_ = authority;
}

std::vector<std::byte> Orders::sign(link::MessageType type, std::span<const std::byte> payload) {
  link::Authority& authority = authority_.value();
  if (!key_) key_ = OwnerKey::read(key_file(file_));
  if (key_->public_key() != authority.key) {
    throw Failure(Exit::outside, fmt::format("the robot's owner has the key {}, and {} is the key "
                                             "{}: name the right file with --key FILE",
                                             id_of(authority.key), key_file(file_).string(),
                                             id_of(key_->public_key())));
  }
  link::SignedOrder order{};
  order.boot = authority.boot;
  order.number = authority.next++;
  order.type = static_cast<std::uint8_t>(type);
  std::array<std::byte, link::kMaxOrderText> text{};
  order.signature = key_->sign(link::order_text(order, payload, text));
  const auto head = link::wire_bytes(order);
  std::vector<std::byte> whole(head.begin(), head.end());
  whole.insert(whole.end(), payload.begin(), payload.end());
  return whole;
}

link::Grant grant_of(std::span<const std::byte> image, const link::Activate& how) {
  std::array<unsigned char, crypto_hash_sha512_BYTES> hash{};
  crypto_hash_sha512(hash.data(), reinterpret_cast<const unsigned char*>(image.data()),
                     image.size());
  link::Grant grant{};
  std::copy_n(hash.begin(), grant.image.size(), grant.image.begin());
  grant.trial_ms = how.trial_ms;
  grant.goes_back = how.goes_back;
  grant.fresh = how.fresh;
  return grant;
}

std::string denial_text(const link::Authority& authority) {
  switch (authority.denial) {
    case Denial::none:
    case Denial::unsigned_order:
    case Denial::stale:
    case Denial::too_soon:
    case Denial::starting:
    case Denial::no_owner:
      return {};
    case Denial::bad_signature:
      return "the robot says that the signature is not its owner's: is its firmware from another "
             "release than this rsc?";
    case Denial::has_owner:
      return fmt::format(
          "the robot already has an owner, with the key {}: run rsc unpair with that key first",
          id_of(authority.key));
    case Denial::nobody_there:
      return "the robot takes a key only in the first minute after it is switched on, so that only "
             "somebody next to it can give one: switch it off and on, and try again";
    case Denial::no_store:
      return "this board cannot be paired: it has no store for a key, or its firmware cannot "
             "verify signatures (docs/security.md)";
  }
  return "the robot gives a reason that this rsc does not know: flash the firmware of this release";
}

std::string owner_text(const link::Authority& authority) {
  switch (authority.pairing) {
    case Pairing::impossible:
      return "nobody: anyone on this line can give the robot orders, and this board cannot be "
             "paired";
    case Pairing::unpaired:
      return "nobody: anyone on this line can give the robot orders, until `rsc pair`";
    case Pairing::paired:
      return "key " + id_of(authority.key);
  }
  return "?";
}

Json owner_json(const link::Authority& authority) {
  constexpr std::array kWords = {"impossible", "unpaired", "paired"};
  const auto index = static_cast<std::size_t>(authority.pairing);
  Json object{{"pairing", index < kWords.size() ? kWords[index] : "?"}, {"key", nullptr}};
  if (authority.pairing == Pairing::paired) object["key"] = id_of(authority.key);
  return object;
}

}  // namespace robosync::tool
