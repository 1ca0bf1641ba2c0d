// The KEPT numbers that the board knows: those of the running program first, then those of earlier programs.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "runtime-m4/layers/kept.hpp"
#include "runtime-m4/runtime.hpp"

namespace robosync::update {

class KeptNumbers {
public:
  std::span<const layers::KeptNumber> all() const { return std::span(numbers_).first(count_); }

  void begin_with(std::span<const layers::KeptNumber> numbers) {
    count_ = std::min(numbers.size(), numbers_.size());
    std::copy_n(numbers.begin(), count_, numbers_.begin());
  }

  // Takes the running program's current numbers. Those of other programs stay as far as there is room.
  void learn(const Runtime& runtime) {
    std::array<layers::KeptNumber, vm::kMaxKept> learnt{};
    std::size_t count = runtime.fill_kept(learnt);
    for (const layers::KeptNumber& known : all()) {
      const auto ours = std::span(learnt).first(count);
      if (count < learnt.size() &&
          std::ranges::find(ours, known.key, &layers::KeptNumber::key) == ours.end())
        learnt[count++] = known;
    }
    numbers_ = learnt;
    count_ = count;
  }

private:
  std::array<layers::KeptNumber, vm::kMaxKept> numbers_{};
  std::size_t count_ = 0;
};

}  // namespace robosync::update
