// What an upload carries over: the new program's REMEMBERs, STATEs and FEELINGs begin with the values of the old one's, where name
// and type match.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime-m4/layers/kept.hpp"
#include "runtime-m4/policy/memory.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

class Carried {
public:
  // Takes the values of the program that is about to end, one for each variable of its image. A name that several BEHAVIORs use
  // for a variable of their own is not carried over: nothing says which is which.
  void take(const vm::Image& image, std::span<const vm::Value> values);
  // Replaces the written initial values in `values`, one for each variable of the new program's image. Each is clamped to the range
  // of its new variable. A STATE keeps its value if it still has that label.
  void apply(const vm::Image& image, std::span<vm::Value> values) const;

private:
  struct Entry {
    std::uint32_t key;
    vm::Value value;  // of a STATE: the key of its label, whose index may differ in the new program
  };
  std::optional<vm::Value> find(std::uint32_t key) const;

  std::array<Entry, policy::kMaxVariables> entries_{};
  std::size_t count_ = 0;
};

// What a program's variables begin with instead of the written values: numbers that were kept, then values of the program before.
struct Beginnings {
  std::span<const KeptNumber> kept;
  const Carried& carried;
};

}  // namespace robosync::layers
