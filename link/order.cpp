// See order.hpp.
#include "link/order.hpp"

#include <algorithm>

#include "link/wire.hpp"

namespace robosync::link {

std::span<const std::byte> order_text(const SignedOrder& order, std::span<const std::byte> payload,
                                      std::span<std::byte, kMaxOrderText> out) {
  OrderText head;
  head.boot = order.boot;
  head.number = order.number;
  head.type = order.type;
  head.length = static_cast<std::uint8_t>(payload.size());
  const auto end = std::ranges::copy(wire_bytes(head), out.begin()).out;
  std::ranges::copy(payload, end);
  return out.first(sizeof head + payload.size());
}

}  // namespace robosync::link
