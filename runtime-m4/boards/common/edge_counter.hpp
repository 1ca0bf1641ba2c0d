// Counts the edges of a wheel's encoder. The board reports each edge of pin A from its interrupt, with the levels that it sees
// then.
//
// Between two takes it counts as many edges as the last take allowed. After that the board ignores the pin's edges, so a wire that
// swings as fast as it can costs no more than a wheel at its greatest speed.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards {

class EdgeCounter {
public:
  // Of pin A, which is input `input` of the board's table and has this level now; `second` is how the board finds pin B.
  void begin(std::size_t input, std::size_t second, bool a, std::uint32_t now) {
    *this = {};
    input_ = static_cast<std::uint8_t>(input);
    second_ = static_cast<std::uint8_t>(second);
    was_high_ = a;
    last_ = now;
  }
  void end() { input_ = kNoInput; }
  [[nodiscard]] bool counts(std::size_t input) const { return input_ == input; }
  [[nodiscard]] std::uint8_t second() const { return second_; }

  // One edge or several, after which pin A has this level; `ahead`: they go forward, as B is not as A is. `now` is a counter that
  // counts up. False: there were too many, and the board ignores the next ones.
  bool edge(bool a, bool ahead, std::uint32_t now) {
    if (left_ == 0) {
      if (!lost_) ++losses_;
      lost_ = true;
      return false;
    }
    --left_;
    if (a == was_high_) return true;
    was_high_ = a;
    edges_ += ahead ? 1U : ~0U;
    last_ = now;
    return true;
  }

  // Zeros if it counts nothing.
  [[nodiscard]] policy::EncoderCount so_far() const {
    if (input_ == kNoInput) return {};
    return {.edges = static_cast<std::int32_t>(edges_), .losses = losses_};
  }

  // Allows `most` edges from now on. False: some were lost. Call it while no edge is reported.
  bool take(bool a, unsigned most, std::uint32_t now, Turned& turned) {
    const bool lost = lost_;
    if (lost) was_high_ = a;
    turned = {.edges = static_cast<std::int32_t>(edges_), .ago = now - last_, .begun = false};
    lost_ = false;
    left_ = static_cast<std::uint16_t>(most);
    return !lost;
  }

private:
  static constexpr std::uint8_t kNoInput = 0xFF;

  std::uint32_t edges_ = 0, last_ = 0;
  std::uint16_t left_ = 0;
  std::uint8_t input_ = kNoInput, second_ = 0, losses_ = 0;
  bool was_high_ = false, lost_ = false;
};

}  // namespace robosync::boards
