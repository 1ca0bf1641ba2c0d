// The KEPT numbers in the board's store: a ring of self-contained records, of which the newest valid one counts.
// Writes go round the ring, so that no page wears out, and a power cut leaves the record before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/layers/kept.hpp"
#include "runtime-m4/update/store_layout.hpp"
#include "runtime-m4/update/store_transfer.hpp"

namespace robosync::update {

class NumberStore {
public:
  struct Record {
    static constexpr std::uint32_t kMagic = 0x314B'5352;  // "RSK1"
    std::uint32_t magic;
    std::uint32_t number;  // counts up
    std::uint32_t count;   // of the entries
    std::array<layers::KeptNumber, vm::kMaxKept> entries;
    std::uint32_t crc32;  // of the fields before it
  };
  static_assert(sizeof(Record) == StoreLayout::kNumbersBytes &&
                sizeof(Record) % boards::Store::kPiece == 0);

  explicit NumberStore(boards::Store* store) : store_(store), transfer_(store) {}

  // One request at a time.
  void open();  // before the others: reads the newest record
  void write(std::span<const layers::KeptNumber> numbers);

  Work work();  // does the next piece of the request

  // The numbers in the store.
  std::span<const layers::KeptNumber> numbers() const {
    return std::span(record_.entries).first(record_.count);
  }

private:
  enum class Task : std::uint8_t { none, heads, body, write };
  struct Head {
    std::uint32_t magic, number, reserved[2];
  };
  static_assert(sizeof(Head) == boards::Store::kPiece);

  StoreLayout layout() const { return StoreLayout(*store_); }
  void read_head();
  void look_at_head();
  void look_at_body();
  bool whole() const;

  boards::Store* store_;
  StoreTransfer transfer_;
  Task task_ = Task::none;
  Record record_{};            // the one that counts; number 0: none
  std::uint32_t skipped_ = 0;  // record numbers after it whose places could not be written
  Record next_{};              // being read or written
  Head head_{};                // being read
  std::uint32_t place_ = 0;    // of head_
  Head best_{};                // the newest head found so far
  std::uint32_t best_place_ = 0;
  std::uint32_t below_ = 0;  // records from this number on are damaged
};

}  // namespace robosync::update
