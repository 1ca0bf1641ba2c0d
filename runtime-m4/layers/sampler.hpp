// What the sensor layer measures with: drivers on the board, fed values in the simulator.
#pragma once

#include "runtime-m4/boards/board.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

class Sampler {
public:
  // One sample of a channel in thousandths of its unit. False when there is none to be had.
  virtual bool sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) = 0;

protected:
  ~Sampler() = default;
};

// Asks the channel's driver and scales what it counts.
class DriverSampler final : public Sampler {
public:
  explicit DriverSampler(boards::Board& board) : board_(board) {}
  bool sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) override;

private:
  boards::Board& board_;
};

// raw * scale_num / scale_den + offset, rounded half away from zero, saturating.
[[nodiscard]] vm::Value scaled(std::int32_t raw, const vm::Channel& channel);

}  // namespace robosync::layers
