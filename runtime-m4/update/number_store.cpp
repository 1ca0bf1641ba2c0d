// See number_store.hpp.
#include "runtime-m4/update/number_store.hpp"

#include <algorithm>
#include <cstddef>

namespace robosync::update {
namespace {

std::span<const std::byte> before_crc(const NumberStore::Record& record) {
  return std::as_bytes(std::span(&record, 1)).first(offsetof(NumberStore::Record, crc32));
}

}  // namespace

void NumberStore::open() {
  if (store_ == nullptr) return;
  below_ = ~std::uint32_t{0};
  place_ = 0;
  best_ = {};
  read_head();
}

void NumberStore::read_head() {
  task_ = Task::heads;
  transfer_.read(layout().numbers_at(place_), std::as_writable_bytes(std::span(&head_, 1)));
}

void NumberStore::write(std::span<const layers::KeptNumber> numbers) {
  if (store_ == nullptr) return;
  next_ = {.magic = Record::kMagic,
           .number = record_.number + 1 + skipped_,
           .count = static_cast<std::uint32_t>(std::min<std::size_t>(numbers.size(), vm::kMaxKept)),
           .entries = {},
           .crc32 = 0};
  std::copy_n(numbers.begin(), next_.count, next_.entries.begin());
  next_.crc32 = vm::crc32(before_crc(next_));
  task_ = Task::write;
  transfer_.write(layout().numbers_at(next_.number % layout().ring()),
                  std::as_bytes(std::span(&next_, 1)));
}

Work NumberStore::work() {
  const Work work = transfer_.work();
  if (work != Work::ended) return work;
  const Task task = task_;
  task_ = Task::none;
  if (!transfer_.answered()) {
    // In flash: a power cut has spoiled the place. The next write goes to the one after it.
    if (task == Task::write) ++skipped_;
    return Work::ended;
  }
  if (task == Task::heads) look_at_head();
  if (task == Task::body) look_at_body();
  if (task == Task::write) {
    record_ = next_;
    skipped_ = 0;
  }
  return task_ == Task::none ? Work::ended : Work::some;
}

void NumberStore::look_at_head() {
  if (head_.magic == Record::kMagic && head_.number < below_ && head_.number > best_.number) {
    best_ = head_;
    best_place_ = place_;
  }
  if (++place_ < layout().ring()) return read_head();
  if (best_.number == 0) return;
  task_ = Task::body;
  transfer_.read(layout().numbers_at(best_place_), std::as_writable_bytes(std::span(&next_, 1)));
}

bool NumberStore::whole() const {
  return next_.magic == Record::kMagic && next_.count <= vm::kMaxKept &&
         next_.number == best_.number && next_.crc32 == vm::crc32(before_crc(next_));
}

// If it is damaged, try the next older one: the power was cut while this one was written.
void NumberStore::look_at_body() {
  if (whole()) {
    record_ = next_;
    return;
  }
  below_ = best_.number;
  place_ = 0;
  best_ = {};
  read_head();
}

}  // namespace robosync::update
