// The programs in the board's store, which survive a reset: the kept one, which the robot starts with, and the one
// that was kept before it.
//
// Each has its own slot. A record says which slot is which. There are two records, each on its own page, and the
// valid one with the higher number counts. An image is written into the slot of the previous program, and then the
// older record is overwritten, so a power cut at any byte leaves either the old kept program or the new one.
// An image is checked when it is read: its own CRC, its name and the verifier.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/update/store_layout.hpp"
#include "runtime-m4/update/store_transfer.hpp"

namespace robosync::update {

class ProgramStore {
public:
  struct Program {
    std::uint32_t bytes;  // 0: none
    link::ProgramHash hash;
    bool operator==(const Program&) const = default;
  };

  // nullptr: treated as a store that does not answer.
  explicit ProgramStore(boards::Store* store) : store_(store), transfer_(store) {}

  // One request at a time; a new one gives up the one before.
  bool open();  // before the others: reads the records; false without a store
  void read_kept(std::span<std::byte> room);  // into the beginning of `room`
  void read_previous(std::span<std::byte> room);
  // Overwrites the previous program. Its entry in the record is removed first, so that a program on trial never counts as it.
  void write(std::span<const std::byte> image, Program what);
  void keep_written();  // the written program becomes the kept one
  void swap();          // exchanges the previous and the kept one
  void give_up() { transfer_.give_up(); }

  Work work();  // does the next piece of the request

  bool there() const { return there_; }  // the store answers
  Program kept() const { return record_.kept; }
  Program previous() const { return record_.previous; }
  Program written() const { return written_; }  // completely, by write(), and not kept yet
  std::uint32_t most_bytes() const;             // of an image
  // The bytes that were read. If they are fewer than the program has, the room was too small.
  std::span<const std::byte> image() const { return room_; }

private:
  enum class Task : std::uint8_t { none, open, read, forget, write, record };

  struct Record {
    static constexpr std::uint32_t kMagic = 0x3250'5352;  // "RSP2"
    std::uint32_t magic;
    std::uint32_t number;
    Program kept, previous;
    std::uint32_t slot;  // of the kept one: 0 or 1
    std::array<std::uint32_t, 2> reserved;
    std::uint32_t crc32;  // of the fields before it
  };
  static_assert(sizeof(Record) % boards::Store::kPiece == 0);

  StoreLayout layout() const { return StoreLayout(*store_); }
  void read_record();
  void read_slot(Program program, std::uint32_t slot, std::span<std::byte> room);
  void write_image();
  void write_record(Task why, Program kept, Program previous, std::uint32_t slot);
  void look_at_record();

  boards::Store* store_;
  StoreTransfer transfer_;
  bool there_ = false;
  Record record_{};  // the one that counts; number 0: none
  Program written_{};

  Program writes_{};  // being written, from from_
  std::span<const std::byte> from_;

  Task task_ = Task::none;
  std::span<std::byte> room_;
  std::uint32_t opened_ = 0;  // records that have been read
  Record next_{};             // being read or written
};

}  // namespace robosync::update
