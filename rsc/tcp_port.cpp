// See tcp_port.hpp.
#include "rsc/tcp_port.hpp"

#include <charconv>

namespace robosync::tool {

std::optional<std::uint16_t> tcp_port(std::string_view text) {
  std::uint16_t number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc{} || read.ptr != end || number == 0) return std::nullopt;
  return number;
}

}  // namespace robosync::tool
