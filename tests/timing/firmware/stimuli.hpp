// Steps of a program that nobody foresaw: inputs from the edges of their ranges, near the program's
// own numbers and far outside, times that pass a duration by a hair, responses that run or not.
// Drawn from a seed, so that every run is the same.
#pragma once

#include <array>
#include <cstdint>

#include "tests/timing/firmware/robot.hpp"

namespace robosync::timing {

class Stimuli {
public:
  explicit Stimuli(std::uint32_t seed) : state_(seed * 0x9E3779B9U | 1U) {}

  // One step, some time after the one before.
  void step(Robot& robot, const vm::Image& image);

private:
  std::uint32_t draw(std::uint32_t below);  // 0 … below - 1
  [[nodiscard]] vm::Value value(const vm::Image& image, std::size_t input);
  std::uint32_t passing(const vm::Image& image);
  void respond(Robot& robot, std::size_t rule, bool eager);

  std::uint32_t state_;
  std::uint32_t now_ = 0;
};

}  // namespace robosync::timing
