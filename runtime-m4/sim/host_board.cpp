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

// No encoder turns but those of a drive.
bool HostBoard::take_edges(unsigned number, std::uint16_t, std::uint8_t, unsigned,
                           boards::Turned& turned) {
  turned = {.edges = 0, .ago = 0, .begun = !begun_[number]};
  begun_[number] = true;
  return wheels_.is_on(number);
}

}  // namespace robosync::sim
