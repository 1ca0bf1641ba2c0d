// Host memory for what a board keeps in its arena.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "runtime-m4/boards/memory.hpp"
#include "runtime-m4/kernel/thread.hpp"

namespace robosync::sim {

class Arena {
public:
  explicit Arena(const policy::BoardMemory& board = boards::kMemory)
      : board_(board), storage_(std::make_unique_for_overwrite<Unit[]>(units())) {}

  const policy::BoardMemory& board() const { return board_; }
  std::span<std::byte> bytes() {
    return std::as_writable_bytes(std::span(storage_.get(), units()));
  }

private:
  struct alignas(64) Unit {
    std::byte bytes[64];
  };
  std::size_t units() const { return board_.arena_bytes * port::kArenaScale / sizeof(Unit); }

  policy::BoardMemory board_;
  std::unique_ptr<Unit[]> storage_;
};

}  // namespace robosync::sim
