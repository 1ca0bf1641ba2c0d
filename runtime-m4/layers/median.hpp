// The newest samples of a signal, and their median at any time.
//
// The samples stand in a ring, in the order in which they came; beside it stand their places in the
// order of their size, one byte each. A new sample takes the place of the oldest one in both, so that
// it costs two searches by halves and one move of bytes, however the samples lie.
#pragma once

#include <cstdint>
#include <span>

#include "vm/image.hpp"

namespace robosync::layers {

class MedianWindow {
public:
  // What it remembers besides the samples. New: an empty window.
  struct State {
    std::uint8_t count = 0;
    std::uint8_t newest = 0;  // place in the ring
  };

  // A place for each sample in both; 1 to vm::kMaxWindow of them.
  MedianWindow(std::span<vm::Value> ring, std::span<std::uint8_t> order, State& state)
      : ring_(ring.data()),
        order_(order.data()),
        size_(static_cast<unsigned>(ring.size())),
        state_(state) {}

  // The oldest sample goes, once there are as many as there are places.
  void push(vm::Value value) {
    const unsigned next = state_.newest + 1U;
    state_.newest = static_cast<std::uint8_t>(next < size_ ? next : 0);
    take(value, false);
  }
  void replace_newest(vm::Value value) { take(value, true); }
  // The lower middle one, of an even number. Not of an empty window.
  vm::Value median() const { return ring_[order_[(state_.count - 1U) / 2]]; }

private:
  void take(vm::Value value, bool in_place_of_newest);

  vm::Value* ring_;
  // Places in the ring by the size of what stands there; of equals the older one first.
  std::uint8_t* order_;
  unsigned size_;
  State& state_;
};

}  // namespace robosync::layers
