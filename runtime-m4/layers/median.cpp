// See median.hpp. Built for speed, and without loops: each sample of SMOOTH passes through this.
#include "runtime-m4/layers/median.hpp"

#include <bit>
#include <cstring>

namespace robosync::layers {
namespace {

static_assert(vm::kMaxWindow == 32, "Order halves so many places, and move_by() moves one less");

// The places of the samples, sorted. There are at least two. All but the last are searched.
class Order {
public:
  Order(vm::Value* ring, std::uint8_t* places, unsigned count)
      : ring_(ring),
        first_(places),
        count_(count),
        rest_(count - 1),
        half_(kHighest >> std::countl_zero(rest_)) {}

  // The first place whose sample is above `value`, or else the last place. A binary search in a fixed number of steps: the
  // samples in front of `at` are not above.
  [[gnu::always_inline]] std::uint8_t* behind(vm::Value value) const {
    std::uint8_t* at = first_;
    if (!is_above(first_ + (half_ - 1), value)) at += count_ - half_;
    const auto look = [&](unsigned step) {
      if (!is_above(at + (step - 1), value)) at += step;
    };
    if (half_ > 8) [[likely]]
      look(8);
    if (half_ > 4) look(4);
    if (half_ > 2) look(2);
    if (half_ > 1) look(1);
    return at;
  }
  bool is_above(const std::uint8_t* place, vm::Value value) const { return ring_[*place] > value; }
  std::uint8_t* last() const { return first_ + rest_; }
  void write(unsigned place, vm::Value value) const { ring_[place] = value; }
  vm::Value median() const { return ring_[first_[rest_ / 2]]; }

private:
  static constexpr std::uint32_t kHighest = std::uint32_t{1} << 31;

  vm::Value* ring_;
  std::uint8_t* first_;
  unsigned count_;
  unsigned rest_;  // how many are searched
  unsigned half_;  // the highest bit of that
};

std::uint32_t read_four(const std::uint8_t* from) {
  std::uint32_t four = 0;
  std::memcpy(&four, from, sizeof four);
  return four;
}

void write_four(std::uint8_t* to, std::uint32_t four) {
  std::memcpy(to, &four, sizeof four);
}

// Moves one place by one: kBy is 1 or -1. `nth` counts from the end that moves last.
template <int kBy>
void move_one(std::uint8_t* first, std::uint8_t* end, std::size_t nth) {
  std::uint8_t* const from = kBy > 0 ? first + (nth - 1) : end - nth;
  from[kBy] = *from;
}

// … a word of four places; `nth` counts words.
template <int kBy>
void move_four(std::uint8_t* first, std::uint8_t* end, std::size_t nth) {
  std::uint8_t* const from = kBy > 0 ? first + 4 * (nth - 1) : end - 4 * nth;
  write_four(from + kBy, read_four(from));
}

// … so many words, 1 to 7. A loop takes 17 instructions more for 7 of them, even if it is unrolled.
template <int kBy>
[[gnu::always_inline]] inline void move_fours(std::uint8_t* first, std::uint8_t* end,
                                              unsigned words) {
  switch (words) {
    case 7:
      move_four<kBy>(first, end, 7);
      [[fallthrough]];
    case 6:
      move_four<kBy>(first, end, 6);
      [[fallthrough]];
    case 5:
      move_four<kBy>(first, end, 5);
      [[fallthrough]];
    case 4:
      move_four<kBy>(first, end, 4);
      [[fallthrough]];
    case 3:
      move_four<kBy>(first, end, 3);
      [[fallthrough]];
    case 2:
      move_four<kBy>(first, end, 2);
      [[fallthrough]];
    default:
      move_four<kBy>(first, end, 1);
  }
}

// … all places, 31 at most. The four at the end that moves first are read before and written after the others, which may overlap
// them.
template <int kBy>
[[gnu::always_inline]] inline void move_by(std::uint8_t* first, std::uint8_t* end) {
  const auto count = static_cast<unsigned>(end - first);
  if (count < 4) {
    if (count > 2) move_one<kBy>(first, end, 3);
    if (count > 1) move_one<kBy>(first, end, 2);
    if (count > 0) move_one<kBy>(first, end, 1);
    return;
  }
  std::uint8_t* const rest = kBy > 0 ? end - 4 : first;
  const std::uint32_t four = read_four(rest);
  move_fours<kBy>(first, end, count / 4);
  write_four(rest + kBy, four);
}

// Gives `place`, which is at `from`, the new value, and moves it to behind all samples that are not above. Returns the median.
[[gnu::always_inline]] inline vm::Value put(const Order& order, std::uint8_t* from, unsigned place,
                                            vm::Value value) {
  std::uint8_t* to = order.behind(value);
  if (to > from) [[likely]] {
    if (to != order.last() || order.is_above(to, value)) --to;
    move_by<-1>(from + 1, to + 1);
  } else {
    move_by<1>(to, from);
  }
  *to = static_cast<std::uint8_t>(place);
  order.write(place, value);
  return order.median();
}

}  // namespace

vm::Value MedianWindow::push(const Room& room, unsigned size, vm::Value value) {
  vm::Value* const ring = room.samples + first_;
  std::uint8_t* const places = room.order + first_;
  const unsigned place = (newest_ == 0 ? size : newest_) - 1;  // the ring runs backwards
  newest_ = static_cast<std::uint8_t>(place);
  const bool full = count_ == size;
  if (!full) [[unlikely]] {
    places[count_] = newest_;
    if (++count_ == 1) return ring[place] = value;
  }
  const Order order(ring, places, count_);
  // The oldest sample is the first of its equals.
  return put(order, full ? order.behind(ring[place] - 1) : order.last(), place, value);
}

vm::Value MedianWindow::replace_newest(const Room& room, vm::Value value) {
  vm::Value* const ring = room.samples + first_;
  if (count_ == 1) return ring[newest_] = value;
  const Order order(ring, room.order + first_, count_);
  // It is the last of its equals, and the last place is not searched.
  std::uint8_t* from = order.behind(ring[newest_]);
  if (*from != newest_) --from;
  return put(order, from, newest_, value);
}

}  // namespace robosync::layers
