// What one channel of the robot is to be fed: each word that was said, the last of numbers, and what stays the same often
// enough that it does not grow stale while somebody says so.
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "vm/image.hpp"

namespace robosync::tool {

class Outlet {
public:
  using Clock = std::chrono::steady_clock;

  // `stale`: after so long the robot forgets what it was fed; 0: never.
  Outlet(bool has_words, std::chrono::milliseconds stale) : has_words_(has_words), stale_(stale) {}

  void said(vm::Value value);
  // What is to be fed now, if anything. It counts as fed.
  [[nodiscard]] std::optional<vm::Value> next(Clock::time_point now);
  // The robot was away, and knows nothing; what was said meanwhile is no news.
  void forget();

private:
  bool has_words_;
  std::chrono::milliseconds stale_;
  std::deque<vm::Value> waiting_;
  std::optional<vm::Value> fed_;
  Clock::time_point fed_at_;
};

}  // namespace robosync::tool
