// Sorts lists; equal elements stay in order. std::ranges::stable_sort takes 4 KB of code for each type of element. Here only places in
// a list are sorted, by the same code for every type.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace robosync::compiler {

// The places 0 to `count` - 1 in the order of their elements; `less` compares the elements at two places.
[[nodiscard]] std::vector<std::size_t> sorted_places(
    std::size_t count, const std::function<bool(std::size_t, std::size_t)>& less);

// Parameters as of std::ranges::stable_sort.
template <typename T, typename Less = std::ranges::less, typename Projection = std::identity>
void sort_stably(std::vector<T>& list, Less less = {}, Projection projection = {}) {
  const auto places = sorted_places(list.size(), [&](std::size_t a, std::size_t b) {
    return std::invoke(less, std::invoke(projection, list[a]), std::invoke(projection, list[b]));
  });
  std::vector<T> sorted;
  sorted.reserve(list.size());
  for (const std::size_t place : places)
    sorted.push_back(std::move(list[place]));
  list = std::move(sorted);
}

}  // namespace robosync::compiler
