// See said.hpp. The text is not trusted.
#include "rsc/companion/said.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

namespace robosync::tool {

std::optional<Said> parse_said(std::string_view line) {
  const std::size_t space = line.find(' ');
  if (space == 0 || space == std::string_view::npos || space + 1 == line.size())
    return std::nullopt;
  return Said{line.substr(0, space), line.substr(space + 1)};
}

std::optional<vm::Value> parse_value(const vm::Image& image, const vm::Channel& channel,
                                     std::string_view text) {
  for (std::size_t i = 0; i < channel.label_count; ++i)
    if (image.string(image.labels[channel.first_label + i]) == text)
      return static_cast<vm::Value>(i) * vm::kScale;
  if (channel.label_count != 0) return std::nullopt;
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(number)) return std::nullopt;
  const double value = std::round(number * vm::kScale);
  if (!(value >= channel.min && value <= channel.max)) return std::nullopt;
  return static_cast<vm::Value>(value);
}

}  // namespace robosync::tool
