// The newest samples of a signal, and their median at any time.
//
// A ring buffer holds the samples in the order of arrival. A second array, of one byte per sample,
// holds their places in the ring, sorted by value. A new sample replaces the oldest one in both, which
// costs two binary searches and one move of bytes, whatever the values are.
#pragma once

#include <cstdint>
#include <span>

#include "vm/image.hpp"

namespace robosync::layers {

class MedianWindow {
public:
  // The state besides the samples. A new one is an empty window.
  struct State {
    std::uint8_t count = 0;
    std::uint8_t newest = 0;  // index in the ring, which runs backwards
  };

  // Both have one element per sample, 1 to vm::kMaxWindow.
  MedianWindow(std::span<vm::Value> ring, std::span<std::uint8_t> order, State& state)
      : ring_(ring.data()),
        order_(order.data()),
        size_(static_cast<unsigned>(ring.size())),
        state_(state) {}

  // Both return the new median: with an even number of samples, the lower of the middle two.
  // Drops the oldest sample once the window is full.
  vm::Value push(vm::Value value) { return push(ring_, order_, state_, size_, value); }
  // Not for an empty window.
  vm::Value replace_newest(vm::Value value) { return replace_newest(ring_, order_, state_, value); }

private:
  // Their arguments are in registers, which costs less than an object in memory, and the caller keeps registers of its own.
  [[gnu::noinline]] static vm::Value push(vm::Value* ring, std::uint8_t* order, State& state,
                                          unsigned size, vm::Value value);
  [[gnu::noinline]] static vm::Value replace_newest(vm::Value* ring, std::uint8_t* order,
                                                    State& state, vm::Value value);

  vm::Value* ring_;
  // Indices into the ring, sorted by value; of equal values the older one first.
  std::uint8_t* order_;
  unsigned size_;
  State& state_;
};

}  // namespace robosync::layers
