// See program_store.hpp.
#include "runtime-m4/update/program_store.hpp"

#include <algorithm>
#include <cstddef>

#include "vm/image.hpp"

namespace robosync::update {
namespace {

using boards::Store;

constexpr std::uint32_t kMagic = 0x3150'5352;  // "RSP1"

}  // namespace

std::uint32_t ProgramStore::most_bytes() const {
  if (!there_) return 0;
  const std::uint32_t page = store_->page();
  return (store_->size() / page - kRecords) / 2 * page;
}

std::uint32_t ProgramStore::slot_at(std::uint32_t slot) const {
  return kRecords * store_->page() + slot * most_bytes();
}

void ProgramStore::begin(Task task, std::uint32_t at, std::uint32_t length) {
  task_ = task;
  begin_ = at;
  length_ = length;
  done_ = 0;
  unanswered_ = 0;
}

void ProgramStore::open() {
  opened_ = 0;
  if (store_ != nullptr) begin(Task::open, 0, kRecordBytes);
}

void ProgramStore::read_kept(std::span<std::byte> room) {
  read_slot(record_.kept, record_.slot, room);
}

void ProgramStore::read_previous(std::span<std::byte> room) {
  read_slot(record_.previous, 1 - record_.slot, room);
}

void ProgramStore::read_slot(Program program, std::uint32_t slot, std::span<std::byte> room) {
  room_ = room.first(std::min<std::size_t>(program.bytes, room.size()));
  begin(Task::read, slot_at(slot), static_cast<std::uint32_t>(room_.size()));
}

void ProgramStore::write(std::span<const std::byte> image, Program what) {
  written_ = {};
  source_ = image;
  next_.kept = what;
  begin(Task::write, slot_at(1 - record_.slot), static_cast<std::uint32_t>(image.size()));
}

void ProgramStore::keep_written() {
  write_record(written_, record_.kept, 1 - record_.slot);
}

void ProgramStore::swap() {
  write_record(record_.previous, record_.kept, 1 - record_.slot);
}

void ProgramStore::write_record(Program kept, Program previous, std::uint32_t slot) {
  next_ = {kMagic, record_.number + 1, kept, previous, slot, 0};
  next_.crc32 = vm::crc32(std::as_bytes(std::span(&next_, 1)).first(offsetof(Record, crc32)));
  begin(Task::record, next_.number % kRecords * store_->page(), kRecordBytes);
}

ProgramStore::Work ProgramStore::work() {
  if (task_ == Task::none) return Work::none;
  if (done_ == length_) return finish();
  switch (transfer()) {
    case Store::Outcome::taken:
      return Work::some;
    case Store::Outcome::busy:
      if (++unanswered_ < kPatience) return Work::waits;
      there_ = false;
      task_ = Task::none;
      return Work::ended;
    case Store::Outcome::done:
      break;
  }
  unanswered_ = 0;
  done_ += static_cast<std::uint32_t>(std::min<std::size_t>(Store::kPiece, length_ - done_));
  return Work::some;
}

Store::Outcome ProgramStore::transfer() {
  const std::size_t count = std::min<std::size_t>(Store::kPiece, length_ - done_);
  const auto record = std::as_writable_bytes(std::span(&next_, 1));
  switch (task_) {
    case Task::open:
      return store_->read(begin_ + done_, record.subspan(done_, count));
    case Task::read:
      return store_->read(begin_ + done_, room_.subspan(done_, count));
    case Task::write:
      return store_->write(begin_ + done_, source_.subspan(done_, count));
    default:
      return store_->write(begin_ + done_, record.subspan(done_, count));
  }
}

ProgramStore::Work ProgramStore::finish() {
  if (task_ == Task::open) return finish_open();
  if (task_ == Task::write) written_ = next_.kept;
  if (task_ == Task::record) {
    record_ = next_;
    written_ = {};
  }
  task_ = Task::none;
  return Work::ended;
}

// A record is believed that could have been written: what is damaged otherwise is not there.
ProgramStore::Work ProgramStore::finish_open() {
  there_ = true;
  const auto bytes = std::as_bytes(std::span(&next_, 1)).first(offsetof(Record, crc32));
  const bool whole = next_.magic == kMagic && vm::crc32(bytes) == next_.crc32 && next_.slot < 2 &&
                     next_.kept.bytes <= most_bytes() && next_.previous.bytes <= most_bytes();
  if (whole && next_.number > record_.number) record_ = next_;
  if (++opened_ < kRecords) {
    begin(Task::open, opened_ * store_->page(), kRecordBytes);
    return Work::some;
  }
  task_ = Task::none;
  return Work::ended;
}

}  // namespace robosync::update
