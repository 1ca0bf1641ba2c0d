// W0201: the bands of a CHECK against what its sensor can give.
#include <algorithm>

#include "compiler/sema/lints.hpp"

namespace robosync::compiler {
namespace {

struct Interval {
  std::int64_t low = 0, high = 0;  // both included
};

// What is left of `ranges` without `taken`.
std::vector<Interval> without(const std::vector<Interval>& ranges, const Interval& taken) {
  std::vector<Interval> left;
  for (const Interval& range : ranges) {
    if (range.low < taken.low) left.push_back({range.low, std::min(range.high, taken.low - 1)});
    if (range.high > taken.high) left.push_back({std::max(range.low, taken.high + 1), range.high});
  }
  return left;
}

bool overlaps(const std::vector<Interval>& ranges, const Interval& wanted) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const Interval& range) {
    return range.low <= wanted.high && wanted.low <= range.high;
  });
}

}  // namespace

void lint_bands(const ast::Check& node, const ProgramCheck& check, const Typed& input,
                Diagnostics& diagnostics) {
  const Unit& unit = input.unit != nullptr ? *input.unit : canonical_unit(vm::Dimension::number);
  std::vector<Interval> left{{input.low, input.high}};
  for (std::size_t i = 0; i < check.bands.size(); ++i) {
    const Interval band{check.bands[i].low, check.bands[i].high};
    if (!overlaps(left, band))
      diagnostics
          .report(Code::W0201,
                  "`" + node.name.text + "` is never `" + node.bands[i].label.text + "`")
          .label(node.bands[i].span, "the bands above it, or the sensor's range, leave it nothing");
    left = without(left, band);
  }
  if (left.empty()) return;
  diagnostics
      .report(Code::W0201, "from " + format_value(left.front().low, unit) + " to " +
                               format_value(left.front().high, unit) + ", `" + node.name.text +
                               "` is unknown")
      .label(node.name.span)
      .helps("give a band OTHERWISE, or let two bands meet");
}

}  // namespace robosync::compiler
