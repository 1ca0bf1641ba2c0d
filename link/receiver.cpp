// Receiving end of a transfer. May assume nothing of sizes and offsets: they come from the line.
// Promises that it writes inside the buffer only, and that when it is complete every byte of the
// announced size was written once, in order.
#include "link/receiver.hpp"

#include <algorithm>

namespace robosync::link {

TransferStatus Receiver::begin(const Begin& begin, std::span<std::byte> buffer) {
  const bool resumes = active_ && begin.size == size_ && begin.crc32 == crc32_ &&
                       buffer.data() == buffer_.data() && buffer.size() == buffer_.size();
  if (resumes) return status();
  reset();
  if (begin.size > buffer.size())
    return {static_cast<std::uint32_t>(buffer.size()), TransferState::too_large};
  buffer_ = buffer;
  size_ = begin.size;
  crc32_ = begin.crc32;
  active_ = true;
  return status();
}

TransferStatus Receiver::data(std::uint32_t offset, std::span<const std::byte> bytes) {
  if (!active_) return {0, TransferState::no_transfer};
  if (offset == next_ && bytes.size() <= size_ - next_) {
    std::copy(bytes.begin(), bytes.end(), buffer_.begin() + next_);
    next_ += static_cast<std::uint32_t>(bytes.size());
  }
  return status();
}

TransferStatus Receiver::status() const {
  if (!active_) return {0, TransferState::idle};
  return {next_, complete() ? TransferState::complete : TransferState::receiving};
}

}  // namespace robosync::link
