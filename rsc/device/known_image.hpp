// The last image uploaded over a line, in this user's cache: the next upload sends only the difference. The board says whether it
// still runs that image, so correctness does not depend on the cache.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace robosync::tool {

// Empty if none is known, or the cached file is damaged.
[[nodiscard]] std::vector<std::byte> known_image(const std::string& port);
// A cache that cannot be written is not an error.
void know_image(const std::string& port, std::span<const std::byte> image);

}  // namespace robosync::tool
