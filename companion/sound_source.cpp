// Reads files with libsndfile, and a microphone from the stdout of arecord (package alsa-utils).
#include "companion/sound_source.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <deque>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sndfile.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "companion/worker.hpp"

namespace robosync::companion {
namespace {

class SoundFile final : public SoundSource {
public:
  SoundFile(const std::string& name, bool no_pace)
      : file_(sf_open(name.c_str(), SFM_READ, &format_)), no_pace_(no_pace) {
    constexpr int kLeast = 8'000;
    if (file_ == nullptr)
      throw Failure(Exit::asked_wrongly, name + " is no sound: " + sf_strerror(nullptr));
    if (format_.samplerate < kLeast || format_.channels > 64) {
      sf_close(file_);
      throw Failure(Exit::asked_wrongly, name + " has fewer than 8000 samples a second");
    }
  }
  ~SoundFile() override { sf_close(file_); }
  SoundFile(const SoundFile&) = delete;
  SoundFile& operator=(const SoundFile&) = delete;

  std::size_t read(std::span<std::int16_t> samples) override {
    while (ready_.size() < samples.size() && fill()) {
    }
    const std::size_t count = std::min(samples.size(), ready_.size());
    std::copy_n(ready_.begin(), count, samples.begin());
    ready_.erase(ready_.begin(), ready_.begin() + static_cast<std::ptrdiff_t>(count));
    given_ += count;
    if (!no_pace_)
      std::this_thread::sleep_until(
          begun_ + std::chrono::microseconds(given_ * 1'000'000 / std::uint64_t{kSoundRate}));
    return count;
  }

private:
  // Resamples: outputs the mean of the input samples that fall into an output sample, or repeats one.
  void take(double sample) {
    sum_ += sample;
    ++count_;
    phase_ += kSoundRate;
    if (phase_ < format_.samplerate) return;
    const double mean = std::clamp(sum_ / count_, -1.0, 1.0);
    const auto whole = static_cast<std::int16_t>(std::lround(mean * INT16_MAX));
    for (; phase_ >= format_.samplerate; phase_ -= format_.samplerate)
      ready_.push_back(whole);
    sum_ = 0;
    count_ = 0;
  }

  bool fill() {
    constexpr sf_count_t kFrames = 1024;
    const auto channels = static_cast<std::size_t>(format_.channels);
    std::vector<double> frames(kFrames * channels);
    const sf_count_t read = sf_readf_double(file_, frames.data(), kFrames);
    for (std::size_t f = 0; f < static_cast<std::size_t>(std::max<sf_count_t>(read, 0)); ++f) {
      double sum = 0;
      for (std::size_t c = 0; c < channels; ++c)
        sum += frames[f * channels + c];
      take(std::isfinite(sum) ? sum / format_.channels : 0);
    }
    return read > 0;
  }

  SF_INFO format_{};
  SNDFILE* file_;
  bool no_pace_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::uint64_t given_ = 0;
  std::deque<std::int16_t> ready_;
  int phase_ = 0, count_ = 0;
  double sum_ = 0;
};

class Microphone final : public SoundSource {
public:
  explicit Microphone(const std::string& name) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Failure(Exit::outside, "no pipe to arecord");
    child_ = fork();
    if (child_ == 0) become_arecord(name, ends[1]);
    close(ends[1]);
    line_ = ends[0];
    if (child_ < 0) throw Failure(Exit::outside, "arecord could not be started");
  }
  ~Microphone() override {
    close(line_);
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  Microphone(const Microphone&) = delete;
  Microphone& operator=(const Microphone&) = delete;

  std::size_t read(std::span<std::int16_t> samples) override {
    const auto bytes = std::as_writable_bytes(samples);
    std::size_t count = 0;
    while (count < bytes.size()) {
      const ssize_t read = ::read(line_, bytes.data() + count, bytes.size() - count);
      if (read < 0 && errno == EINTR) continue;
      if (read <= 0)
        throw Failure(Exit::outside, "the microphone gives no more sound (arecord has ended)");
      count += static_cast<std::size_t>(read);
    }
    return samples.size();
  }

private:
  [[noreturn]] static void become_arecord(const std::string& name, int out) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(out, STDOUT_FILENO);
    execlp("arecord", "arecord", "-q", "-D", name.c_str(), "-t", "raw", "-f", "S16_LE", "-r",
           "16000", "-c", "1", nullptr);
    constexpr std::string_view kWhy = "arecord is not there: install the package alsa-utils\n";
    (void)!write(STDERR_FILENO, kWhy.data(), kWhy.size());
    _exit(127);
  }

  pid_t child_ = -1;
  int line_ = -1;
};

}  // namespace

std::unique_ptr<SoundSource> open_sound(const std::string& name, bool no_pace) {
  std::error_code error;
  if (std::filesystem::is_regular_file(name, error))
    return std::make_unique<SoundFile>(name, no_pace);
  return std::make_unique<Microphone>(name);
}

}  // namespace robosync::companion
