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
  // Starts a transfer into `buffer`; the same size, name and buffer as the one under way resumes it.
  // too_large when it does not fit, with the size of the buffer: then no transfer is under way.
  // `base`: pieces may be of it; it must stay until the transfer is over.
  TransferStatus begin(const Begin& begin, std::span<std::byte> buffer,
                       std::span<const std::byte> base = {});
  // Takes `bytes` if they are just what is wanted next, else leaves everything as it was.
  TransferStatus data(std::uint32_t offset, std::span<const std::byte> bytes);
  // The same with the pieces of a message.
  TransferStatus pieces(std::uint32_t offset, std::span<const std::byte> pieces);
  TransferStatus status() const;
  [[nodiscard]] bool complete() const { return active_ && next_ == size_; }
  // What was received so far.
  std::span<const std::byte> bytes() const { return buffer_.first(next_); }
  // The name announced by begin(). Comparing it with the bytes is the caller's part.
  const ProgramHash& hash() const { return hash_; }
  // Forgets the transfer; the next begin() starts from offset 0.
  void reset() { *this = {}; }

private:
  [[nodiscard]] bool put(std::uint32_t at, std::span<const std::byte> bytes);
  [[nodiscard]] bool copy(const Piece& piece);

  std::span<std::byte> buffer_;
  std::span<const std::byte> base_;
  std::uint32_t size_ = 0;
  ProgramHash hash_{};
  std::uint32_t next_ = 0;
  bool active_ = false;
};

}  // namespace robosync::link
