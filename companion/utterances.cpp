// See utterances.hpp.
#include "companion/utterances.hpp"

#include <algorithm>
#include <cmath>

namespace robosync::companion {
namespace {

constexpr std::size_t kLookEvery = 8;  // frames
constexpr std::size_t kFirstLook = 16;
constexpr std::size_t kSoftest = 5;       // the softest fifth of the frames is noise
constexpr std::uint8_t kLeastNoise = 30;  // below that is the effect of a sample's last bit
constexpr int kMargin = 4;                // noise varies: a band counts from this level above it
constexpr int kLoud = 3;                  // mean of all bands above that: the frame is loud
constexpr std::size_t kInARow = 2;

}  // namespace

Utterances::Utterances() {
  for (std::size_t level = 0; level < powers_.size(); ++level)
    powers_[level] = std::pow(10, static_cast<double>(level) / 20);
  noise_.fill(kLeastNoise);
  utterance_.levels.reserve(kMostFrames + kPause + kBefore + kSmooth);
}

const Levels& Utterances::ago(std::size_t frames) const {
  return frames_[(count_ - 1 - frames) % kMemory];
}

void Utterances::remember(const Levels& levels) {
  frames_[count_++ % kMemory] = levels;
  const std::size_t together = std::min(count_, kSmooth);
  for (std::size_t band = 0; band < kBands; ++band) {
    double power = 0;
    for (std::size_t i = 0; i < together; ++i)
      power += powers_[ago(i)[band]];
    smooth_[(count_ - 1) % kMemory][band] = static_cast<std::uint8_t>(
        std::lround(20 * std::log10(power / static_cast<double>(together))));
  }
  if (count_ >= kFirstLook && count_ % kLookEvery == 0) look_at_noise();
}

void Utterances::look_at_noise() {
  const std::size_t known = std::min(count_, kMemory);
  std::array<std::uint8_t, kMemory> sorted;
  for (std::size_t band = 0; band < kBands; ++band) {
    for (std::size_t i = 0; i < known; ++i)
      sorted[i] = smooth_[i][band];
    const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(known / kSoftest);
    std::nth_element(sorted.begin(), place, sorted.begin() + static_cast<std::ptrdiff_t>(known));
    noise_[band] = std::max(*place, kLeastNoise);
  }
}

bool Utterances::is_loud() const {
  int above = 0;
  for (std::size_t band = 0; band < kBands; ++band)
    above += std::max(smooth_[(count_ - 1) % kMemory][band] - noise_[band] - kMargin, 0);
  return above >= kLoud * static_cast<int>(kBands);
}

void Utterances::learn(const Levels& levels) {
  remember(levels);
}

bool Utterances::hear(const Levels& levels) {
  remember(levels);
  if (count_ < kFirstLook) return false;
  const bool loud = is_loud();
  loud_in_a_row_ = loud ? loud_in_a_row_ + 1 : 0;
  if (!talks_) {
    if (loud_in_a_row_ == kInARow) begin();
    return false;
  }
  ++length_;
  if (utterance_.levels.size() < utterance_.levels.capacity()) utterance_.levels.push_back(levels);
  if (loud) loud_until_ = length_;
  return length_ - loud_until_ >= kPause && end();
}

void Utterances::begin() {
  talks_ = true;
  utterance_.noise = noise_;
  utterance_.levels.clear();
  const std::size_t frames = std::min(kBefore + kInARow, std::min(count_, kMemory));
  for (std::size_t i = frames; i-- > 0;)
    utterance_.levels.push_back(ago(i));
  length_ = loud_until_ = frames;
}

// The last frames may be loud only because they are averaged with those before them.
bool Utterances::end() {
  talks_ = false;
  const std::size_t frames = loud_until_ - std::min(loud_until_, kSmooth - 2);
  was_too_long_ = frames > kMostFrames;
  if (was_too_long_ || frames < kBefore + kLeastFrames) return false;
  utterance_.levels.resize(frames);
  return true;
}

}  // namespace robosync::companion
