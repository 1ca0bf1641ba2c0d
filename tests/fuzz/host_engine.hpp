// Runs code twice: word by word with every instruction checked (the naive stepper), then by the shipped
// interpreter in one go, in memory of exactly the declared size; and compares what they leave.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "tests/fuzz/arena.hpp"
#include "tests/oracles/bytecode/stepper.hpp"

namespace robosync::fuzz {

class HostEngine final : public Engine {
public:
  // `failed` is told what is wrong, and does not return.
  explicit HostEngine(std::function<void(const char*)> failed) : failed_(std::move(failed)) {}

  void begin(const vm::Image& image) override;
  vm::Value* frame(std::size_t cells) override;
  std::uint32_t* timer_memory(std::size_t words) override;
  vm::Word* output(std::size_t words) override;
  vm::Value evaluate(vm::Machine& machine, const CodeObject& object, std::uint32_t& cost) override;
  Run respond(vm::Machine& machine, const CodeObject& object, std::size_t from) override;
  [[noreturn]] void fail(const char* what) override;

private:
  const vm::Word* enter(vm::Machine& machine, const CodeObject& object);
  void compare(const vm::Machine& machine);

  // As far as an index in an operand, or in a record, can reach.
  static constexpr std::size_t kByteReach = std::size_t{256} * 8;
  static constexpr std::size_t kHalfReach = std::size_t{65536} * 8;
  static constexpr std::size_t kRoom = std::size_t{1} << 16;

  std::function<void(const char*)> failed_;
  const vm::Image* image_ = nullptr;
  const vm::Value* constants_ = nullptr;
  const vm::Timer* timers_ = nullptr;
  std::size_t cells_ = 0, timer_words_ = 0, output_words_ = 0;
  Slot constant_slot_{kRoom, kHalfReach}, code_slot_{kRoom, kHalfReach};
  Slot timer_slot_{kRoom, kByteReach}, memory_slot_{kRoom, kHalfReach};
  Slot frame_slot_{1024, kByteReach}, output_slot_{1024, kByteReach};
  // The stepper's machine, and its memory.
  vm::Machine stepped_;
  std::array<vm::Value, 256> stepped_frame_{};
  std::vector<std::uint32_t> stepped_memory_ = std::vector<std::uint32_t>(kRoom / 4);
  std::array<vm::Word, 256> stepped_output_{};
};

}  // namespace robosync::fuzz
