// Memory of exactly the wanted size, so that ASan sees one step outside: slots far from each other
// in one block, where everything that was not asked for is poisoned. Asking again costs no
// allocation. In a build without ASan they are slots, and that is all.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>

#if defined(ROBOSYNC_SANITIZE)
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(begin, size) (static_cast<void>(begin), static_cast<void>(size))
#define ASAN_UNPOISON_MEMORY_REGION(begin, size) (static_cast<void>(begin), static_cast<void>(size))
#endif

namespace robosync::fuzz {

class Slot {
public:
  // `room` bytes between red zones of `zone` bytes: as far as a wrong operand can reach.
  Slot(std::size_t room, std::size_t zone)
      : room_(room), memory_(new std::byte[2 * zone + room]), begin_(memory_.get() + zone) {
    ASAN_POISON_MEMORY_REGION(memory_.get(), 2 * zone + room);
  }

  // `count` records; what they hold is undefined. Valid until the next call.
  template <typename Record>
  Record* exact(std::size_t count) {
    const std::size_t size = count * sizeof(Record);
    ASAN_POISON_MEMORY_REGION(begin_, used_);
    ASAN_UNPOISON_MEMORY_REGION(begin_, size);
    used_ = size;
    return reinterpret_cast<Record*>(begin_);
  }
  template <typename Record>
  Record* copy(const Record* from, std::size_t count) {
    auto* const to = exact<Record>(count);
    if (count > 0) std::memcpy(to, from, count * sizeof(Record));
    return to;
  }
  [[nodiscard]] std::size_t room() const { return room_; }

private:
  std::size_t room_;
  std::unique_ptr<std::byte[]> memory_;
  std::byte* begin_;
  std::size_t used_ = 0;
};

}  // namespace robosync::fuzz
