// See microphone.hpp.
#include "runtime-m4/drivers/microphone.hpp"

#include <array>
#include <utility>

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers {

static_assert(kEarBlock == boards::kSoundBlock && kEarPeriodMs == vm::kSoundPeriodMs);

// Sampled by the class below.
bool microphone::read(boards::Board& /*board*/, const vm::Sensor& /*sensor*/,
                      const vm::Channel& /*channel*/, std::int32_t& /*raw*/) {
  return false;
}

// Not inlined, like the one below: it would enlarge the stack frame of every driver's sample.
[[gnu::noinline]] vm::Value Microphone::part(unsigned input) {
  if (input >= vm::kFirstOfSpectrum) {
    if (!std::exchange(has_bands_, true)) bands_ = ear_.bands();
    return bands_[input - vm::kFirstOfSpectrum];
  }
  if (!std::exchange(has_heard_, true)) heard_ = ear_.hear_next();
  return std::array{heard_.loudness, heard_.highs, heard_.pitch, heard_.clarity}[input];
}

[[gnu::noinline]] bool Microphone::sample(boards::Board& board, bool is_first,
                                          const vm::Channel& channel, vm::Value& value) {
  if (is_first) {
    hears_ = board.hear(ear_.next());
    has_heard_ = has_bands_ = false;
    if (!hears_) ear_.forget();
  }
  if (!hears_ || channel.input >= vm::kFirstOfSpectrum + std::tuple_size_v<BandValues>)
    return false;
  value = part(channel.input);
  return true;
}

}  // namespace robosync::drivers
