// Does the device behind a sensor answer on its bus? Kept for each sensor that measures, round by round: in a round
// each of its channels is read once.
//
// The first round decides alone. From then on it takes kRounds contradicting rounds in a row to change the standing,
// so that a device that answers now and then is not reported in every round.
//
// The first rounds of some devices are discarded (vm::first_samples_discarded()), so they do not count.
#pragma once

#include <algorithm>
#include <cstdint>

namespace robosync::layers {

class Contact {
public:
  static constexpr unsigned kRounds = 3;

  enum class News : std::uint8_t { none, silent, answers };

  void discard(std::uint8_t rounds) {
    otherwise_ = rounds;
    standing_ = rounds != 0 ? Standing::discards : Standing::not_asked;
  }
  bool discards() const { return standing_ == Standing::discards; }

  // A round is over, with this many failed transfers.  [sensor's thread]
  News note(unsigned failed) {
    if (discards()) {
      if (--otherwise_ == 0) standing_ = Standing::not_asked;
      return News::none;
    }
    failed_ = static_cast<std::uint16_t>(std::min(failed_ + failed, unsigned{UINT16_MAX}));
    const Standing now = failed == 0 ? Standing::answers : Standing::silent;
    if (now == standing_) {
      otherwise_ = 0;
      return News::none;
    }
    const bool first = standing_ == Standing::not_asked;
    if (!first && ++otherwise_ < kRounds) return News::none;
    otherwise_ = 0;
    standing_ = now;
    if (now == Standing::silent) return News::silent;
    return first ? News::none : News::answers;
  }

  bool asked() const { return standing_ == Standing::answers || silent(); }
  bool silent() const { return standing_ == Standing::silent; }
  // Failed transfers so far; UINT16_MAX: that many or more.
  std::uint16_t failed() const { return failed_; }

private:
  enum class Standing : std::uint8_t { not_asked, discards, answers, silent };

  std::uint16_t failed_ = 0;
  std::uint8_t otherwise_ = 0;  // rounds in a row, or rounds still to be discarded
  Standing standing_ = Standing::not_asked;
};

}  // namespace robosync::layers
