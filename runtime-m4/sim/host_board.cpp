// See host_board.hpp.
#include "runtime-m4/sim/host_board.hpp"

namespace robosync::sim {

bool HostBoard::i2c_transfer(std::uint8_t, std::uint8_t, std::span<const std::byte>,
                             std::span<std::byte>) {
  return false;
}

std::uint32_t HostBoard::pwm_read(std::uint16_t pin) const {
  const auto found = pulses_.find(pin);
  return found == pulses_.end() ? 0 : found->second;
}

}  // namespace robosync::sim
