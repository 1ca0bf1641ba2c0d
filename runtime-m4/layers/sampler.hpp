// What the sensor layer measures with: drivers on the board, fed values in the simulator.
#pragma once

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

class Sampler {
public:
  // One sample of a channel in thousandths of its unit. False when there is none to be had.
  virtual bool sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) = 0;

protected:
  ~Sampler() = default;
};

// Asks the channel's driver and scales what it counts. One thread at a time has the board's buses:
// a driver may need several transfers that belong together.
class DriverSampler final : public Sampler {
public:
  DriverSampler(kernel::Kernel& kernel, boards::Board& board) : kernel_(kernel), board_(board) {}
  bool sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) override;

private:
  kernel::Kernel& kernel_;
  boards::Board& board_;
  kernel::Mutex buses_{kernel::Category::sensor};
};

// raw * scale_num / scale_den + offset, rounded half away from zero, saturating.
[[nodiscard]] vm::Value scaled(std::int32_t raw, const vm::Channel& channel);

}  // namespace robosync::layers
