// Uses libsndfile. The file is not trusted.
#include "rsc/trace/sound.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <sndfile.h>

#include "rsc/failure.hpp"
#include "rsc/loaded_library.hpp"
#include "vm/drivers.hpp"

namespace robosync::tool {
namespace {

constexpr int kLongestHours = 1;

// The functions used of libsndfile, which depends on half a dozen codecs.
struct SoundFiles {
#define SOUND_FUNCTIONS(F) F(open) F(close) F(readf_double) F(strerror)
#define FUNCTION(name) decltype(&sf_##name) name##_ = nullptr;
  SOUND_FUNCTIONS(FUNCTION)
#undef FUNCTION

  SoundFiles() {
    const LoadedLibrary library("libsndfile.so.1", "libsndfile1", "a sound in a scenario");
#define FIND(name) library.find("sf_" #name, name##_);
    SOUND_FUNCTIONS(FIND)
#undef FIND
  }
};

// The mean of the samples that fall into each sample of the ear; this weakens high tones that would alias.
class Resampler {
public:
  explicit Resampler(int rate) : rate_(rate) {}

  void take(double sample, std::vector<std::int16_t>& into) {
    sum_ += sample;
    ++count_;
    phase_ += drivers::kEarRate;
    if (phase_ < rate_) return;
    phase_ -= rate_;
    const double mean = std::clamp(sum_ / count_, -1.0, 1.0);
    into.push_back(static_cast<std::int16_t>(std::lround(mean * INT16_MAX)));
    sum_ = 0;
    count_ = 0;
  }

private:
  int rate_, phase_ = 0, count_ = 0;
  double sum_ = 0;
};

std::vector<std::int16_t> read_samples(const SoundFiles& library, SNDFILE* sound,
                                       const SF_INFO& format) {
  constexpr sf_count_t kFrames = 4096;
  const auto channels = static_cast<std::size_t>(format.channels);
  std::vector<double> frames(kFrames * channels);
  std::vector<std::int16_t> samples;
  Resampler resampler(format.samplerate);
  for (sf_count_t read = 0; (read = library.readf_double_(sound, frames.data(), kFrames)) > 0;)
    for (std::size_t f = 0; f < static_cast<std::size_t>(read); ++f) {
      double sum = 0;
      for (std::size_t c = 0; c < channels; ++c)
        sum += frames[f * channels + c];
      resampler.take(std::isfinite(sum) ? sum / format.channels : 0, samples);
    }
  return samples;
}

}  // namespace

std::vector<SoundBlock> hear_file(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw Failure(Exit::outside, fmt::format("cannot read {}: there is no such file", file));
  const SoundFiles library;
  SF_INFO format{};
  const std::unique_ptr<SNDFILE, decltype(library.close_)> sound(
      library.open_(file.c_str(), SFM_READ, &format), library.close_);
  if (!sound)
    throw Failure(Exit::program,
                  fmt::format("{}: it is not a sound file: {}", file, library.strerror_(nullptr)));
  if (format.samplerate < static_cast<int>(drivers::kEarRate))
    throw Failure(Exit::program,
                  fmt::format("{}: it has {} samples a second; at least {} are needed", file,
                              format.samplerate, drivers::kEarRate));
  if (format.frames / format.samplerate > sf_count_t{3600} * kLongestHours)
    throw Failure(Exit::program, fmt::format("{}: it is longer than an hour", file));
  const std::vector<std::int16_t> samples = read_samples(library, sound.get(), format);
  std::vector<SoundBlock> heard;
  drivers::Ear ear;
  for (std::size_t at = 0; at + drivers::kEarBlock <= samples.size(); at += drivers::kEarBlock) {
    const auto [loudness, highs, pitch, clarity] =
        ear.hear(std::span(samples).subspan(at).first<drivers::kEarBlock>());
    SoundBlock& block = heard.emplace_back(SoundBlock{loudness, highs, pitch, clarity});
    std::ranges::copy(ear.bands(), block.begin() + vm::kFirstOfSpectrum);
  }
  return heard;
}

}  // namespace robosync::tool
