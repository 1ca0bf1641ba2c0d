// Receiving end of a transfer: puts data frames into a buffer in order and names the next wanted
// offset.
//
// Loss, duplication and resuming need no special case: whatever arrives, the answer is the offset
// that is wanted next, and only data at just that offset is taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"

namespace robosync::link {

class Receiver {
public:
  // Starts a transfer into `buffer`; the same size, CRC and buffer as the one under way resumes it.
  // too_large when it does not fit, with the size of the buffer: then no transfer is under way.
  TransferStatus begin(const Begin& begin, std::span<std::byte> buffer);
  // Takes `bytes` if they are just what is wanted next, else leaves everything as it was.
  TransferStatus data(std::uint32_t offset, std::span<const std::byte> bytes);
  TransferStatus status() const;
  [[nodiscard]] bool complete() const { return active_ && next_ == size_; }
  // What was received; call when complete().
  std::span<const std::byte> bytes() const { return buffer_.first(size_); }
  // The CRC announced by begin(). Comparing it with the bytes is the caller's part.
  std::uint32_t crc32() const { return crc32_; }
  // Forgets the transfer; the next begin() starts from offset 0.
  void reset() { *this = {}; }

private:
  std::span<std::byte> buffer_;
  std::uint32_t size_ = 0;
  std::uint32_t crc32_ = 0;
  std::uint32_t next_ = 0;
  bool active_ = false;
};

}  // namespace robosync::link
