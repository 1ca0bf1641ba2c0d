// Runs a response of an image as a robot would: step after step, with all that must not last
// between two steps overwritten.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tests/compiler/build.hpp"
#include "vm/interpreter.hpp"

namespace robosync::compiler::testing {

// What a program reads and sets, by the numbers of build.hpp and ir::Program::variables.
struct World {
  std::array<vm::Value, 4> channels{};
  std::vector<vm::Value> variables;
  std::uint32_t now = 0;  // milliseconds
};

// One command, text or halt: "left to 5000 over 10", "log at {} to 3".
using Effects = std::vector<std::string>;

class Runner {
public:
  Runner(const vm::Image& image, std::size_t behavior);

  [[nodiscard]] vm::Value condition(std::size_t rule, const World& world);
  // Runs rule's response until it ends, or until it has paused `pauses` times. At each pause
  // `world` is handed to `pass_time`, with `now` already brought on. Variables that were set are
  // set in `world` then.
  Effects respond(std::size_t rule, World& world, unsigned pauses,
                  const std::function<void(World&)>& pass_time = {});

  vm::Machine machine;
  bool ended = false;  // the last response did

private:
  [[nodiscard]] std::uint32_t input_of(unsigned cell) const;
  void latch(const World& world);
  void commit(World& world);
  void evaluate_watches();
  void take_output(Effects& effects);

  const vm::Image& image_;
  const vm::Behavior& behavior_;
  std::array<vm::Value, vm::kMaxCells> frame_{};
  std::array<vm::Word, vm::kMaxResponseOutput> output_{};
  std::vector<std::uint32_t> timer_memory_;
};

}  // namespace robosync::compiler::testing
