// The difference that a board with another image needs: ranges of that image or of what it has just received, and the bytes in
// between (link::Piece).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace robosync::tool {

class Pieces {
public:
  // `base`: the image that the board has; may be empty. `image` must outlive it.
  Pieces(std::span<const std::byte> base, std::span<const std::byte> image);

  // Fills `payload` with pieces of the image from `at` on. Returns the end of them in the image.
  std::size_t fill(std::size_t at, std::size_t most_bytes, std::vector<std::byte>& payload) const;

private:
  struct Range {
    std::size_t begin, end;  // of the image
    std::size_t from;  // where the board has it already, as an offset from the start of the base
  };
  void find_ranges(std::span<const std::byte> all);

  std::span<const std::byte> image_;
  std::size_t base_bytes_;
  std::vector<Range> ranges_;  // what need not be sent, in order
};

}  // namespace robosync::tool
