// The programs that outlast a reset, in the board's store: the kept one, with which the robot starts, and the one
// that was kept before it.
//
// Each stands in a slot of its own. Which is which says a record, of which there are two, on pages of their own: the
// whole one with the higher number counts. An image is written into the slot of the program before, and after it
// the older record; so a cut of the power at any byte leaves either the kept program of before or the new one.
// That an image is whole is seen when it is read: its own CRC and name, and the verifier.
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

  // nullptr: as one that does not answer.
  explicit ProgramStore(boards::Store* store) : store_(store), transfer_(store) {}

  // What may be asked for, one at a time; asking for another gives up the one before.
  bool open();  // first of all: reads the records; false without a store
  void read_kept(std::span<std::byte> room);  // into the beginning of `room`
  void read_previous(std::span<std::byte> room);
  // In place of the previous one, which the record names no more before that: what has not stood its trial is never called it.
  void write(std::span<const std::byte> image, Program what);
  void keep_written();  // from now on that is the kept one
  void swap();          // the previous is the kept one, and the other way round
  void give_up() { transfer_.give_up(); }

  Work work();  // the next piece of it

  bool there() const { return there_; }  // a store that answers
  Program kept() const { return record_.kept; }
  Program previous() const { return record_.previous; }
  Program written() const { return written_; }  // by write(), whole, and not kept yet
  std::uint32_t most_bytes() const;             // of an image
  // What was read. Fewer bytes than the program has: there was no room for it.
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
    std::uint32_t crc32;  // of what stands before it
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

  Program writes_{};  // … by it, from here:
  std::span<const std::byte> from_;

  Task task_ = Task::none;
  std::span<std::byte> room_;
  std::uint32_t opened_ = 0;  // records that have been read
  Record next_{};             // being read or written
};

}  // namespace robosync::update
