// Decides what one channel of the robot is fed: every word, the latest number, and an unchanged value often enough that
// it does not become stale while the program still reports it.
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "vm/image.hpp"

namespace robosync::tool {

class Outlet {
public:
  using Clock = std::chrono::steady_clock;

  // `stale`: how long the robot keeps a value that it was fed; 0: forever.
  Outlet(bool has_words, std::chrono::milliseconds stale) : has_words_(has_words), stale_(stale) {}

  void said(vm::Value value);
  // The value to feed now, if any. It then counts as fed.
  [[nodiscard]] std::optional<vm::Value> next(Clock::time_point now);
  // The robot was away and has lost its values; what came meanwhile is dropped.
  void forget();

private:
  bool has_words_;
  std::chrono::milliseconds stale_;
  std::deque<vm::Value> waiting_;
  std::optional<vm::Value> fed_;
  Clock::time_point fed_at_;
};

}  // namespace robosync::tool
