// See key_store.hpp.
#include "runtime-m4/update/key_store.hpp"

#include <cstddef>

#include "vm/image.hpp"

namespace robosync::update {
namespace {

std::span<const std::byte> before_crc(const KeyStore::Record& record) {
  return std::as_bytes(std::span(&record, 1)).first(offsetof(KeyStore::Record, crc32));
}

}  // namespace

void KeyStore::open() {
  if (store_ == nullptr) return;
  place_ = 0;
  read(Task::head);
}

// In a store without keys only the heads are read, which takes little time.
void KeyStore::read(Task what) {
  task_ = what;
  const auto whole = std::as_writable_bytes(std::span(&next_, 1));
  transfer_.read(layout().key_at(place_),
                 what == Task::head ? whole.first(boards::Store::kPiece) : whole);
}

void KeyStore::write(bool paired, const link::Pair& owner) {
  if (store_ == nullptr) return;
  written_ = false;
  next_ = {Record::kMagic, record_.number + 1, owner, paired ? 1U : 0U, 0};
  next_.crc32 = vm::crc32(before_crc(next_));
  task_ = Task::write;
  transfer_.write(layout().key_at(next_.number % StoreLayout::kKeys),
                  std::as_bytes(std::span(&next_, 1)));
}

Work KeyStore::work() {
  const Work work = transfer_.work();
  if (work != Work::ended) return work;
  const Task task = task_;
  task_ = Task::none;
  if (!transfer_.answered()) return Work::ended;
  if (task == Task::head) look_at_head();
  if (task == Task::body) look_at_body();
  if (task == Task::write) {
    record_ = next_;
    written_ = true;
  }
  return task_ == Task::none ? Work::ended : Work::some;
}

void KeyStore::look_at_head() {
  if (next_.magic == Record::kMagic && next_.number > record_.number) return read(Task::body);
  go_on();
}

void KeyStore::look_at_body() {
  const bool whole = next_.magic == Record::kMagic && next_.paired <= 1 &&
                     next_.crc32 == vm::crc32(before_crc(next_));
  if (whole && next_.number > record_.number) record_ = next_;
  go_on();
}

void KeyStore::go_on() {
  if (++place_ < StoreLayout::kKeys) return read(Task::head);
  there_ = true;
}

}  // namespace robosync::update
