// Grows code objects that are well-formed but for an accident now and then: blocks nest, jumps lead
// to their ends, commands get parameters they take.
#pragma once

#include <vector>

#include "tests/generators/images/drawer.hpp"

namespace robosync::fuzz {

class Writer {
public:
  Writer(const Draft& draft, const Object& object, Random& random)
      : draft_(draft), object_(object), random_(random), drawer_(draft, object, random) {}

  // Another object in its place. Valid until the next call.
  std::span<const Word> grow();

private:
  void put(Word word);
  void statements(unsigned depth);
  void statement(unsigned depth);
  void command();
  void choice(unsigned depth);
  void loop(unsigned depth);
  void counted(unsigned depth);
  void poll();
  void pause();
  void close(Word word, std::size_t start);
  template <vm::Flow flow>
  [[nodiscard]] Word with_flow();
  [[nodiscard]] Word a_truth();
  [[nodiscard]] unsigned since(std::size_t start) const {
    return static_cast<unsigned>(code_.size() - start);
  }

  const Draft& draft_;
  const Object& object_;
  Random& random_;
  Drawer drawer_;
  std::vector<Word> code_;
};

}  // namespace robosync::fuzz
