// See program_store.hpp.
#include "runtime-m4/update/program_store.hpp"

#include <algorithm>
#include <cstddef>

#include "vm/image.hpp"

namespace robosync::update {

std::uint32_t ProgramStore::most_bytes() const {
  return there_ ? layout().slot_bytes() : 0;
}

bool ProgramStore::open() {
  opened_ = 0;
  if (store_ != nullptr) read_record();
  return store_ != nullptr;
}

void ProgramStore::read_record() {
  task_ = Task::open;
  transfer_.read(layout().record_at(opened_), std::as_writable_bytes(std::span(&next_, 1)));
}

void ProgramStore::read_kept(std::span<std::byte> room) {
  read_slot(record_.kept, record_.slot, room);
}

void ProgramStore::read_previous(std::span<std::byte> room) {
  read_slot(record_.previous, 1 - record_.slot, room);
}

void ProgramStore::read_slot(Program program, std::uint32_t slot, std::span<std::byte> room) {
  room_ = room.first(std::min<std::size_t>(program.bytes, room.size()));
  task_ = Task::read;
  transfer_.read(layout().slot_at(slot), room_);
}

void ProgramStore::write(std::span<const std::byte> image, Program what) {
  written_ = {};
  writes_ = what;
  from_ = image;
  if (record_.previous.bytes == 0) return write_image();
  write_record(Task::forget, record_.kept, {}, record_.slot);
}

void ProgramStore::write_image() {
  task_ = Task::write;
  transfer_.write(layout().slot_at(1 - record_.slot), from_);
}

void ProgramStore::keep_written() {
  write_record(Task::record, written_, record_.kept, 1 - record_.slot);
}

void ProgramStore::swap() {
  write_record(Task::record, record_.previous, record_.kept, 1 - record_.slot);
}

void ProgramStore::write_record(Task why, Program kept, Program previous, std::uint32_t slot) {
  next_ = {Record::kMagic, record_.number + 1, kept, previous, slot, {}, 0};
  next_.crc32 = vm::crc32(std::as_bytes(std::span(&next_, 1)).first(offsetof(Record, crc32)));
  task_ = why;
  transfer_.write(layout().record_at(next_.number % StoreLayout::kRecords),
                  std::as_bytes(std::span(&next_, 1)));
}

Work ProgramStore::work() {
  const Work work = transfer_.work();
  if (work != Work::ended) return work;
  const Task task = task_;
  task_ = Task::none;
  there_ = transfer_.answered();
  if (!there_) return Work::ended;
  if (task == Task::open) look_at_record();
  if (task == Task::write) written_ = writes_;
  if (task == Task::record || task == Task::forget) {
    record_ = next_;
    written_ = {};
  }
  if (task == Task::forget) write_image();
  return task_ == Task::none ? Work::ended : Work::some;
}

// Accepts only a record that could have been written; any other counts as absent.
void ProgramStore::look_at_record() {
  const auto bytes = std::as_bytes(std::span(&next_, 1)).first(offsetof(Record, crc32));
  const bool whole = next_.magic == Record::kMagic && vm::crc32(bytes) == next_.crc32 &&
                     next_.slot < 2 && next_.kept.bytes <= most_bytes() &&
                     next_.previous.bytes <= most_bytes();
  if (whole && next_.number > record_.number) record_ = next_;
  if (++opened_ < StoreLayout::kRecords) read_record();
}

}  // namespace robosync::update
