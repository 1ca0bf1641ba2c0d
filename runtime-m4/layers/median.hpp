// The newest samples of a signal, and their median at any time.
//
// A ring buffer holds the samples in the order of arrival. A second array, of one byte per sample,
// holds their places in the ring, sorted by value. A new sample replaces the oldest one in both, which
// costs two binary searches and one move of bytes, whatever the values are.
#pragma once

#include <cstdint>

#include "vm/image.hpp"

namespace robosync::layers {

class MedianWindow {
public:
  // Room for the samples of several windows: one element of each for a sample. The parts of a window are consecutive.
  struct Room {
    vm::Value* samples = nullptr;
    std::uint8_t* order = nullptr;
  };

  MedianWindow() = default;
  // An empty window, whose part of the room begins with this element.
  explicit MedianWindow(std::uint16_t first) : first_(first) {}

  void clear() { count_ = newest_ = 0; }
  bool is_empty() const { return count_ == 0; }
  // Both return the new median: with an even number of samples, the lower of the middle two.
  // push() drops the oldest sample once the window has `size` samples, 2 to vm::kMaxWindow.
  [[gnu::noinline]] vm::Value push(const Room& room, unsigned size, vm::Value value);
  // Not for an empty window.
  [[gnu::noinline]] vm::Value replace_newest(const Room& room, vm::Value value);

private:
  std::uint8_t count_ = 0;
  std::uint8_t newest_ = 0;  // index in the ring, which runs backwards
  std::uint16_t first_ = 0;
};

}  // namespace robosync::layers
