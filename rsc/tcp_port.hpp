// Parses a TCP port number as written after a host.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace robosync::tool {

// 1 to 65535. getaddrinfo() would take a larger number for another port.
[[nodiscard]] std::optional<std::uint16_t> tcp_port(std::string_view text);

}  // namespace robosync::tool
