// Receiving end of a transfer. Sizes and offsets are not trusted: they come from the line. Guarantees
// that it writes inside the buffer only, and that in a complete transfer every byte of the announced
// size was written once, in order.
#include "link/receiver.hpp"

#include <algorithm>

#include "link/wire.hpp"

namespace robosync::link {

TransferStatus Receiver::begin(const Begin& begin, std::span<std::byte> buffer,
                               std::span<const std::byte> base) {
  const bool resumes = active_ && begin.size == size_ && begin.hash == hash_ &&
                       buffer.data() == buffer_.data() && buffer.size() == buffer_.size();
  if (!resumes) reset();
  if (begin.size > buffer.size())
    return {static_cast<std::uint32_t>(buffer.size()), TransferState::too_large};
  buffer_ = buffer;
  base_ = base;
  size_ = begin.size;
  hash_ = begin.hash;
  active_ = true;
  return status();
}

TransferStatus Receiver::data(std::uint32_t offset, std::span<const std::byte> bytes) {
  if (!active_) return {0, TransferState::no_transfer};
  if (offset == next_) (void)put(next_, bytes);
  return status();
}

// Accepts all pieces or none: `next_` moves at the end only.
TransferStatus Receiver::pieces(std::uint32_t offset, std::span<const std::byte> pieces) {
  if (!active_) return {0, TransferState::no_transfer};
  if (offset != next_) return status();
  const std::uint32_t before = next_;
  bool good = true;
  Piece piece{};
  while (good && read_prefix(pieces, piece)) {
    pieces = pieces.subspan(sizeof piece);
    good = piece.count <= pieces.size() && copy(piece) && put(next_, pieces.first(piece.count));
    if (good) pieces = pieces.subspan(piece.count);
  }
  if (!good || !pieces.empty()) next_ = before;
  return status();
}

bool Receiver::put(std::uint32_t at, std::span<const std::byte> bytes) {
  if (bytes.size() > size_ - at) return false;
  std::ranges::copy(bytes, buffer_.begin() + at);
  next_ = at + static_cast<std::uint32_t>(bytes.size());
  return true;
}

// Copies byte by byte, because the source may include bytes that were just copied.
bool Receiver::copy(const Piece& piece) {
  for (std::size_t from = piece.from; from < piece.from + std::size_t{piece.copied}; ++from) {
    const bool old = from < base_.size();
    if (!old && from - base_.size() >= next_) return false;
    const std::byte byte = old ? base_[from] : buffer_[from - base_.size()];
    if (!put(next_, std::span(&byte, 1))) return false;
  }
  return true;
}

TransferStatus Receiver::status() const {
  if (!active_) return {0, TransferState::idle};
  return {next_, complete() ? TransferState::complete : TransferState::receiving};
}

}  // namespace robosync::link
