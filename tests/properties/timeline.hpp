// What one sensor says over time, kept for every millisecond, so that what a condition was at any
// moment can be looked up: the brute-force reading of the language needs no memory of its own.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace robosync::test {

using Times = std::vector<int>;  // milliseconds

class Timeline {
public:
  // Random readings of 0 to 10, a few milliseconds to a quarter of a second apart.
  static Timeline random();

  int end() const { return static_cast<int>(values_.size()); }
  std::optional<int> value(int at) const { return values_[static_cast<std::size_t>(at)]; }
  // When `condition` holds: at every millisecond; never before the first reading.
  std::vector<bool> truth(const std::function<bool(int)>& condition) const;
  bool known(int at) const { return value(at).has_value(); }

  // Runs `rsl` on the plain robot with this as `near X`. The times of the trace lines whose first
  // words are `event`.
  Times run(const std::string& rsl, std::string_view event) const;

private:
  std::vector<std::optional<int>> values_;
};

// When `truth` becomes true; from the start on counts as well.
Times rising(const std::vector<bool>& truth);

}  // namespace robosync::test
