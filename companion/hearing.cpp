// See hearing.hpp.
#include "companion/hearing.hpp"

#include <algorithm>

namespace robosync::companion {

// Each two samples become one: a robot's microphone has half as many.
bool Hearing::next(own_words_frame& frame) {
  std::array<std::int16_t, 2 * kBlock> block{};
  const std::size_t count = source_->read(block);
  std::copy(past_.begin() + kBlock, past_.end(), past_.begin());
  for (std::size_t i = 0; i < kBlock; ++i)
    past_[past_.size() - kBlock + i] =
        static_cast<std::int16_t>((block[2 * i] + block[2 * i + 1]) / 2);
  std::array<std::int16_t, drivers::kSpectrumWindow> work;
  const drivers::BandValues bands = drivers::bands_of(past_, work);
  std::ranges::transform(bands, frame.values,
                         [](vm::Value value) { return static_cast<std::uint32_t>(value); });
  return count == block.size();
}

}  // namespace robosync::companion
