// Measures how long an echo pin is high after a ping. The board reports each edge from its interrupt, with the level that it
// sees then.
//
// A measurement ends with the second edge at the latest: the board then disables the pin's interrupt.
#pragma once

#include <cstdint>

namespace robosync::boards {

class Echo {
public:
  // False if the pin is already high: nothing can be measured, and the board ignores its edges.
  bool begin(bool high) {
    state_ = State::asked;
    return !high;
  }
  // One edge or several, after which the pin has this level; `now` is a counter that counts up. True: the measurement is over.
  bool edge(bool high, std::uint32_t now) {
    if (state_ == State::asked && high) {
      state_ = State::rose;
      counts_ = now & kCounts;
      return false;
    }
    const bool fell = state_ == State::rose && !high;
    state_ = fell ? State::fell : State::nothing;
    if (fell) counts_ = (now - counts_) & kCounts;
    return true;
  }
  // The time in counts; 0: not measured. Call it only when edges are no longer reported.
  [[nodiscard]] std::uint32_t take() const { return state_ == State::fell ? counts_ : 0; }

private:
  enum class State : std::uint32_t { nothing, asked, rose, fell };
  static constexpr std::uint32_t kCounts = (1U << 30) - 1;  // more than 13 s on each board

  std::uint32_t counts_ : 30 = 0;  // when it rose; then, how long it was high
  State state_ : 2 = State::nothing;
};

}  // namespace robosync::boards
