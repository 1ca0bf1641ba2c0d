// See worker.hpp.
#include "rsc/companion/worker.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <sys/wait.h>

#include "companion/exit.hpp"

namespace robosync::tool {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kShortestPause{500}, kLongestPause{30'000};
constexpr milliseconds kLivesWell{30'000};  // a run this long resets the pause
constexpr milliseconds kFirstWord{20'000};  // time to load its model
constexpr milliseconds kLeastPatience{3'000};
constexpr int kPeriods = 5;     // this many without a line, and it counts as hung
constexpr int kMostReads = 32;  // reads of what the pipe still holds after the end

// Did it exit with this code?
bool has_ended(int status, companion::Exit how) {
  return WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(how);
}

}  // namespace

Worker::Worker(Plan plan, Report report)
    : plan_(std::move(plan)), report_(std::move(report)), pause_(kShortestPause) {}

void Worker::start(Clock::time_point now) {
  process_ = std::make_unique<WorkerProcess>(plan_.program, plan_.arguments);
  started_ = now;
  has_spoken_ = false;
  has_babbled_ = false;
}

bool Worker::listen(const Accept& accept) {
  bool means_something = false;
  for (const std::string& line : process_->lines()) {
    if (accept(line)) {
      means_something = true;
    } else if (!has_babbled_) {
      has_babbled_ = true;
      report_(fmt::format("sent something that is not a reading: {}", printable(line)));
    }
  }
  return means_something;
}

// Its lines are read before it is judged: they may have waited in the pipe while rsc was busy.
void Worker::look(Clock::time_point now, const Accept& accept) {
  if (is_over_ || is_given_up_ || (!process_ && now < next_start_)) return;
  if (!process_) start(now);
  const std::optional<int> end = process_->ended();
  if (listen(accept)) {
    has_spoken_ = true;
    alive_ = now;
  }
  if (end) {
    for (int i = 0; i < kMostReads; ++i)
      listen(accept);
    take_end(now, *end);
    return;
  }
  const milliseconds patience =
      has_spoken_ ? std::max(kLeastPatience, plan_.period * kPeriods) : kFirstWord;
  if (now - (has_spoken_ ? alive_ : started_) > patience)
    end_it(now, fmt::format("has sent nothing for {} s: it hangs",
                            static_cast<double>(patience.count()) / 1000));
}

void Worker::take_end(Clock::time_point now, int status) {
  is_over_ = has_ended(status, companion::Exit::over);
  is_given_up_ = has_ended(status, companion::Exit::asked_wrongly);
  const std::string words = process_->last_words();
  if (is_over_ || is_given_up_) {
    process_.reset();
    report_(is_over_ ? std::string("is over") : words.empty() ? "cannot work" : words);
    return;
  }
  end_it(now,
         fmt::format("has ended ({}){}{}", how_it_ended(status), words.empty() ? "" : ": ", words));
}

void Worker::end_it(Clock::time_point now, const std::string& why) {
  if (now - started_ > kLivesWell) pause_ = kShortestPause;
  process_.reset();
  next_start_ = now + pause_;
  report_(
      fmt::format("{}; restarting it in {} s", why, static_cast<double>(pause_.count()) / 1000));
  pause_ = std::min(pause_ * 2, kLongestPause);
}

}  // namespace robosync::tool
