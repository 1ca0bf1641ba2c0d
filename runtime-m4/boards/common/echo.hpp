// How long a pin is high after it was asked to be: what a board makes of the edges of an echo pin, of which it tells as
// interrupts come, with the level that it sees then.
//
// Whatever comes, a measurement is over with the second edge: who looks after the pin lets it interrupt no more then.
#pragma once

#include <cstdint>

namespace robosync::boards {

class Echo {
public:
  // A pin that is high already says nothing: false, and its edges are not looked at.
  bool begin(bool high) {
    state_ = State::asked;
    return !high;
  }
  // An edge, or several, after which the pin has this level, at `now` of a counter that counts up. True: it is over.
  bool edge(bool high, std::uint32_t now) {
    if (state_ == State::asked && high) {
      state_ = State::rose;
      counts_ = now;
      return false;
    }
    const bool fell = state_ == State::rose && !high;
    state_ = fell ? State::fell : State::nothing;
    if (fell) counts_ = now - counts_;
    return true;
  }
  // Of the counter; 0: it was not measured. Edges are looked at no more then.
  [[nodiscard]] std::uint32_t take() const { return state_ == State::fell ? counts_ : 0; }

private:
  enum class State : std::uint8_t { nothing, asked, rose, fell };

  std::uint32_t counts_ = 0;  // when it rose; then, how long it was high
  State state_ = State::nothing;
};

}  // namespace robosync::boards
