// See median.hpp. Built for speed, without turning its loops into calls of memmove (layers.cmake).
#include "runtime-m4/layers/median.hpp"

#include <bit>
#include <cstring>

namespace robosync::layers {
namespace {

static_assert(vm::kMaxWindow == 32, "first_behind() halves so many");

// Moves four bytes at once, whatever the addresses.
void move_four(std::uint8_t* to, const std::uint8_t* from) {
  std::uint32_t four = 0;
  std::memcpy(&four, from, sizeof four);
  std::memcpy(to, &four, sizeof four);
}

// The first of `count` places whose sample is not below `value` and, with kEquals, not equal to it
// either. A binary search without branches that depend on the samples: before() holds for all places in front of `at`.
template <bool kEquals>
[[gnu::noinline]] std::uint8_t* first_behind(const vm::Value* ring, std::uint8_t* order,
                                             unsigned count, vm::Value value) {
  const auto before = [&](unsigned place) {
    return kEquals ? ring[place] <= value : ring[place] < value;
  };
  const unsigned half = std::bit_floor(count);
  std::uint8_t* at = before(order[half - 1]) ? order + (count - half) + 1 : order;
  const auto look = [&](unsigned step) {
    if (before(at[step - 1])) at += step;
  };
  if (half > 16) look(16);
  if (half > 8) look(8);
  if (half > 4) look(4);
  if (half > 2) look(2);
  if (half > 1) look(1);
  return at;
}

// Moves the places behind `from`, up to `to`, down by one.
std::uint8_t* move_down(std::uint8_t* from, const std::uint8_t* to) {
  for (; to - from >= 8; from += 8) {
    move_four(from, from + 1);
    move_four(from + 4, from + 5);
  }
  if (to - from >= 4) {
    move_four(from, from + 1);
    from += 4;
  }
  for (; from < to; ++from)
    *from = from[1];
  return from;
}

// Moves the places in front of `from`, back to `to`, up by one.
std::uint8_t* move_up(std::uint8_t* from, const std::uint8_t* to) {
  for (; from - to >= 8; from -= 8) {
    move_four(from - 3, from - 4);
    move_four(from - 7, from - 8);
  }
  if (from - to >= 4) {
    move_four(from - 3, from - 4);
    from -= 4;
  }
  for (; from > to; --from)
    *from = from[-1];
  return from;
}

}  // namespace

// Replaces the newest sample, which is the last of its equals, or, in a full window, the oldest, which
// is the first of its equals. Until the window is full, nothing else goes. The new sample is placed behind its equals.
void MedianWindow::take(vm::Value value, bool in_place_of_newest) {
  const unsigned count = state_.count;
  const unsigned place = state_.newest;
  std::uint8_t* from = order_ + count;
  if (in_place_of_newest) {
    from = first_behind<true>(ring_, order_, count, ring_[place]) - 1;
  } else if (count == size_) {
    from = first_behind<false>(ring_, order_, count, ring_[place]);
  } else {
    state_.count = static_cast<std::uint8_t>(count + 1);
  }
  std::uint8_t* const to = count == 0 ? from : first_behind<true>(ring_, order_, count, value);
  *(to > from ? move_down(from, to - 1) : move_up(from, to)) = static_cast<std::uint8_t>(place);
  ring_[place] = value;
}

}  // namespace robosync::layers
