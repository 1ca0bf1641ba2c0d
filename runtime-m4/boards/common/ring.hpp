// A byte ring between one writer and one reader; either may be an interrupt handler.
// It needs no locks: each side moves only its own index, and only after it has copied the bytes.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::boards {

template <std::size_t kSize>
class Ring {
  static_assert(kSize >= 2 && (kSize & (kSize - 1)) == 0, "a power of two");

public:
  // Both return the number of bytes moved.
  std::size_t write(std::span<const std::byte> bytes) {
    const std::uint32_t end = end_.load(std::memory_order_relaxed);
    const std::size_t free = kSize - (end - begin_.load(std::memory_order_acquire));
    const std::size_t count = std::min(free, bytes.size());
    for (std::size_t i = 0; i < count; ++i)
      bytes_[(end + i) % kSize] = bytes[i];
    end_.store(end + static_cast<std::uint32_t>(count), std::memory_order_release);
    return count;
  }

  std::size_t read(std::span<std::byte> bytes) {
    const std::uint32_t begin = begin_.load(std::memory_order_relaxed);
    const std::size_t used = end_.load(std::memory_order_acquire) - begin;
    const std::size_t count = std::min(used, bytes.size());
    for (std::size_t i = 0; i < count; ++i)
      bytes[i] = bytes_[(begin + i) % kSize];
    begin_.store(begin + static_cast<std::uint32_t>(count), std::memory_order_release);
    return count;
  }

  std::size_t used() const {
    return end_.load(std::memory_order_relaxed) - begin_.load(std::memory_order_relaxed);
  }

private:
  std::array<std::byte, kSize> bytes_{};
  std::atomic<std::uint32_t> begin_ = 0;  // both count bytes and wrap at 2^32
  std::atomic<std::uint32_t> end_ = 0;
};

}  // namespace robosync::boards
