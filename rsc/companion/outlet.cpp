// See outlet.hpp.
#include "rsc/companion/outlet.hpp"

namespace robosync::tool {
namespace {

constexpr std::size_t kMostWaiting = 16;  // words; beyond this the oldest are dropped
constexpr int kTimesUntilStale = 3;       // a reading may be late, and one lost

}  // namespace

void Outlet::said(vm::Value value) {
  if (!waiting_.empty() && (!has_words_ || waiting_.back() == value)) waiting_.pop_back();
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back(value);
}

std::optional<vm::Value> Outlet::next(Clock::time_point now) {
  if (waiting_.empty()) return std::nullopt;
  const vm::Value value = waiting_.front();
  waiting_.pop_front();
  const bool is_news = !fed_ || *fed_ != value;
  const bool is_due = stale_.count() != 0 && now - fed_at_ >= stale_ / kTimesUntilStale;
  if (!is_news && !is_due) return std::nullopt;
  fed_ = value;
  fed_at_ = now;
  return value;
}

void Outlet::forget() {
  waiting_.clear();
  fed_.reset();
}

}  // namespace robosync::tool
