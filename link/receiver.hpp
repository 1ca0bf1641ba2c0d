// Receiving end of a transfer: puts data frames into a buffer in order, and replies with the next
// wanted offset.
//
// Loss, duplication and resuming need no special case: the reply to any frame is the offset that is
// wanted next, and only data at exactly that offset is accepted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"

namespace robosync::link {

class Receiver {
public:
  // Starts a transfer into `buffer`, or resumes the current one if size, name and buffer are the same.
  // If it does not fit, returns too_large with the size of the buffer; then no transfer is active.
  // `base`: pieces may copy from it; it must stay valid until the transfer is over.
  TransferStatus begin(const Begin& begin, std::span<std::byte> buffer,
                       std::span<const std::byte> base = {});
  // Accepts `bytes` if they are exactly those wanted next; otherwise changes nothing.
  TransferStatus data(std::uint32_t offset, std::span<const std::byte> bytes);
  // Like data(), for the pieces of a message.
  TransferStatus pieces(std::uint32_t offset, std::span<const std::byte> pieces);
  TransferStatus status() const;
  [[nodiscard]] bool complete() const { return active_ && next_ == size_; }
  // The bytes received so far.
  std::span<const std::byte> bytes() const { return buffer_.first(next_); }
  // The name that begin() announced. The caller compares it with the bytes.
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
