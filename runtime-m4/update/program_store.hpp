// The programs that outlast a reset, in the board's store: the kept one, with which the robot starts, and the one
// that was kept before it.
//
// Each stands in a slot of its own. Which is which says a record, of which there are two, on pages of their own: the
// whole one with the higher number counts. An image is written into the slot of the program before, and after it
// the older record; so a cut of the power at any byte leaves either the kept program of before or the new one.
// That an image is whole is seen when it is read: its own CRC, and the verifier.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/store.hpp"

namespace robosync::update {

class ProgramStore {
public:
  struct Program {
    std::uint32_t bytes;  // 0: none
    std::uint32_t crc32;  // ImageHeader::crc32
    bool operator==(const Program&) const = default;
  };
  enum class Work : std::uint8_t {
    none,   // there is nothing to do
    some,   // a piece is done; there may be more
    waits,  // as `some`, but it makes no sense before a millisecond is over
    ended   // the last piece of what was asked for is done
  };

  // Without a store (nullptr), it is as one that does not answer.
  explicit ProgramStore(boards::Store* store) : store_(store) {}

  // What may be asked for, one at a time; asking for another gives up the one before.
  void open();                                // first of all: reads the records
  void read_kept(std::span<std::byte> room);  // into the beginning of `room`
  void read_previous(std::span<std::byte> room);
  void write(std::span<const std::byte> image,
             Program what);  // into the slot of the previous one, which is lost
  void keep_written();       // from now on that is the kept one
  void swap();               // the previous is the kept one, and the other way round
  void give_up() { task_ = Task::none; }

  // Does the next piece: one transfer.
  Work work();

  bool there() const { return there_; }  // a store that answers
  Program kept() const { return record_.kept; }
  Program previous() const { return record_.previous; }
  Program written() const { return written_; }  // by write(), whole, and not kept yet
  std::uint32_t most_bytes() const;             // of an image
  // What was read. Fewer bytes than the program has: there was no room for it.
  std::span<const std::byte> image() const { return room_; }

private:
  enum class Task : std::uint8_t { none, open, read, write, record };
  static constexpr unsigned kRecords = 2;
  static constexpr unsigned kPatience = 20;  // transfers without an answer, a millisecond each

  struct Record {
    std::uint32_t magic;
    std::uint32_t number;
    Program kept, previous;
    std::uint32_t slot;   // of the kept one: 0 or 1
    std::uint32_t crc32;  // of what stands before it
  };
  static constexpr std::size_t kRecordBytes = 32;
  static_assert(sizeof(Record) == kRecordBytes && kRecordBytes % boards::Store::kPiece == 0);

  void begin(Task task, std::uint32_t at, std::uint32_t length);
  void read_slot(Program program, std::uint32_t slot, std::span<std::byte> room);
  void write_record(Program kept, Program previous, std::uint32_t slot);
  std::uint32_t slot_at(std::uint32_t slot) const;
  boards::Store::Outcome transfer();
  Work finish();
  Work finish_open();

  boards::Store* store_;
  bool there_ = false;
  Record record_{};  // the one that counts; number 0: none
  Program written_{};

  Task task_ = Task::none;
  std::uint32_t begin_ = 0;   // in the store
  std::uint32_t length_ = 0;  // bytes of the task
  std::uint32_t done_ = 0;    // … of which these are done
  unsigned unanswered_ = 0;
  std::span<std::byte> room_;
  std::span<const std::byte> source_;
  unsigned opened_ = 0;  // records that have been read
  Record next_{};        // being read or written
};

}  // namespace robosync::update
