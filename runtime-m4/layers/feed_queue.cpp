// See feed_queue.hpp. A sorted array: it is short, and entries come over the link far more slowly than
// they are sorted in.
#include "runtime-m4/layers/feed_queue.hpp"

#include <algorithm>

namespace robosync::layers {

FeedQueue::Entry::Entry(kernel::Time due, std::uint8_t channel, vm::Value value)
    : value_(value), channel_(channel) {
  constexpr std::uint64_t kMost = (std::uint64_t{1} << 48) - 1;
  const bool between = due % kernel::kTick != 0;
  const std::uint64_t ticks = std::min(due / kernel::kTick + (between ? 1 : 0), kMost);
  due_low_ = static_cast<std::uint32_t>(ticks);
  due_high_ = static_cast<std::uint16_t>(ticks >> 32);
}

void FeedQueue::start(Memory& memory) {
  entries_ = memory.take_zero<policy::Part::feeds, Entry>();
  count_ = 0;
}

bool FeedQueue::insert(const Entry& entry) {
  const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto same = std::find_if(entries_.begin(), end, [&](const Entry& other) {
    return other.due() == entry.due() && other.channel() == entry.channel();
  });
  if (same != end) {
    *same = entry;
    return true;
  }
  if (count_ == entries_.size()) return false;
  const auto place = std::find_if(entries_.begin(), end,
                                  [&](const Entry& other) { return other.due() > entry.due(); });
  std::move_backward(place, end, end + 1);
  *place = entry;
  ++count_;
  return true;
}

void FeedQueue::shift(kernel::Time from, kernel::Time to) {
  for (Entry& entry : entries_.first(count_))
    if (entry.due() >= from) entry = Entry(entry.due() - from + to, entry.channel(), entry.value());
}

bool FeedQueue::take_due(kernel::Time now, Entry& entry) {
  if (next_due() > now) return false;
  entry = entries_[0];
  --count_;
  std::move(entries_.begin() + 1, entries_.begin() + 1 + static_cast<std::ptrdiff_t>(count_),
            entries_.begin());
  return true;
}

}  // namespace robosync::layers
