// The image that was uploaded last over a line, kept in this user's cache: the next one travels as what differs from it. The board
// says whether it still runs that one; so nothing depends on what is kept here.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace robosync::tool {

// Empty when none is known, or what is kept is not whole.
[[nodiscard]] std::vector<std::byte> known_image(const std::string& port);
// A place that cannot be written is no failure.
void know_image(const std::string& port, std::span<const std::byte> image);

}  // namespace robosync::tool
