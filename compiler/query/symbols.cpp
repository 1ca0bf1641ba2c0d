#include "compiler/query/symbols.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "compiler/query/collector.hpp"
#include "compiler/source/sorting.hpp"

namespace robosync::compiler::query {
namespace {

auto place_of(const Occurrence& occurrence) {
  return std::make_tuple(occurrence.span.file, occurrence.span.begin, occurrence.span.end);
}

}  // namespace

Symbols::Symbols(const Project& project) {
  Collector collector(project);
  collector.collect();
  symbols_ = std::move(collector.symbols);
  occurrences_ = std::move(collector.occurrences);
  // The first occurrence of a SIGNAL declares it.
  for (Occurrence& one : occurrences_) {
    const Symbol& symbol = symbols_[one.symbol];
    one.declares = one.declares || (symbol.is_there && symbol.declared->file == one.span.file &&
                                    symbol.declared->begin == one.span.begin);
  }
  sort_stably(occurrences_, {}, place_of);
  // A sensor without its own channels has the same place as its channels: the first occurrence is the sensor.
  const auto same = [](const Occurrence& a, const Occurrence& b) {
    return place_of(a) == place_of(b);
  };
  occurrences_.erase(std::unique(occurrences_.begin(), occurrences_.end(), same),
                     occurrences_.end());
}

const Occurrence* Symbols::at(FileId file, std::uint32_t offset) const {
  const auto behind = [&](const Occurrence& occurrence) {
    return std::make_pair(occurrence.span.file, occurrence.span.begin) <=
           std::make_pair(file, offset);
  };
  auto found = std::partition_point(occurrences_.begin(), occurrences_.end(), behind);
  // Names do not overlap, so only the last one that begins at or before the offset can contain it.
  if (found == occurrences_.begin()) return nullptr;
  --found;
  const bool inside = found->span.file == file && offset <= found->span.end;
  return inside ? &*found : nullptr;
}

std::vector<Occurrence> Symbols::of(std::size_t symbol) const {
  std::vector<Occurrence> result;
  std::ranges::copy_if(occurrences_, std::back_inserter(result),
                       [symbol](const Occurrence& one) { return one.symbol == symbol; });
  return result;
}

}  // namespace robosync::compiler::query
