// The median of a window, compared with one that sorts all samples each time.
#include "runtime-m4/layers/median.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using robosync::layers::MedianWindow;
namespace vm = robosync::vm;

namespace {

vm::Value naive_median(std::vector<vm::Value> samples) {
  std::ranges::sort(samples);
  return samples[(samples.size() - 1) / 2];
}

// Few different values, so that many are equal; and the ends of the range.
vm::Value drawn_value() {
  return *rc::gen::weightedOneOf<vm::Value>(
      {{6, rc::gen::inRange<vm::Value>(-3, 4)},
       {2, rc::gen::inRange<vm::Value>(vm::kValueMin, vm::kValueMax)},
       {1, rc::gen::element(vm::kValueMin, vm::kValueMax)}});
}

}  // namespace

TEST_CASE("the median is that of the samples in the window, whatever comes and however many fit") {
  const bool holds = rc::check([] {
    const unsigned size = *rc::gen::inRange(2U, vm::kMaxWindow + 1);
    std::array<vm::Value, vm::kMaxWindow> ring{};
    std::array<std::uint8_t, vm::kMaxWindow> order{};
    MedianWindow window;
    const MedianWindow::Room room{ring.data(), order.data()};
    std::vector<vm::Value> model;
    const int steps = *rc::gen::inRange(1, 200);
    for (int i = 0; i < steps; ++i) {
      const vm::Value value = drawn_value();
      if (!model.empty() && *rc::gen::inRange(0, 4) == 0) {
        model.back() = value;
        RC_ASSERT(window.replace_newest(room, value) == naive_median(model));
      } else {
        if (model.size() == size) model.erase(model.begin());
        model.push_back(value);
        RC_ASSERT(window.push(room, size, value) == naive_median(model));
      }
    }
  });
  CHECK(holds);
}

TEST_CASE("a window that rises, falls or stands still is moved as a whole") {
  for (unsigned size = 2; size <= vm::kMaxWindow; ++size) {
    std::array<vm::Value, vm::kMaxWindow> ring{};
    std::array<std::uint8_t, vm::kMaxWindow> order{};
    MedianWindow window;
    const MedianWindow::Room room{ring.data(), order.data()};
    std::vector<vm::Value> model;
    for (int i = 0; i < 200; ++i) {
      const vm::Value value = i < 70 ? i : i < 100 ? 69 : 169 - i;
      if (model.size() == size) model.erase(model.begin());
      model.push_back(value);
      REQUIRE(window.push(room, size, value) == naive_median(model));
    }
  }
}
