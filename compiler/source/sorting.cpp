#include "compiler/source/sorting.hpp"

#include <algorithm>
#include <numeric>

namespace robosync::compiler {

std::vector<std::size_t> sorted_places(std::size_t count,
                                       const std::function<bool(std::size_t, std::size_t)>& less) {
  std::vector<std::size_t> places(count);
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::stable_sort(places.begin(), places.end(),
                   [&less](std::size_t a, std::size_t b) { return less(a, b); });
  return places;
}

}  // namespace robosync::compiler
