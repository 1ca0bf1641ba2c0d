// Readings that wait for their time, the earliest first. A channel has one reading per tick: of two,
// the one inserted later counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/layers/memory.hpp"
#include "vm/value.hpp"

namespace robosync::layers {

class FeedQueue {
public:
  class Entry {
  public:
    Entry() = default;
    // `due` is kernel time; it is rounded up to a tick.
    Entry(kernel::Time due, std::uint8_t channel, vm::Value value);
    kernel::Time due() const { return (kernel::Time{due_high_} << 32 | due_low_) * kernel::kTick; }
    std::uint8_t channel() const { return channel_; }
    vm::Value value() const { return value_; }

  private:
    vm::Value value_ = 0;
    std::uint32_t due_low_ = 0;  // ticks; 48 bits of them, to keep the queue small
    std::uint16_t due_high_ = 0;
    std::uint8_t channel_ = 0;
  };

  void start(Memory& memory);  // nothing waits
  // False if it is full.
  [[nodiscard]] bool insert(const Entry& entry);
  // Program time was expected to begin at `from` and begins at `to`: moves the entries along. Those due
  // before `from` stay as they are.
  void shift(kernel::Time from, kernel::Time to);
  // Takes the earliest entry out if it is due.
  [[nodiscard]] bool take_due(kernel::Time now, Entry& entry);
  kernel::Time next_due() const { return count_ == 0 ? kernel::kForever : entries_[0].due(); }
  bool empty() const { return count_ == 0; }
  std::size_t places() const { return entries_.size(); }
  std::size_t free_places() const { return entries_.size() - count_; }

private:
  std::span<Entry> entries_;
  std::size_t count_ = 0;
};

}  // namespace robosync::layers
