// Orders, and what their signature covers. Both ends use this file.
//
// A signature covers the order, its payload, the board's boot id, and the order's number. So a signature that was recorded from
// the line is not valid for another order, for another board, after a reset, or a second time. The text begins with fixed words,
// so that no signature made for another purpose fits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"

namespace robosync::link {

enum class Direction : std::uint8_t { to_board, to_host, order };

constexpr Direction direction_of(MessageType type) {
  switch (type) {
#define MESSAGE(name, number, direction, doc) \
  case MessageType::name:                     \
    return Direction::direction;
#include "link/messages.def"
#undef MESSAGE
  }
  return Direction::to_host;  // an unknown message: boards ignore it, like those to the host
}

constexpr bool is_order(MessageType type) {
  return direction_of(type) == Direction::order;
}

struct OrderText {  // followed by the payload of the order
  std::array<char, 16> words{'R', 'o', 'b', 'o', 'S', 'y', 'n', 'c',
                             ' ', 'o', 'r', 'd', 'e', 'r', ' ', '1'};
  BootId boot{};
  std::uint64_t number = 0;
  std::uint8_t type = 0;
  std::uint8_t length = 0;  // of the payload
  std::array<std::uint8_t, 6> reserved{};
};
inline constexpr std::size_t kMaxOrderText = sizeof(OrderText) + kMaxOrder;

// Writes the text that is signed for `order` with `payload` (at most kMaxOrder bytes). Returns its bytes.
std::span<const std::byte> order_text(const SignedOrder& order, std::span<const std::byte> payload,
                                      std::span<std::byte, kMaxOrderText> out);

}  // namespace robosync::link
