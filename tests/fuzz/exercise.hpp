// Runs everything that an accepted image may run, with inputs drawn from the edges, and looks at
// what comes of it: conditions are true, false or unknown; responses put out what exists and was
// declared, and write the variables they may write.
//
// The same on the host and on the board: what differs is the Engine. It draws the same there, and
// the hash over frames, outputs and results is the same.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/generators/images/random.hpp"
#include "vm/interpreter.hpp"
#include "vm/verifier.hpp"

namespace robosync::fuzz {

// Words of a code object, and the behaviour that runs it.
struct CodeObject {
  const vm::Behavior* behavior;
  std::size_t start, length;
  bool is_condition;
  bool is_safety;
};

// A response's run up to where it pauses; its cost where the engine counts, else 0.
struct Run {
  vm::Pause pause = vm::Pause::ended;
  std::size_t next = 0;  // word of the object
  std::uint32_t wake = 0;
  std::uint32_t cost = 0;
};

// Memory of exactly the wanted size, and an interpreter that steps outside of it only once.
class Engine {
public:
  // The image whose code runs from now on.
  virtual void begin(const vm::Image& image) = 0;
  // Valid until the next call.
  virtual vm::Value* frame(std::size_t cells) = 0;
  virtual std::uint32_t* timer_memory(std::size_t words) = 0;
  virtual vm::Word* output(std::size_t words) = 0;
  virtual vm::Value evaluate(vm::Machine& machine, const CodeObject& object,
                             std::uint32_t& cost) = 0;
  virtual Run respond(vm::Machine& machine, const CodeObject& object, std::size_t from) = 0;
  // Something did what the verifier had promised that it does not. Does not return.
  virtual void fail(const char* what) = 0;

protected:
  ~Engine() = default;
};

struct Facts {
  std::uint32_t hash = 2166136261U;
  std::uint32_t runs = 0;    // of conditions and responses
  std::uint32_t pauses = 0;  // from which a response went on
  std::uint32_t worst = 0;   // of every rule the costliest condition and run of a response seen
};

// `image` is accepted. The same seed, the same inputs.
[[nodiscard]] Facts exercise(const vm::Image& image, std::uint64_t seed, Engine& engine);

}  // namespace robosync::fuzz
