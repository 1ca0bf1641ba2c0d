// May assume one reader. Promises that a message is in the ring whole or not at all, and that the
// kernel is locked only while its bytes are copied.
#include "runtime-m4/update/trace_ring.hpp"

#include <algorithm>

namespace robosync::update {

void TraceRing::listen(bool on) {
  const auto lock = kernel_.lock();
  if (!on) taken_ = put_;
  listening_ = on;
}

void TraceRing::emit(const link::Event& event) {
  if (!listening_) return;
  std::array<std::byte, link::kEventHeadBytes> head{};
  link::encode_event_head(event, head);
  put(link::MessageType::event, head, link::encoded_values(event));
}

void TraceRing::log(std::string_view line) {
  if (line.empty()) return;
  const std::string_view cut = line.substr(0, link::kMaxPayload);
  put(link::MessageType::log, std::as_bytes(std::span(cut.data(), cut.size())), {});
}

void TraceRing::put(link::MessageType type, std::span<const std::byte> begin,
                    std::span<const std::byte> end) {
  const std::size_t length = begin.size() + end.size();
  const std::array head{static_cast<std::byte>(type), static_cast<std::byte>(length)};
  const auto lock = kernel_.lock();
  if (!listening_) return;
  if (kHead + length > kCapacity - (put_ - taken_)) {
    ++lost_;
    return;
  }
  if (put_ == taken_ && reader_ != nullptr) kernel_.signal(*reader_, news_);
  copy_in(head);
  copy_in(begin);
  copy_in(end);
}

std::size_t TraceRing::take(link::MessageType& type,
                            std::span<std::byte, link::kMaxPayload> payload) {
  const auto lock = kernel_.lock();
  if (put_ == taken_) return 0;
  std::array<std::byte, kHead> head{};
  copy_out(head);
  type = static_cast<link::MessageType>(head[0]);
  const auto length = std::to_integer<std::size_t>(head[1]);
  copy_out(payload.first(length));
  return length;
}

void TraceRing::copy_in(std::span<const std::byte> bytes) {
  const std::size_t at = put_ % kCapacity;
  const std::size_t to_end = std::min(bytes.size(), kCapacity - at);
  std::copy_n(bytes.begin(), to_end, ring_.begin() + static_cast<std::ptrdiff_t>(at));
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(to_end), bytes.end(), ring_.begin());
  put_ += bytes.size();
}

void TraceRing::copy_out(std::span<std::byte> bytes) {
  const std::size_t at = taken_ % kCapacity;
  const std::size_t to_end = std::min(bytes.size(), kCapacity - at);
  const auto rest =
      std::copy_n(ring_.begin() + static_cast<std::ptrdiff_t>(at), to_end, bytes.begin());
  std::copy_n(ring_.begin(), bytes.size() - to_end, rest);
  taken_ += bytes.size();
}

}  // namespace robosync::update
