// See timeline.hpp.
#include "tests/properties/timeline.hpp"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "tests/runtime-m4/robot.hpp"

namespace robosync::test {
namespace {

constexpr int kMaxReadings = 40;
constexpr int kAfterLast = 700;  // longer than every duration that is drawn
constexpr int kHighest = 10;

}  // namespace

Timeline Timeline::random() {
  Timeline timeline;
  const int readings = *rc::gen::inRange(1, kMaxReadings);
  std::optional<int> value;
  for (int i = 0; i <= readings; ++i) {
    const bool near = *rc::gen::arbitrary<bool>();
    const int gap = i == readings ? kAfterLast : *rc::gen::inRange(1, near ? 20 : 250);
    timeline.values_.insert(timeline.values_.end(), static_cast<std::size_t>(gap), value);
    value = *rc::gen::inRange(0, kHighest + 1);
  }
  return timeline;
}

std::vector<bool> Timeline::truth(const std::function<bool(int)>& condition) const {
  std::vector<bool> truth;
  truth.reserve(values_.size());
  for (const std::optional<int>& value : values_)
    truth.push_back(value && condition(*value));
  return truth;
}

Times Timeline::run(const std::string& rsl, std::string_view event) const {
  RC_LOG() << rsl;
  Robot robot(rsl);
  for (int at = 1; at < end(); ++at)
    if (value(at) != value(at - 1)) {
      RC_LOG() << at << " X = " << *value(at) << "\n";
      robot.feed(static_cast<std::uint64_t>(at), "X", *value(at));
    }
  robot.run(static_cast<std::uint64_t>(end() - 1));
  Times times;
  for (const std::string& line : robot.lines()) {
    const std::size_t words = line.find(' ', line.find('#')) + 1;
    if (line.compare(words, event.size(), event) == 0) times.push_back(std::stoi(line));
  }
  return times;
}

Times rising(const std::vector<bool>& truth) {
  Times times;
  for (std::size_t at = 0; at < truth.size(); ++at)
    if (truth[at] && (at == 0 || !truth[at - 1])) times.push_back(static_cast<int>(at));
  return times;
}

}  // namespace robosync::test
