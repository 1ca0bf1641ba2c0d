// A model of a chain of WS2812 lights, from Worldsemi's data sheet of the WS2812B: "Data transfer time", "Sequence chart" and
// "Cascade method". It is independent of the driver.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace robosync::tests {

class Ws2812Chain {
public:
  explicit Ws2812Chain(std::size_t lights) : shown_(lights) {}

  // The level of its line for the next `ns` nanoseconds.
  void hear(bool high, unsigned ns);

  // 0xRRGGBB of each, the first one in the chain first.
  const std::vector<std::uint32_t>& shown() const { return shown_; }
  unsigned pictures() const { return pictures_; }    // complete ones
  unsigned disturbed() const { return disturbed_; }  // bits whose times violate the data sheet

private:
  void end_bit(bool silence);
  void end_picture();

  std::vector<std::uint32_t> shown_;
  std::vector<bool> bits_;
  unsigned high_ns_ = 0, low_ns_ = 0, pictures_ = 0, disturbed_ = 0;
};

}  // namespace robosync::tests
