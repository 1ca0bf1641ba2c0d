// Sends an image to the board as it is, even if the tool would not send it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "rsc/device/client.hpp"
#include "tests/runtime-m4/update/robot.hpp"

namespace robosync::test {

// `hash`: the announced name.
inline void transfer(Robot& robot, tool::Client& client, std::span<const std::byte> image,
                     const link::ProgramHash& hash) {
  const link::Begin begin{client.session(), static_cast<std::uint32_t>(image.size()), hash, {}};
  client.send(link::MessageType::begin, link::wire_bytes(begin));
  for (std::uint32_t at = 0; at < image.size(); at += 200) {
    const link::Data head{static_cast<std::uint16_t>(client.session()),
                          static_cast<std::uint16_t>(at)};
    std::vector<std::byte> payload(sizeof head);
    std::memcpy(payload.data(), &head, sizeof head);
    const auto part = image.subspan(at, std::min<std::size_t>(200, image.size() - at));
    payload.insert(payload.end(), part.begin(), part.end());
    client.send(link::MessageType::data, payload);
    robot.run(50);
  }
}

}  // namespace robosync::test
