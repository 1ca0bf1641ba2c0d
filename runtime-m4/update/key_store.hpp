// The owner's key in the board's store, and the data that boot ids are made from. It survives a loss of power at any byte of a
// write.
//
// There are two records, each on its own page. The valid one with the higher number counts; a write goes to the other. Each
// write increments the number, and a board with an owner writes at each start, so the number also identifies the start.
#pragma once

#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/update/store_layout.hpp"
#include "runtime-m4/update/store_transfer.hpp"

namespace robosync::update {

class KeyStore {
public:
  struct Record {
    static constexpr std::uint32_t kMagic = 0x314F'5352;  // "RSO1"
    std::uint32_t magic;
    std::uint32_t number;
    link::Pair owner;
    std::uint32_t paired;  // 1; 0: there is no owner
    std::uint32_t crc32;   // of the fields before it
  };
  static_assert(sizeof(Record) == StoreLayout::kKeyBytes &&
                sizeof(Record) % boards::Store::kPiece == 0);

  explicit KeyStore(boards::Store* store) : store_(store), transfer_(store) {}

  // One request at a time.
  void open();  // before the others: reads the records
  void write(bool paired, const link::Pair& owner);

  Work work();  // does the next piece of the request

  bool there() const { return there_; }      // the store answered when it was opened
  bool written() const { return written_; }  // since open(), and the last write succeeded
  const Record& record() const { return record_; }

private:
  enum class Task : std::uint8_t { none, head, body, write };

  StoreLayout layout() const { return StoreLayout(*store_); }
  void read(Task what);
  void look_at_head();
  void look_at_body();
  void go_on();

  boards::Store* store_;
  StoreTransfer transfer_;
  Task task_ = Task::none;
  bool there_ = false;
  bool written_ = false;
  std::uint32_t place_ = 0;  // of the record being read
  Record record_{};          // the one that counts; number 0: none
  Record next_{};            // being read or written
};

}  // namespace robosync::update
