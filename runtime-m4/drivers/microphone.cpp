// See microphone.hpp.
#include "runtime-m4/drivers/microphone.hpp"

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers {

static_assert(kEarBlock == boards::kSoundBlock && kEarPeriodMs == vm::kSoundPeriodMs);

// Sampled by the class below.
bool microphone::read(boards::Board& /*board*/, const vm::Sensor& /*sensor*/,
                      const vm::Channel& /*channel*/, std::int32_t& /*raw*/) {
  return false;
}

void Microphone::listen(boards::Board& board) {
  hears_ = board.hear(ear_.next());
  if (hears_)
    heard_ = ear_.hear_next();
  else
    ear_.forget();
}

// Not inlined: it would enlarge the stack frame of every driver's sample.
[[gnu::noinline]] bool Microphone::sample(boards::Board& board, bool is_first,
                                          const vm::Channel& channel, vm::Value& value) {
  if (is_first) listen(board);
  const std::array values{heard_.loudness, heard_.highs, heard_.pitch, heard_.clarity};
  if (!hears_ || channel.input >= values.size()) return false;
  value = values[channel.input];
  return true;
}

}  // namespace robosync::drivers
