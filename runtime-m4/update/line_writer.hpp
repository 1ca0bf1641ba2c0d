// One frame on its way to the line, which may take only a few bytes at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/frame.hpp"
#include "runtime-m4/boards/board.hpp"

namespace robosync::update {

class LineWriter {
public:
  explicit LineWriter(boards::Board& board) : board_(board) {}

  // True when the last frame is written and the next may be sent. Never waits.
  [[nodiscard]] bool ready() {
    if (begin_ < end_)
      begin_ += board_.link_write(std::span(frame_).subspan(begin_, end_ - begin_));
    return begin_ == end_;
  }

  // Only when ready().
  void send(link::MessageType type, std::uint8_t sequence, std::span<const std::byte> payload) {
    begin_ = 0;
    end_ = link::encode_frame(type, sequence, payload, frame_);
  }

private:
  boards::Board& board_;
  std::array<std::byte, link::kMaxEncodedFrame> frame_{};
  std::size_t begin_ = 0;  // first byte not yet written
  std::size_t end_ = 0;
};

}  // namespace robosync::update
