// Sorting, against the standard library.
#include "compiler/source/sorting.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

using robosync::compiler::sort_stably;
using robosync::compiler::sorted_places;

namespace {

struct Entry {
  int key;
  std::size_t number;
  bool operator==(const Entry&) const = default;
};

}  // namespace

TEST_CASE("lists are sorted as std::ranges::stable_sort sorts them", "[sorting]") {
  std::mt19937 draw(1);
  for (std::size_t count = 0; count < 300; ++count) {
    std::vector<Entry> list;
    for (std::size_t i = 0; i < count; ++i)
      list.push_back({static_cast<int>(draw() % 9), i});
    std::vector<Entry> up = list, down = list, wanted_up = list, wanted_down = list;
    sort_stably(up, {}, &Entry::key);
    std::ranges::stable_sort(wanted_up, {}, &Entry::key);
    CHECK(up == wanted_up);
    sort_stably(down, std::greater{}, &Entry::key);
    std::ranges::stable_sort(wanted_down, std::greater{}, &Entry::key);
    CHECK(down == wanted_down);
  }
}

TEST_CASE("elements are moved, not copied", "[sorting]") {
  std::vector<std::unique_ptr<std::string>> list;
  for (const char* const word : {"c", "a", "b"})
    list.push_back(std::make_unique<std::string>(word));
  sort_stably(list, {}, [](const auto& word) -> const std::string& { return *word; });
  CHECK(*list[0] + *list[1] + *list[2] == "abc");
}

TEST_CASE("the places say where each element was", "[sorting]") {
  const std::vector<int> list = {20, 10, 20, 0};
  CHECK(sorted_places(list.size(), [&](std::size_t a, std::size_t b) {
          return list[a] < list[b];
        }) == std::vector<std::size_t>{3, 1, 0, 2});
}
